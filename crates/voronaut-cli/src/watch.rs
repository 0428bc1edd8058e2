//! What ends a run before its end: limits of time and memory, and signals. Nothing is left behind then.

use crate::aside::say_aside;
use crate::options::{GIB, Limits};
use std::process::{Child, Command, ExitStatus, exit};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
#[cfg(not(target_family = "wasm"))]
use voronaut::Error;
use voronaut::Result;

/// What the program itself may hold, whatever the limit: that is for its work, which is estimated before.
const OWN: u64 = 64 << 20;
/// The time between two looks at clock and memory.
const PERIOD: Duration = Duration::from_millis(20);

/// Watches over the rest of the run.
///
/// # Errors
/// [`Error::Limit`] where signals cannot be handled.
pub(crate) fn begin(limits: Limits) -> Result<()> {
    let start = Instant::now();
    heed_signals()?;
    // A thread may start late.
    check(limits, start);
    std::thread::spawn(move || {
        loop {
            check(limits, start);
            std::thread::sleep(PERIOD);
        }
    });
    Ok(())
}

#[cfg(not(target_family = "wasm"))]
fn heed_signals() -> Result<()> {
    let set = ctrlc::set_handler(|| stop("stopped by a signal", "files are whole or not there"));
    let fault = |error| Error::limit(format!("signals cannot be handled: {error}"), "start it in another way");
    set.map_err(fault)
}

/// There are none.
#[cfg(target_family = "wasm")]
fn heed_signals() -> Result<()> {
    Ok(())
}

fn check(limits: Limits, start: Instant) {
    if let Some(limit) = limits.time_limit.filter(|&limit| start.elapsed().as_secs_f64() > limit) {
        stop(&format!("not done within {limit} s"), "raise --time-limit, or ask for less");
    }
    if let Some(held) = voronaut_io::peak_memory_bytes().filter(|&held| held > limits.memory().max(OWN)) {
        let what = format!("{:.2} GiB of memory were held, more than {}", held as f64 / GIB, limits.memory_limit);
        stop(&what, "raise --memory-limit, or ask for less");
    }
}

/// How far a run is.
struct Stage {
    name: &'static str,
    began: Option<Instant>,
    done: u64,
    total: u64,
}

static STAGE: Mutex<Stage> = Mutex::new(Stage { name: "reading", began: None, done: 0, total: 0 });

/// The programs that run: the user's, or this one again.
static CHILDREN: Mutex<Vec<Child>> = Mutex::new(Vec::new());

fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Runs a program to its end, or to the end of this one, with all that it starts.
///
/// # Errors
/// What the system says.
pub(crate) fn run(command: &mut Command) -> std::io::Result<ExitStatus> {
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(command, 0);
    let mut running = held(&CHILDREN);
    let child = command.spawn()?;
    let number = child.id();
    running.push(child);
    drop(running);
    loop {
        let mut running = held(&CHILDREN);
        if let Some(at) = running.iter().position(|child| child.id() == number)
            && let Some(status) = running[at].try_wait()?
        {
            // Its number may be another's from now on.
            let _ = running.swap_remove(at).wait();
            return Ok(status);
        }
        drop(running);
        std::thread::sleep(PERIOD / 20);
    }
}

/// Whether exit codes are mmg's.
static AS_MMG: AtomicBool = AtomicBool::new(false);

/// Whether the exit code of a run that fails is mmg's.
pub(crate) fn fail_as(mmg: bool) {
    AS_MMG.store(mmg, Ordering::Relaxed);
}

/// The exit code of a run whose input or result is not what was asked: of `remesh` that of mmg.
pub(crate) fn failure() -> u8 {
    if AS_MMG.load(Ordering::Relaxed) { 2 } else { 1 }
}

/// A stage begins, with so many units of work.
pub(crate) fn stage(name: &'static str, total: u64) {
    *held(&STAGE) = Stage { name, began: Some(Instant::now()), done: 0, total };
}

/// So many more units of it are done.
pub(crate) fn done(units: u64) {
    held(&STAGE).done += units;
}

impl Stage {
    /// Where the run is, and what the stage would take.
    fn account(&self) -> String {
        let share = self.done as f64 / self.total.max(1) as f64;
        match self.began.filter(|_| share > 0.0 && share < 1.0) {
            None => format!("in the stage: {}", self.name),
            Some(began) => {
                let whole = began.elapsed().as_secs_f64() / share;
                format!("in the stage: {}, {:.0} % done, of about {whole:.1} s", self.name, 100.0 * share)
            }
        }
    }
}

/// Ends the program; files that are not whole go, and programs that it runs.
fn stop(what: &str, help: &str) {
    voronaut_io::abandon();
    // Held to the end: nobody starts another.
    let mut running = held(&CHILDREN);
    for child in running.iter_mut() {
        // It may have ended by itself; what it has started is in its group.
        let _ = Command::new("kill").args(["-KILL", "--", &format!("-{}", child.id())]).status();
        let _ = child.kill().and_then(|()| child.wait());
    }
    let stage = held(&STAGE).account();
    say_aside(&format!("error: {what}, {stage}\n  help: {help}"));
    exit(failure().into());
}
