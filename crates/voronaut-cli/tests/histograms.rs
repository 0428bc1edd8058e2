//! `--histograms` and `--smooth-metric`: drawn, reported, refused.

use crate::common::{Place, stderr};
use serde_json::Value;

fn runs(place: &Place, words: &[&str]) {
    let output = place.run(words);
    assert!(output.status.success(), "{words:?}: {}", stderr(&output));
}

fn report(place: &Place, name: &str) -> Value {
    serde_json::from_slice(&place.read(name)).unwrap()
}

fn sum(counts: &Value) -> u64 {
    counts.as_array().unwrap().iter().map(|count| count.as_u64().unwrap()).sum()
}

const SHOCK: [&str; 6] = ["mesh", "rect:-1,-1,1,1", "--metric", "shock:phi=1", "-n", "300"];

#[test]
fn histograms_are_drawn_and_reported_for_meshes_checks_and_duals() {
    let place = Place::new();
    let figures = ["--histograms", "a.svg", "--report", "a.json", "-q"];
    runs(&place, &[&SHOCK[..], &["-o", "a.mesh"], &figures].concat());
    let made = report(&place, "a.json");
    let found = &made["histograms"];
    assert_eq!(sum(&found["angle"]["straight"]), 3 * made["triangles"].as_u64().unwrap());
    assert_eq!(sum(&found["angle"]["geodesic"]), 3 * made["triangles"].as_u64().unwrap());
    // Euler: V - E + F = 1.
    let edges = made["vertices"].as_u64().unwrap() + made["triangles"].as_u64().unwrap() - 1;
    assert_eq!((sum(&found["edge_length"]["straight"]), sum(&found["edge_length"]["geodesic"])), (edges, edges));
    let bounds = |key: &str| found[key]["bounds"].as_array().unwrap().len();
    assert_eq!((bounds("edge_length"), bounds("angle")), (41, 60));
    assert_eq!(found["unit_fraction"]["straight"], made["metric_edge_length"]["unit_fraction"]);
    let text = String::from_utf8(place.read("a.svg")).unwrap();
    assert!(text.starts_with("<svg") && text.contains("Metric edge lengths") && text.ends_with("</svg>\n"));

    let scale = made["metric_scale"].to_string();
    let check = ["check", "a.mesh", "--metric", "shock:phi=1", "--metric-scale", &scale];
    runs(&place, &[&check[..], &["--histograms", "b.svg", "--report", "b.json", "-q"]].concat());
    assert_eq!(&report(&place, "b.json")["histograms"], found);

    place.put("seeds.txt", "0 0\n0.5 0.1\n0.1 0.6\n-0.4 0.2\n-0.1 -0.5\n");
    let dual = ["dual", "rect:-1,-1,1,1", "--metric", "uniform", "--seeds", "seeds.txt", "-o", "d.mesh"];
    runs(&place, &[&dual[..], &["--histograms", "d.svg", "--report", "d.json", "-q"]].concat());
    let dual = report(&place, "d.json");
    assert_eq!(dual["histograms"]["angle"]["straight"], dual["histograms"]["angle"]["geodesic"]);
}

/// Straight edges of a sphere are shorter than the arcs over them, and triangles of arcs have more than 180 degrees.
#[test]
fn surfaces_have_histograms() {
    let place = Place::new();
    let sphere = ["mesh", "sphere:1", "--metric", "uniform", "-n", "120", "-o", "s.mesh", "-q"];
    runs(&place, &[&sphere[..], &["--histograms", "s.svg", "--report", "s.json"]].concat());
    let made = report(&place, "s.json");
    let found = &made["histograms"];
    assert_eq!(sum(&found["angle"]["geodesic"]), 3 * made["triangles"].as_u64().unwrap());
    let mean = |key: &str, kind: &str| found[key]["mean"][kind].as_f64().unwrap();
    assert!(mean("edge_length", "geodesic") > 1.005 * mean("edge_length", "straight"), "{found:#}");
    // Girard: the excess is the area, 4 pi, over three corners of each triangle.
    let excess = 720.0 / (3.0 * made["triangles"].as_f64().unwrap());
    assert!((mean("angle", "geodesic") - 60.0 - excess).abs() < 0.02 * excess, "{found:#}");
    assert!((mean("angle", "straight") - 60.0).abs() < 1e-9);
    let scale = made["metric_scale"].to_string();
    let check = ["check", "s.mesh", "--domain", "sphere:1", "--metric", "uniform", "--metric-scale", &scale];
    runs(&place, &[&check[..], &["--histograms", "c.svg", "--report", "c.json", "-q"]].concat());
    assert_eq!(report(&place, "c.json")["histograms"]["edge_length"]["straight"], found["edge_length"]["straight"]);
    assert!(String::from_utf8(place.read("c.svg")).unwrap().contains("Metric edge lengths"));
}

