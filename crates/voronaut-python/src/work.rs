//! Work beside the interpreter: without its lock, on threads of its own, told to stop by signals, limits and callbacks.

use crate::faults;
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use voronaut::progress::Progress;
use voronaut::{Error, Result};

/// The time between two looks at signals, the clock and the callback.
const PERIOD: Duration = Duration::from_millis(20);

/// How long work that is told to stop is waited for.
const GRACE: Duration = Duration::from_millis(500);

/// How far the work is, and whether it is to stop.
pub(crate) struct Course {
    start: Instant,
    stage: Mutex<(&'static str, u64)>,
    done: AtomicU64,
    is_stopped: AtomicBool,
    /// Whether a function of the user's is being called.
    is_calling: AtomicBool,
    /// What a function of the user's has raised.
    raised: Mutex<Option<PyErr>>,
}

impl Course {
    pub(crate) fn new() -> Self {
        Self {
            start: Instant::now(),
            stage: Mutex::new(("reading", 1)),
            done: AtomicU64::new(0),
            is_stopped: AtomicBool::new(false),
            is_calling: AtomicBool::new(false),
            raised: Mutex::new(None),
        }
    }

    /// Calls a function of the user's, unless the work is to stop: it may have been left, and Python be gone.
    pub(crate) fn call<T>(&self, function: impl FnOnce(Python) -> PyResult<T>) -> Result<T> {
        self.is_calling.store(true, Ordering::SeqCst);
        let stopped = self.is_stopped.load(Ordering::SeqCst);
        let said =
            if stopped { Err(Error::Stopped) } else { Python::attach(function).map_err(|error| self.raise(error)) };
        self.is_calling.store(false, Ordering::SeqCst);
        said
    }

    /// Keeps what a function has raised, for the caller; the work ends with the error that comes back.
    fn raise(&self, error: PyErr) -> Error {
        *self.raised.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
        Error::Stopped
    }

    /// Tells the callback; whether to go on.
    fn tell(&self, callback: &Bound<PyAny>) -> PyResult<bool> {
        let (stage, total) = *self.stage.lock().unwrap_or_else(PoisonError::into_inner);
        let done = self.done.load(Ordering::Relaxed).min(total);
        let said = callback.call1((stage, done, total))?;
        Ok(said.is_none() || said.is_truthy()?)
    }
}

impl Progress for &Course {
    fn stage(&self, name: &'static str, total: u64) {
        *self.stage.lock().unwrap_or_else(PoisonError::into_inner) = (name, total);
        self.done.store(0, Ordering::Relaxed);
    }

    fn done(&self, units: u64) {
        self.done.fetch_add(units, Ordering::Relaxed);
    }

    fn seconds(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    fn is_stopped(&self) -> bool {
        self.is_stopped.load(Ordering::Relaxed)
    }
}

/// What work may take, and who watches it.
#[derive(Default)]
pub(crate) struct Terms<'a, 'py> {
    /// Threads; all if none are said.
    pub(crate) threads: Option<usize>,
    /// Seconds.
    pub(crate) time_limit: Option<f64>,
    /// Called with the stage and how far it is.
    pub(crate) callback: Option<&'a Bound<'py, PyAny>>,
}

/// Does the work on threads of its own, and waits for it. Where it is told to stop and does not within [`GRACE`], it is left to end by
/// itself, without files and without Python.
pub(crate) fn wait<T: Send + 'static>(
    py: Python,
    course: &Arc<Course>,
    terms: &Terms,
    work: impl FnOnce() -> Result<T> + Send + 'static,
) -> PyResult<T> {
    let (sender, receiver) = sync_channel(1);
    let receiver = Mutex::new(receiver);
    let receive = || receiver.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(PERIOD);
    let threads = terms.threads.unwrap_or(0);
    let worker = std::thread::spawn(move || {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let done = pool.map_err(|error| Error::limit(error.to_string(), "ask for fewer threads"));
        let _ = sender.send(done.and_then(|pool| pool.install(work)));
    });
    let mut halted: Option<(PyErr, Instant)> = None;
    let done = loop {
        match (py.detach(receive), &halted) {
            (Ok(done), _) => break py.detach(|| worker.join()).map(|()| done),
            (Err(RecvTimeoutError::Disconnected), _) => break py.detach(|| worker.join()).and(Err(Box::new(()))),
            (_, None) => halted = halt(py, course, terms).map(|reason| (reason, Instant::now())),
            (_, Some((_, since))) if since.elapsed() > GRACE && !course.is_calling.load(Ordering::SeqCst) => {
                break Ok(Err(Error::Stopped));
            }
            _ => {}
        }
    };
    outcome(py, course, done, halted.map(|(reason, _)| reason))
}

/// What the caller gets of work that was done, failed or left, and of what was to halt it.
fn outcome<T>(py: Python, course: &Course, done: std::thread::Result<Result<T>>, halted: Option<PyErr>) -> PyResult<T> {
    let raised = course.raised.lock().unwrap_or_else(PoisonError::into_inner).take();
    match (done, raised) {
        (_, Some(error)) => Err(error),
        (Err(_), None) => Err(faults::panicked()),
        (Ok(Ok(made)), None) => halted.filter(|error| !is_ours(py, error)).map_or(Ok(made), Err),
        (Ok(Err(Error::Stopped)), None) => Err(halted.unwrap_or_else(faults::panicked)),
        (Ok(Err(error)), None) => Err(faults::exception(py, &error)),
    }
}

/// A limit or a callback that came too late to matter is none.
fn is_ours(py: Python, error: &PyErr) -> bool {
    py.import("voronaut._errors")
        .and_then(|errors| errors.getattr("Error"))
        .is_ok_and(|class| error.matches(py, class).unwrap_or(false))
}

/// Looks whether the work is to stop, and says why.
fn halt(py: Python, course: &Course, terms: &Terms) -> Option<PyErr> {
    let late = terms.time_limit.filter(|&limit| course.start.elapsed().as_secs_f64() > limit);
    let reason = match (py.check_signals(), late) {
        (Err(signal), _) => Some(signal),
        (_, Some(limit)) => {
            let help = "raise time_limit, or ask for less";
            Some(faults::raised(py, "LimitError", &format!("not done within {limit} s"), help).unwrap_or_else(|it| it))
        }
        (Ok(()), None) => terms.callback.and_then(|callback| match course.tell(callback) {
            Ok(true) => None,
            Ok(false) => Some(faults::exception(py, &Error::Stopped)),
            Err(error) => Some(error),
        }),
    };
    if reason.is_some() {
        course.is_stopped.store(true, Ordering::SeqCst);
    }
    reason
}
