//! The good paths: every input and output format, labels and regions carried, reports complete, results the same for
//! any number of threads.

use crate::common::{Place, stderr};
use serde_json::Value;
use std::collections::BTreeSet;

fn runs(place: &Place, words: &[&str]) {
    let output = place.run(words);
    assert!(output.status.success(), "{words:?}: {}", stderr(&output));
}

/// Meshes, checks the mesh against its domain, and returns both reports.
fn round_trip(place: &Place, domain: &str, metric: &str, count: &str) -> [Value; 2] {
    runs(place, &["mesh", domain, "--metric", metric, "-n", count, "-o", "out.mesh", "--report", "made.json"]);
    let made: Value = serde_json::from_slice(&place.read("made.json")).unwrap();
    let scale = made["metric_scale"].to_string();
    let words = ["check", "out.mesh", "--domain", domain, "--metric", metric, "--metric-scale", &scale];
    runs(place, &[&words[..], &["--report", "checked.json"]].concat());
    [made, serde_json::from_slice(&place.read("checked.json")).unwrap()]
}

/// Labels of the edges and of the triangles in `out.mesh`.
fn labels(place: &Place) -> [BTreeSet<i32>; 2] {
    let text = String::from_utf8(place.read("out.mesh")).unwrap();
    let mesh = voronaut_io::medit::read(text.as_bytes(), "out.mesh").unwrap().mesh;
    [mesh.edge_labels, mesh.triangle_labels].map(BTreeSet::from_iter)
}

fn assert_same_mesh(place: &Place, domain: &str, metric: &str, count: u64) {
    let [made, checked] = round_trip(place, domain, metric, &count.to_string());
    assert_eq!(made["valid"], true);
    for key in ["vertices", "triangles", "valid", "euler", "metric_edge_length", "quality", "angle", "boundary_loops"] {
        assert_eq!(made[key], checked[key], "{domain}: {key}");
    }
    let found = made["vertices"].as_u64().unwrap();
    assert!(found.abs_diff(count) * 100 <= count, "{domain}: {found} vertices");
    let strayed = checked["fidelity"]["mesh_to_domain"]["distance"].as_f64().unwrap();
    let allowed = if domain.starts_with("disk") { 1e-2 } else { 1e-14 };
    assert!(strayed <= allowed, "{domain}: {strayed}");
}

/// Two regions (5 and 6), a hole, five labels.
const PLATE: &str = "10 2 0 0\n1 0 0\n2 2 0\n3 4 0\n4 4 2\n5 2 2\n6 0 2\n7 0.5 0.5\n8 1 0.5\n9 1 1\n10 0.5 1\n\
                     11 1\n1 1 2 11\n2 2 3 11\n3 3 4 12\n4 4 5 13\n5 5 6 13\n6 6 1 14\n7 2 5 15\n\
                     8 7 8 16\n9 8 9 16\n10 9 10 16\n11 10 7 16\n1\n1 0.7 0.7\n2\n1 0.1 0.1 5\n2 3 1 6\n";

#[test]
fn shapes_are_meshed_and_found_to_be_what_was_said() {
    let place = Place::new();
    assert_same_mesh(&place, "rect:-1,-1,1,1", "shock:phi=1", 400);
    assert_eq!(labels(&place), [[1, 2, 3, 4].into(), [1].into()]);
    assert_same_mesh(&place, "disk:0,0,1", "swirl", 400);
    assert_eq!(labels(&place), [[1].into(), [1].into()]);
}

#[test]
fn required_curves_stay_as_they_are() {
    let place = Place::new();
    place.put("plate.poly", PLATE);
    let words = ["mesh", "plate.poly", "--metric", "uniform", "-n", "400", "-o", "out.mesh"];
    let edges = |more: &[&str]| {
        runs(&place, &[&words[..], more].concat());
        let text = String::from_utf8(place.read("out.mesh")).unwrap();
        let mesh = voronaut_io::medit::read(text.as_bytes(), "out.mesh").unwrap().mesh;
        (mesh.edges.len(), mesh.required_edges.len())
    };
    assert!(edges(&[]).0 > 40);
    assert_eq!(edges(&["--required"]), (11, 11));
}