#[test]
fn without_being_asked_for_there_are_no_histograms() {
    let place = Place::new();
    runs(&place, &[&SHOCK[..], &["-o", "a.mesh", "--report", "a.json", "-q"]].concat());
    let made = report(&place, "a.json");
    assert!(made.get("histograms").is_none() && made["options"]["histograms"].is_null());
    assert_eq!(made["options"]["smooth_metric"], 0);
}

#[test]
fn histograms_that_cannot_be_are_refused() {
    let place = Place::new();
    for (more, code, says) in [
        (&["--histograms", "a.png"][..], 1, "end the name of the histograms in .svg"),
        (&["--histograms", "a.svg", "--picture", "a.svg"], 1, "two outputs have the same name"),
        (&["--histograms", "no/a.svg"], 1, "no"),
        (&["--smooth-metric", "-1"], 2, "-1 is not in 0..=10000"),
        (&["--smooth-metric", "1000000"], 2, "1000000 is not in 0..=10000"),
        (&["--smooth-metric", "some"], 2, "invalid value 'some'"),
    ] {
        let output = place.run(&[&SHOCK[..], &["-o", "a.mesh"], more].concat());
        assert_eq!(output.status.code(), Some(code), "{more:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(says), "{more:?}: {}", stderr(&output));
    }
    assert!(place.files().is_empty());
}

#[test]
fn no_sweep_of_smoothing_changes_no_bit_and_sweeps_do() {
    let place = Place::new();
    runs(&place, &[&SHOCK[..], &["-o", "a.mesh", "-q"]].concat());
    runs(&place, &[&SHOCK[..], &["-o", "b.mesh", "-q", "--smooth-metric", "0"]].concat());
    runs(&place, &[&SHOCK[..], &["-o", "c.mesh", "-q", "--smooth-metric", "400", "--threads", "1"]].concat());
    runs(&place, &[&SHOCK[..], &["-o", "d.mesh", "-q", "--smooth-metric", "400", "--threads", "2"]].concat());
    assert!(place.read("a.mesh") == place.read("b.mesh"));
    assert!(place.read("a.mesh") != place.read("c.mesh"));
    assert!(place.read("c.mesh") == place.read("d.mesh"));
}

#[test]
fn a_solution_is_smoothed_on_its_own_mesh() {
    let place = Place::new();
    runs(&place, &["mesh", "rect:0,0,1,1", "--metric", "uniform", "-n", "50", "-o", "back.mesh", "-q"]);
    let sizes: String = (0..50).map(|i| if i == 0 { "0.01\n" } else { "0.1\n" }).collect();
    place.put("size.sol", format!("MeshVersionFormatted 2\nDimension 2\nSolAtVertices 50\n1 1\n{sizes}End\n"));
    let vertices = |sweeps: &str| {
        let words = ["mesh", "back.mesh", "--metric", "size.sol", "-o", "out.mesh", "--report", "r.json", "-q"];
        runs(&place, &[&words[..], &["--smooth-metric", sweeps]].concat());
        report(&place, "r.json")["vertices"].as_u64().unwrap()
    };
    // One size among fifty is a tenth of the others: smoothed, it asks for fewer vertices.
    let (sharp, smooth) = (vertices("0"), vertices("100"));
    assert!(smooth < sharp, "{smooth} {sharp}");
}
