//! Work beside the interpreter: without its lock, on threads of its own, told to stop by signals, limits and callbacks.

use crate::faults;
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};
use voronaut::progress::Progress;
use voronaut::{Error, Result};

/// The time between two looks at signals, the clock and the callback.
const PERIOD: Duration = Duration::from_millis(20);

/// How far the work is, and whether it is to stop.
pub(crate) struct Course {
    start: Instant,
    stage: Mutex<(&'static str, u64)>,
    done: AtomicU64,
    is_stopped: AtomicBool,
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
            raised: Mutex::new(None),
        }
    }

    /// Keeps what a function has raised, for the caller; the work ends with the error that comes back.
    pub(crate) fn raise(&self, error: PyErr) -> Error {
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
pub(crate) struct Terms<'a, 'py> {
    /// Threads; all if none are said.
    pub(crate) threads: Option<usize>,
    /// Seconds.
    pub(crate) time_limit: Option<f64>,
    /// Called with the stage and how far it is.
    pub(crate) callback: Option<&'a Bound<'py, PyAny>>,
}

/// Does the work, and waits for it. Its threads end with it.
pub(crate) fn wait<T: Send>(
    py: Python,
    course: &Course,
    terms: &Terms,
    work: impl FnOnce() -> Result<T> + Send,
) -> PyResult<T> {
    let mut halted: Option<PyErr> = None;
    let done = std::thread::scope(|scope| {
        let (sender, receiver) = sync_channel(1);
        let receiver = Mutex::new(receiver);
        let receive = || receiver.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(PERIOD);
        let threads = terms.threads.unwrap_or(0);
        let worker = scope.spawn(move || {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let done = pool.map_err(|error| Error::limit(error.to_string(), "ask for fewer threads"));
            let _ = sender.send(done.and_then(|pool| pool.install(work)));
        });
        loop {
            match py.detach(receive) {
                Ok(done) => return py.detach(|| worker.join()).map(|()| done),
                Err(RecvTimeoutError::Disconnected) => return py.detach(|| worker.join()).and(Err(Box::new(()))),
                Err(RecvTimeoutError::Timeout) if halted.is_none() => halted = halt(py, course, terms),
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
    });
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
        course.is_stopped.store(true, Ordering::Relaxed);
    }
    reason
}