#[test]
fn poly_labels_and_regions_are_carried() {
    let place = Place::new();
    place.put("plate.poly", PLATE);
    assert_same_mesh(&place, "plate.poly", "boundary:h0=0.05,growth=1.3", 500);
    assert_eq!(labels(&place), [(11..=16).collect(), [5, 6].into()]);
}

#[test]
fn a_mesh_is_a_domain_again() {
    let place = Place::new();
    place.put("plate.poly", PLATE);
    runs(&place, &["mesh", "plate.poly", "--metric", "uniform", "-n", "300", "-o", "plate.mesh"]);
    assert_same_mesh(&place, "plate.mesh", "uniform:9,0,1", 400);
    assert_eq!(labels(&place), [(11..=16).collect(), [5, 6].into()]);
}

#[test]
fn geojson_is_meshed_with_its_holes() {
    let place = Place::new();
    let rings = "[[0,0],[4,0],[4,4],[0,4],[0,0]],[[1,1],[1,2],[2,2],[2,1],[1,1]]";
    place.put("sea.geojson", format!(r#"{{"type":"Polygon","coordinates":[{rings}]}}"#));
    assert_same_mesh(&place, "sea.geojson", "formula:1+x^2; 0; 1", 300);
    let report: Value = serde_json::from_slice(&place.read("made.json")).unwrap();
    assert_eq!(report["boundary_loops"], 2);
    assert!((report["area"].as_f64().unwrap() - 15.0).abs() < 1e-12);
}

#[test]
fn a_solution_on_the_domain_s_own_mesh_is_a_metric() {
    let place = Place::new();
    runs(&place, &["mesh", "rect:0,0,1,1", "--metric", "uniform", "-n", "50", "-o", "back.mesh"]);
    let sizes = "0.1\n".repeat(50);
    place.put("size.sol", format!("MeshVersionFormatted 2\nDimension 2\nSolAtVertices 50\n1 1\n{sizes}End\n"));
    runs(&place, &["mesh", "back.mesh", "--metric", "size.sol", "-o", "out.mesh", "--report", "r.json"]);
    let report: Value = serde_json::from_slice(&place.read("r.json")).unwrap();
    let (vertices, scale) = (report["vertices"].as_u64().unwrap(), report["metric_scale"].as_f64().unwrap());
    assert!((110..170).contains(&vertices) && (scale - 1.0).abs() < f64::EPSILON, "{vertices}, {scale}");
}

#[test]
fn every_output_is_written_whole_and_nothing_else() {
    let place = Place::new();
    let square = ["mesh", "rect:0,0,1,1", "--metric", "uniform:4,0,1", "-n", "60"];
    runs(&place, &[&square[..], &["-o", "a.vtu", "--picture", "a.svg", "--show", "mesh,ellipses"]].concat());
    runs(&place, &[&square[..], &["-o", "a.obj", "--picture", "a.png"]].concat());
    runs(&place, &[&square[..], &["-o", "a.mesh", "--report", "a.json", "-q"]].concat());
    assert_eq!(place.files(), ["a.json", "a.mesh", "a.obj", "a.png", "a.svg", "a.vtu"]);
    // A .vtu holds raw binary between its first and last tags.
    let text = |name: &str| String::from_utf8_lossy(&place.read(name)).into_owned();
    assert!(text("a.vtu").contains("<VTKFile") && text("a.vtu").trim_end().ends_with("</VTKFile>"));
    assert!(text("a.svg").contains("<svg") && text("a.svg").trim_end().ends_with("</svg>"));
    assert_eq!(text("a.obj").lines().filter(|line| line.starts_with("v ")).count(), 60);
    assert!(place.read("a.png").starts_with(b"\x89PNG"));
    assert!(text("a.mesh").trim_end().ends_with("End"));
}

#[test]
fn quiet_means_quiet() {
    let place = Place::new();
    let output = place.run(&["mesh", "rect:0,0,1,1", "--metric", "uniform", "-n", "3", "-o", "a.mesh", "-q"]);
    assert!(output.status.success() && output.stdout.is_empty() && output.stderr.is_empty(), "{}", stderr(&output));
}

#[test]
fn a_report_has_every_key() {
    let place = Place::new();
    let [made, _] = round_trip(&place, "rect:0,0,1,1", "uniform", "60");
    for key in [
        "vertices",
        "triangles",
        "valid",
        "inverted",
        "non_manifold_edges",
        "duplicate_vertices",
        "euler",
        "area",
        "metric_edge_length",
        "quality",
        "angle",
        "canvas",
        "diagram",
        "dual",
        "seconds",
        "peak_memory_bytes",
        "version",
        "options",
    ] {
        assert!(made.get(key).is_some(), "{key}");
    }
    let numbers = [
        ("metric_edge_length", &["min", "mean", "max", "std", "unit_fraction"][..]),
        ("quality", &["min", "mean"]),
        ("angle", &["min", "mean_min"]),
        ("dual", &["uncertain", "min_margin", "blocked_flips"]),
        ("seconds", &["total"]),
    ];
    for (group, keys) in numbers {
        assert!(keys.iter().all(|key| made[group][key].is_number()), "{group}: {}", made[group]);
    }
    assert!(made["dual"]["geodesic_tests"].is_array());
    for key in ["domain", "metric", "vertices", "out", "hausd", "lloyd", "threads", "memory_limit"] {
        assert!(made["options"].get(key).is_some(), "options: {key}");
    }
}

#[test]
fn threads_do_not_change_a_byte() {
    let place = Place::new();
    for (threads, out) in [("1", "one.mesh"), ("2", "two.mesh")] {
        let words = ["mesh", "rect:-1,-1,1,1", "--metric", "shock:phi=5,lambda=0.2", "-n", "500", "-o", out];
        runs(&place, &[&words[..], &["--threads", threads]].concat());
    }
    assert!(place.read("one.mesh") == place.read("two.mesh"));
}

#[test]
fn corners_beyond_the_count_are_kept_and_said() {
    let place = Place::new();
    let words = ["mesh", "disk:0,0,1", "--metric", "uniform", "-n", "100", "--hausd", "0", "-o", "a.mesh"];
    let output = place.run(&words);
    assert!(output.status.success() && stderr(&output).contains("own corners are 4096"), "{}", stderr(&output));
}

/// Borders that were drawn twice, not quite the same, and a district that reaches into another.
#[test]
fn outlines_that_overlap_are_repaired_where_that_is_asked_for() {
    let place = Place::new();
    let feature = |ring: &str| {
        let geometry = format!(r#"{{"type":"Polygon","coordinates":[[{ring}]]}}"#);
        format!(r#"{{"type":"Feature","properties":{{}},"geometry":{geometry}}}"#)
    };
    let features = [
        feature("[0,0],[2,0],[2,1],[2,2],[0,2],[0,0]"),
        feature("[2.0000000000001,0],[4,0],[4,2],[1.9999999999999,2],[2.0000000000001,0]"),
        feature("[3,1],[5,1],[5,3],[3,3],[3,1]"),
    ];
    let text = format!(r#"{{"type":"FeatureCollection","features":[{}]}}"#, features.join(","));
    place.put("districts.geojson", text);
    let words = ["mesh", "districts.geojson", "--metric", "uniform", "-n", "300", "-o", "a.mesh", "--report", "a.json"];
    assert!(stderr(&place.run(&words)).contains("overlaps itself"));
    runs(&place, &[&words[..], &["--repair"]].concat());
    let report: Value = serde_json::from_slice(&place.read("a.json")).unwrap();
    assert!((report["area"].as_f64().unwrap() - 11.0).abs() < 1e-9, "{}", report["area"]);
    assert!(
        report["notes"].to_string().contains("1 area of several polygons is the first one's"),
        "{}",
        report["notes"]
    );
}
