//! Meshes in parts, by processes.

use crate::common::{Place, stderr};
use serde_json::Value;
use std::process::{Command, Stdio};
use std::time::Duration;

const SHOCK: [&str; 13] = [
    "mesh",
    "rect:-1,-1,1,1",
    "--metric",
    "shock:phi=1,lambda=0.6",
    "-n",
    "4000",
    "--effort",
    "fast",
    "--parts",
    "3",
    "-q",
    "-o",
    "out.meshb",
];

#[track_caller]
fn made(place: &Place, more: &[&str]) -> Vec<u8> {
    let run = place.run(&[&SHOCK[..], more].concat());
    assert!(run.status.success(), "{}", stderr(&run));
    place.take("out.meshb")
}

#[test]
fn the_mesh_is_the_same_however_many_processes_make_it() {
    let place = Place::new();
    let mesh = made(&place, &["--report", "report.json", "--picture", "out.svg"]);
    let report: Value = serde_json::from_slice(&place.take("report.json")).unwrap();
    assert_eq!((&report["vertices"], &report["options"]["parts"]), (&4000.into(), &"3".into()));
    assert!(report["valid"] == true && report["dual"].is_null(), "{report}");
    place.take("out.svg");
    assert!(mesh == made(&place, &["--threads", "1"]));
    assert!(place.files().is_empty(), "{:?}", place.files());
}

#[test]
fn a_run_goes_on_from_the_parts_of_another() {
    let place = Place::new();
    let mesh = made(&place, &["--parts-dir", "kept"]);
    let kept = place.path().join("kept");
    std::fs::remove_file(kept.join("parts-1.meshb")).unwrap();
    std::fs::write(kept.join("strips-0-job.meshb"), b"half").unwrap();
    let untouched = std::fs::metadata(kept.join("parts-0.meshb")).unwrap().modified().unwrap();
    assert!(mesh == made(&place, &["--parts-dir", "kept", "--threads", "1"]));
    assert_eq!(std::fs::metadata(kept.join("parts-0.meshb")).unwrap().modified().unwrap(), untouched);
    let other = place.run(&[&SHOCK[..], &["--parts-dir", "kept", "--h-max", "0.1"]].concat());
    let said = stderr(&other);
    assert!(!other.status.success() && said.contains("kept holds the parts of another job"), "{said}");
}

/// A file of the same name with other values is another job.
#[test]
fn parts_of_another_metric_are_not_taken() {
    let place = Place::new();
    let square = "MeshVersionFormatted 2\nDimension 2\nVertices\n4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\nTriangles\n2\n1 2 3 0\n1 3 4 0\nEnd\n";
    place.put("square.mesh", square);
    let run = |size: &str| {
        place.put(
            "h.sol",
            format!("MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n4\n1 1\n0.02\n0.02\n{size}\n0.02\nEnd\n"),
        );
        let words =
            ["mesh", "square.mesh", "--metric", "h.sol", "-n", "2000", "--effort", "fast", "-q", "-o", "out.meshb"];
        place.run(&[&words[..], &["--parts", "2", "--parts-dir", "kept"]].concat())
    };
    assert!(run("0.03").status.success());
    let kept: Vec<_> =
        std::fs::read_dir(place.path().join("kept")).unwrap().map(|file| file.unwrap().file_name()).collect();
    assert!(!kept.iter().any(|name| name.to_string_lossy().contains("metric")), "{kept:?}");
    assert!(run("0.03").status.success());
    let said = stderr(&run("0.02"));
    assert!(said.contains("kept holds the parts of another job"), "{said}");
}

/// Whoever is stopped stops its processes; what they have done stays.
#[test]
#[cfg(unix)]
fn a_run_that_was_stopped_goes_on() {
    let place = Place::new();
    let mut run = Command::new(env!("CARGO_BIN_EXE_voronaut"));
    run.args(SHOCK).args(["--parts-dir", "kept"]).current_dir(place.path()).stderr(Stdio::null());
    let mut run = run.spawn().unwrap();
    let first = ["parts-0.meshb", "parts-1.meshb", "parts-2.meshb"].map(|name| place.path().join("kept").join(name));
    for _ in 0..2400 {
        if first.iter().any(|file| file.exists()) {
            break;
        }
        std::thread::sleep(Duration::from_millis(25));
    }
    assert!(first.iter().any(|file| file.exists()), "no part in a minute");
    Command::new("kill").args(["-TERM".into(), run.id().to_string()]).status().unwrap();
    run.wait().unwrap();
    let mesh = made(&place, &["--parts-dir", "kept"]);
    assert!(mesh == made(&place, &[]));
}

#[test]
fn a_part_that_fails_is_named_with_its_place() {
    let place = Place::new();
    let large = SHOCK.map(|word| if word == "4000" { "400000" } else { word });
    let run = place.run(&[&large[..], &["--memory-limit", "0.1"]].concat());
    let said = stderr(&run);
    assert!(!run.status.success() && said.contains("parts "), "{said}");
    assert!(said.contains(", from (") && said.contains("are estimated to need") && said.contains("help: "), "{said}");
    assert!(place.files().is_empty(), "{:?}", place.files());
}

/// The equation's surface is given by triangles that the program makes: every process makes the same.
#[test]
fn a_surface_in_parts_is_the_same_however_many_processes_make_it() {
    let place = Place::new();
    let words = [
        "mesh",
        "sphere:1",
        "--metric",
        "uniform",
        "-n",
        "4000",
        "--effort",
        "fast",
        "--parts",
        "3",
        "-q",
        "-o",
        "out.meshb",
    ];
    let made = |more: &[&str]| {
        let run = place.run(&[&words[..], more].concat());
        assert!(run.status.success(), "{}", stderr(&run));
        place.take("out.meshb")
    };
    let mesh = made(&["--report", "report.json"]);
    let report: Value = serde_json::from_slice(&place.take("report.json")).unwrap();
    assert_eq!((&report["vertices"], &report["euler"]), (&4000.into(), &2.into()), "{}", report["notes"]);
    assert!(report["valid"] == true && report["metric_edge_length"]["unit_fraction"].as_f64() > Some(0.99), "{report}");
    assert!(mesh == made(&["--threads", "1"]));
}
