//! Random domains with random metrics: whatever is drawn is meshed, and every mesh is valid and true to its domain.
//!
//! A case is its number. `RANDOM_CASES=17..18 cargo test --test random_domains -- --nocapture` runs one of them again,
//! `RANDOM_CASES=0..5000` (with `--release`) hunts further; each case then prints a line.

mod checks;
mod domains;
mod metrics;
mod random;

use random::Random;
use std::collections::BTreeMap;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::{Duration, Instant};
use voronaut::Error;
use voronaut::manifold::domain::Domain;
use voronaut::progress::Silent;
use voronaut::recipe::{self, MeshOptions};

/// Cases of an ordinary run.
const CASES: Range<u64> = 0..50;
/// Cases that failed once, found by longer runs.
const FOUND: [u64; 1] = [528];
/// No case may take longer, in the test profile, on a busy machine.
const SLOWEST: Duration = Duration::from_secs(20);
/// Most cases that may be refused as domains (by rounding, for example: islands a billionth apart, moved far away).
const MOST_REFUSED: f64 = 0.03;
/// Most cases that may miss the number of vertices, of those where the domain leaves a choice.
const MOST_MISSED: f64 = 0.02;

/// What came of a case.
enum Outcome {
    Meshed(String),
    /// The mesh is fine but for its number of vertices.
    Missed(String),
    /// [`Domain::new`] found a crossing or a duplicate: possible where rounding moves corners by more than a gap.
    Refused(String),
    Failed(String),
}

struct Case {
    number: u64,
    what: String,
    outcome: Outcome,
    time: Duration,
}

#[test]
fn every_domain_is_meshed_by_every_metric() {
    let chosen = chosen_cases();
    let cases = run_all(&chosen.clone().map_or_else(|| CASES.chain(FOUND).collect(), Range::collect::<Vec<u64>>));
    let total = cases.len() as f64;
    let (mut refused, mut missed, mut failed) = (Vec::new(), Vec::new(), Vec::new());
    for case in &cases {
        let line = |text: &str| format!("case {} ({}, {:.2?}): {text}", case.number, case.what, case.time);
        match &case.outcome {
            Outcome::Failed(text) => failed.push(line(text)),
            _ if case.time > SLOWEST => failed.push(line("too slow")),
            Outcome::Missed(text) => missed.push(line(text)),
            Outcome::Refused(text) => refused.push(line(text)),
            Outcome::Meshed(text) if chosen.is_some() => println!("{}", line(text)),
            Outcome::Meshed(_) => {}
        }
    }
    println!("refused {}:\n{}\n", refused.len(), refused.join("\n"));
    println!("vertices missed {}:\n{}\n", missed.len(), missed.join("\n"));
    assert!(failed.is_empty(), "{} of {total} failed:\n{}", failed.len(), failed.join("\n"));
    if chosen.is_none() {
        assert!(refused.len() as f64 <= MOST_REFUSED * total, "too many refused");
        assert!(missed.len() as f64 <= MOST_MISSED * total, "too many miss their number of vertices");
    }
}

fn chosen_cases() -> Option<Range<u64>> {
    let text = std::env::var("RANDOM_CASES").ok()?;
    let (first, last) = text.split_once("..").expect("RANDOM_CASES=first..end");
    Some(first.parse().expect("a number")..last.parse().expect("a number"))
}

/// Two at a time; in the order of their numbers.
fn run_all(numbers: &[u64]) -> Vec<Case> {
    let next = AtomicUsize::new(0);
    let running = Mutex::new(BTreeMap::new());
    let (sender, receiver) = mpsc::channel();
    let work = |sender: mpsc::Sender<Case>| {
        while let Some(&number) = numbers.get(next.fetch_add(1, Ordering::Relaxed)) {
            running.lock().expect("no panic holds it").insert(number, Instant::now());
            sender.send(run(number)).expect("received below");
            running.lock().expect("no panic holds it").remove(&number);
        }
    };
    let mut cases = std::thread::scope(|scope| {
        for sender in [sender.clone(), sender] {
            scope.spawn(|| work(sender));
        }
        collect(&receiver, &running)
    });
    cases.sort_by_key(|case| case.number);
    cases
}

/// All cases as they come in. A case that hangs ends the process, with its number: threads cannot be stopped.
fn collect(receiver: &mpsc::Receiver<Case>, running: &Mutex<BTreeMap<u64, Instant>>) -> Vec<Case> {
    let mut cases = Vec::new();
    loop {
        match receiver.recv_timeout(Duration::from_secs(1)) {
            Ok(case) => cases.push(case),
            Err(RecvTimeoutError::Disconnected) => return cases,
            Err(RecvTimeoutError::Timeout) => {
                let running = running.lock().expect("no panic holds it");
                if let Some((number, _)) = running.iter().find(|(_, since)| since.elapsed() > 3 * SLOWEST) {
                    eprintln!("case {number} hangs");
                    std::process::exit(1);
                }
            }
        }
    }
}

fn run(number: u64) -> Case {
    let start = Instant::now();
    let mut what = String::new();
    let outcome = catch_unwind(AssertUnwindSafe(|| mesh(number, &mut what)))
        .unwrap_or_else(|panic| Outcome::Failed(format!("panic: {}", message(panic.as_ref()))));
    Case { number, what, outcome, time: start.elapsed() }
}

fn message(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().cloned();
    text.or_else(|| panic.downcast_ref::<&str>().map(ToString::to_string)).unwrap_or_default()
}

fn mesh(number: u64, what: &mut String) -> Outcome {
    let mut random = Random::of_case(number);
    let drawn = domains::draw(&mut random);
    drawn.shape.clone_into(what);
    let domain = match Domain::new(&drawn.pslg) {
        Ok(domain) => domain,
        Err(error) => return Outcome::Refused(error.to_string()),
    };
    let (name, metric) = metrics::draw(&mut random, &domain, drawn.placement);
    let options = options(&mut random);
    let target = options.vertices.map_or_else(|| format!("complexity {:?}", options.complexity), |n| format!("-n {n}"));
    *what = format!("{}, {name}, {target}, {:?}", drawn.shape, drawn.placement);
    let meshed = match recipe::mesh(&domain, metric.as_ref(), &options, &Silent) {
        Ok(meshed) => meshed,
        Err(Error::Limit { what, .. }) if options.vertices.is_none() => return Outcome::Meshed(what),
        Err(error) => return Outcome::Failed(error.to_string()),
    };
    let faults = checks::faults(&drawn, &domain, &meshed.mesh);
    if !faults.is_empty() {
        return Outcome::Failed(faults.join("; "));
    }
    let (found, corners) = (meshed.mesh.points.len(), domain.pslg().points.len());
    match options.vertices {
        Some(n) if misses(n.max(corners), found) => {
            Outcome::Missed(format!("{found} vertices of {n}; {corners} corners"))
        }
        _ => Outcome::Meshed(format!("{found} vertices; {:?}", meshed.seconds)),
    }
}

/// Mostly a number of vertices, else a complexity. A long and narrow domain can then need millions of vertices: the
/// limit on memory, enough for the canvas of 2,000, refuses what would take too long for a test.
fn options(random: &mut Random) -> MeshOptions {
    let size = random.size(50.0, 2000.0);
    let target = if random.chance(0.15) { (None, Some(0.5 * size)) } else { (Some(size as usize), None) };
    MeshOptions { vertices: target.0, complexity: target.1, memory_limit: 48 << 20, ..MeshOptions::default() }
}

fn misses(wanted: usize, found: usize) -> bool {
    wanted.abs_diff(found) as f64 > (0.01 * wanted as f64).max(1.0)
}
