//! Runs that end before their end: by limits of time and memory, and by signals. They say so and leave nothing behind.

use crate::common::{Place, stderr};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

const LONG: [&str; 8] = ["mesh", "rect:-2,-2,2,2", "--metric", "swirl", "-n", "200000", "-o", "out.mesh"];

fn demand_stopped(run: &Output, place: &Place, expected: &[&str]) {
    let said = stderr(run);
    assert_eq!(run.status.code(), Some(1), "{said}");
    assert!(expected.iter().all(|text| said.contains(text)) && said.contains("help:"), "{said}");
    assert!(place.files().is_empty(), "{:?}", place.files());
}

#[test]
fn a_run_ends_at_its_time_limit() {
    let place = Place::new();
    let run = place.run(&[&LONG[..], &["--time-limit", "0.4"]].concat());
    demand_stopped(&run, &place, &["not done within 0.4 s, in the stage: ", "--time-limit"]);
}

#[test]
fn work_beyond_the_memory_limit_is_refused() {
    let place = Place::new();
    let run = place.run(&[&LONG[..], &["--memory-limit", "0.1"]].concat());
    demand_stopped(&run, &place, &["vertices are estimated to need", "--memory-limit"]);
}

/// What a file becomes in memory is not known before it is read.
#[test]
#[cfg(target_os = "linux")]
fn memory_beyond_the_limit_ends_the_run() {
    let (place, inputs) = (Place::new(), Place::new());
    let text = "v 0 0 0\n".repeat(5_000_000) + "v 1 0 0\nv 0 1 0\nf 1 5000001 5000002\n";
    inputs.put("large.obj", text);
    let input = inputs.path().join("large.obj").display().to_string();
    let run = place.run(&["convert", &input, "out.ply", "--memory-limit", "0.04"]);
    demand_stopped(&run, &place, &["GiB of memory were held, more than 0.04, in the stage: reading"]);
}

/// Who reads what a run says may be gone before it: as a pipeline that is killed.
#[test]
#[cfg(unix)]
fn a_signal_ends_a_run_that_nobody_hears() {
    let place = Place::new();
    let mut command = Command::new(env!("CARGO_BIN_EXE_voronaut"));
    command.args(LONG).current_dir(place.path()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut run = command.spawn().unwrap();
    drop((run.stdout.take(), run.stderr.take()));
    std::thread::sleep(Duration::from_millis(300));
    Command::new("kill").args(["-TERM".into(), run.id().to_string()]).status().unwrap();
    for _ in 0..200 {
        if let Some(status) = run.try_wait().unwrap() {
            assert_eq!(status.code(), Some(1));
            assert!(place.files().is_empty(), "{:?}", place.files());
            return;
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    run.kill().unwrap();
    panic!("it goes on");
}

/// Whenever a signal comes, each file is whole or not there, and nothing else is.
#[test]
#[cfg(unix)]
fn signals_leave_nothing_behind() {
    let line = "boundary:h0=0.02,growth=1.3";
    let commands: [&[&str]; 4] = [
        &["mesh", "rect:-2,-2,2,2", "--metric", "swirl", "-n", "3000", "-o", "a.mesh", "--report", "a.json"],
        &["mesh", "torus:2,0.7", "--metric", "curvature", "-n", "800", "-o", "a.vtu"],
        &["distance", "rect:0,0,1,1", "--metric", line, "--from", "0.5,0.5", "-o", "a.vtu"],
        &[
            "loop",
            "rect:0,0,1,1",
            "--solver",
            "sleep 1; true {mesh} {out}",
            "-n",
            "50",
            "--iterations",
            "2",
            "-o",
            "a.mesh",
        ],
    ];
    for (i, (words, signal)) in (0_u64..).zip(commands.iter().flat_map(|words| [(words, "INT"), (words, "TERM")])) {
        let (place, temporary) = (Place::new(), Place::new());
        let run = Command::new(env!("CARGO_BIN_EXE_voronaut"))
            .args(*words)
            .current_dir(place.path())
            .env("TMPDIR", temporary.path())
            .stderr(Stdio::piped())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        // Before the program runs, in the midst of it, or after its end.
        std::thread::sleep(Duration::from_millis(20 + 37 * i));
        Command::new("kill").args([format!("-{signal}"), run.id().to_string()]).status().unwrap();
        let run = run.wait_with_output().unwrap();
        assert!(run.status.success() || stderr(&run).contains("stopped by a signal"), "{words:?}: {run:?}");
        assert!(place.files().iter().all(|name| name.starts_with("a.")), "{words:?}: {:?}", place.files());
        assert!(temporary.files().is_empty(), "{words:?}: {:?}", temporary.files());
    }
}

#[test]
fn more_threads_than_machines_have_are_wrong_usage() {
    let run = Place::new().run(&[&LONG[..], &["--threads", "65535"]].concat());
    assert_eq!(run.status.code(), Some(2), "{}", stderr(&run));
}

#[test]
fn protection_beyond_that_of_equilateral_triangles_is_refused() {
    let place = Place::new();
    let words =
        ["mesh", "rect:0,0,1,1", "--metric", "uniform", "-n", "150", "-o", "out.mesh", "--seeding", "protected"];
    let run = place.run(&[&words[..], &["--protection", "2"]].concat());
    demand_stopped(&run, &place, &["protection by 2 epsilon", "lower --protection"]);
}

/// A link to a file that is not there yet stays one.
#[test]
#[cfg(unix)]
fn dangling_links_are_followed() {
    let (place, elsewhere) = (Place::new(), Place::new());
    let target = elsewhere.path().join("real.mesh");
    std::os::unix::fs::symlink(&target, place.path().join("out.mesh")).unwrap();
    let words = ["mesh", "rect:0,0,1,1", "--metric", "uniform", "-n", "50", "-o", "out.mesh"];
    assert!(place.run(&words).status.success());
    assert_eq!((place.files(), elsewhere.files()), (vec!["out.mesh".into()], vec!["real.mesh".into()]));
    assert_eq!(std::fs::read_link(place.path().join("out.mesh")).unwrap(), target);
}

#[test]
fn a_certificate_of_few_seeds_has_no_numbers_that_are_none() {
    let place = Place::new();
    place.put("seeds.txt", "0.2 0.5\n0.8 0.5\n0.5 0.9\n");
    let words = ["dual", "rect:0,0,1,1", "--metric", "uniform", "--seeds", "seeds.txt", "-o", "out.mesh", "--certify"];
    let run = place.run(&words);
    let said = String::from_utf8(run.stdout).unwrap();
    assert!(said.contains("covered      none of 3 seeds") && !said.contains("NaN"), "{said}");
}
