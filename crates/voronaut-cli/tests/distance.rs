//! `voronaut distance`: every method, files and figures, faults by their names.

use crate::common::{Place, stderr};
use serde_json::Value;

const METHODS: [&str; 6] = ["march", "stvd", "dijkstra", "konukoglu", "lbr", "heat"];

fn words<'a>(more: &[&'a str]) -> Vec<&'a str> {
    let uniform = ["distance", "rect:0,0,2,1", "--metric", "uniform:4,0,1", "-o", "out.vtu", "--canvas-size", "2000"];
    [&uniform[..], more].concat()
}

#[test]
fn every_method_writes_its_field_and_path() {
    let place = Place::new();
    let canvases = ["intrinsic", "isotropic", "starset"];
    for (canvas, method) in canvases.iter().flat_map(|&canvas| METHODS.map(|method| (canvas, method))) {
        let more =
            ["--from", "0.1,0.5", "--from", "0.1,0.9", "--to", "1.6,0.5", "--geodesic", method, "--canvas", canvas];
        let files = ["--report", "out.json", "--picture", "out.svg", "--pixels", "200"];
        let output = place.run(&words(&[&more[..], &files].concat()));
        assert!(output.status.success(), "{method} on {canvas}: {}", stderr(&output));
        let report: Value = serde_json::from_slice(&place.read("out.json")).unwrap();
        for key in ["distance", "path_length"] {
            let length = report[key].as_f64().unwrap();
            assert!(length > 2.9 && length < 3.3, "{method} on {canvas}: {key} {length}");
        }
        assert_eq!((&report["geodesic"], &report["unreached"]), (&Value::from(method), &Value::from(0)));
        assert_eq!(report["canvas"]["kind"], canvas);
        assert!(report["canvas"]["vertices"].as_u64().unwrap() >= 2000);
        let file = place.read("out.vtu");
        assert!(String::from_utf8_lossy(&file[..2000]).contains("Name=\"distance\""));
        assert!(String::from_utf8(place.read("out.svg")).unwrap().ends_with("</svg>\n"));
        assert_eq!(place.files(), ["out.json", "out.svg", "out.vtu"]);
    }
}

#[test]
fn faults_are_named() {
    let place = Place::new();
    let fails = |more: &[&str], code: i32, said: &str| {
        let output = place.run(&words(more));
        assert_eq!(output.status.code(), Some(code), "{more:?}");
        assert!(stderr(&output).contains(said), "{more:?}: {}", stderr(&output));
        assert!(place.files().is_empty());
    };
    fails(&[], 2, "--from <X,Y[,Z]>");
    fails(&["--from", "1"], 2, "write two numbers, X,Y");
    fails(&["--from", "1,2,3"], 1, "--from (1, 2, 3): a point of space, and the domain is planar");
    fails(&["--from", "1,2,3,4"], 2, "write two numbers, X,Y");
    fails(&["--from", "1,nan"], 2, "write two numbers, X,Y");
    fails(&["--from", "-1,0.5"], 1, "a point outside the domain at --from (-1, 0.5)");
    fails(&["--from", "1,0.5", "--to", "9,9"], 1, "--to (9, 9)");
    fails(&["--from", "1,0.5", "--geodesic", "mmp"], 2, "no such method");
    fails(&["--from", "1,0.5", "--picture", "out.gif"], 1, "out.gif");
    fails(&["--from", "1,0.5", "--memory-limit", "0.0001"], 1, "raise --memory-limit");
}

#[test]
fn diagrams_are_driven_by_methods_that_can() {
    let place = Place::new();
    place.put("seeds.txt", "0.3 0.3\n1.5 0.4\n0.9 0.8\n1.2 0.2\n");
    let dual = ["dual", "rect:0,0,2,1", "--metric", "uniform", "--seeds", "seeds.txt", "-o", "out.mesh", "-q"];
    let mesh = [
        "mesh",
        "rect:0,0,2,1",
        "--metric",
        "uniform",
        "-n",
        "60",
        "--dual",
        "canvas",
        "--canvas-size",
        "4",
        "-o",
        "out.mesh",
        "-q",
    ];
    for method in ["march", "stvd:window=4", "dijkstra", "konukoglu"] {
        for words in [&[&dual[..], &["--canvas-size", "4"]].concat(), &mesh[..]] {
            let more = ["--geodesic", method, "--report", "out.json"];
            let output = place.run(&[words, &more].concat());
            assert!(output.status.success(), "{method}: {}", stderr(&output));
            let report: Value = serde_json::from_slice(&place.read("out.json")).unwrap();
            assert_eq!(report["options"]["geodesic"], method);
        }
    }
    for words in [&dual[..], &mesh[..]] {
        let output = place.run(&[words, &["--geodesic", "heat"]].concat());
        assert_eq!(output.status.code(), Some(1));
        let said = stderr(&output);
        assert!(said.contains("a diagram by heat") && said.contains("march, stvd, dijkstra, konukoglu"), "{said}");
    }
}

#[test]
fn paths_go_around_holes() {
    let place = Place::new();
    let plate = r#"{ "type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 2], [0, 2], [0, 0]],
        [[1, 0.5], [2, 0.5], [2, 1.5], [1, 1.5], [1, 0.5]]] }"#;
    place.put("plate.geojson", plate);
    let exact = 2.0 * 0.5_f64.hypot(0.5) + 1.0;
    for method in METHODS {
        let words = ["distance", "plate.geojson", "--metric", "uniform", "--from", "0.5,1", "--to", "2.5,1"];
        let more = ["-o", "out.vtu", "--report", "out.json", "--canvas-size", "4000", "--geodesic", method];
        let output = place.run(&[&words[..], &more].concat());
        assert!(output.status.success(), "{method}: {}", stderr(&output));
        let report: Value = serde_json::from_slice(&place.read("out.json")).unwrap();
        for key in ["distance", "path_length"] {
            let length = report[key].as_f64().unwrap();
            // The straight pieces of stvd cut the hole's corners.
            assert!(length > 0.9 * exact && length < 1.1 * exact, "{method}: {key} {length} {exact}");
        }
    }
}

#[test]
fn distances_on_surfaces_are_great_circles() {
    let place = Place::new();
    let canvases = ["intrinsic", "isotropic", "starset"];
    let methods = METHODS.iter().filter(|&&method| method != "lbr");
    for (canvas, method) in methods.flat_map(|&method| canvases.map(|canvas| (canvas, method))) {
        let words = ["distance", "sphere:2", "--metric", "uniform", "--from", "2,0,0", "--from", "0,0,-2.01"];
        let more = ["--to", "0,1.2,1.6", "-o", "out.vtu", "--canvas-size", "3000", "--geodesic", method];
        let files = ["--canvas", canvas, "--report", "out.json", "--picture", "out.svg", "--pixels", "200"];
        let output = place.run(&[&words[..], &more, &files].concat());
        assert!(output.status.success(), "{method} on {canvas}: {}", stderr(&output));
        let report: Value = serde_json::from_slice(&place.read("out.json")).unwrap();
        let exact = std::f64::consts::PI;
        for key in ["distance", "path_length"] {
            let length = report[key].as_f64().unwrap();
            assert!(length > 0.97 * exact && length < 1.15 * exact, "{method} on {canvas}: {key} {length}");
        }
        if method == "march" {
            assert!((report["path_length"].as_f64().unwrap() / exact - 1.0).abs() < 1e-5);
        }
        assert_eq!((&report["unreached"], &report["canvas"]["kind"]), (&Value::from(0), &Value::from(canvas)));
        assert_eq!((&report["from"][1][2], report["to"].as_array().unwrap().len()), (&Value::from(-2.0), 3));
        assert!(String::from_utf8_lossy(&place.read("out.vtu")[..2000]).contains("Name=\"distance\""));
        assert!(String::from_utf8(place.read("out.svg")).unwrap().contains("<image"));
        assert_eq!(place.files(), ["out.json", "out.svg", "out.vtu"]);
    }
}

#[test]
fn lengths_over_folds_are_exact() {
    let place = Place::new();
    // Two sides of a box, folded upwards along the y axis.
    place.put("fold.off", "OFF 6 4 0\n1 0 0\n1 2 0\n0 0 0\n0 2 0\n0 0 1\n0 2 1\n3 0 1 2\n3 1 3 2\n3 2 3 4\n3 3 5 4\n");
    let words =
        ["distance", "fold.off", "--metric", "formula:4; 0; 1; 0; 0; 4", "--from", "0.9,0.3,0", "--to", "0,1.5,0.6"];
    let output = place.run(&[&words[..], &["-o", "out.vtu", "--report", "out.json", "--canvas-size", "3000"]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    let report: Value = serde_json::from_slice(&place.read("out.json")).unwrap();
    let exact = (2.0_f64 * 1.5).hypot(1.2);
    for (key, most) in [("distance", 1e-3), ("path_length", 1e-12)] {
        assert!((report[key].as_f64().unwrap() / exact - 1.0).abs() < most, "{key} {} {exact}", report[key]);
    }
}

#[test]
fn faults_on_surfaces_are_named() {
    let place = Place::new();
    let fails = |more: &[&str], said: &str| {
        let words = ["distance", "sphere:1", "--metric", "uniform", "-o", "out.vtu", "--canvas-size", "500"];
        let output = place.run(&[&words[..], more].concat());
        assert_eq!(output.status.code(), Some(1), "{more:?}");
        assert!(stderr(&output).contains(said), "{more:?}: {}", stderr(&output));
        assert!(place.files().is_empty());
    };
    let from = ["--from", "1,0,0"];
    fails(&["--from", "1,0"], "--from (1, 0): a point of the plane, and the domain is a surface");
    fails(&["--from", "1.2,0,0"], "a point off the surface at --from (1.2, 0, 0)");
    fails(&[&from[..], &["--to", "0,0,0"]].concat(), "a point off the surface at --to (0, 0, 0)");
    fails(&[&from[..], &["--geodesic", "lbr"]].concat(), "not supported: distances by lbr on a surface");
    fails(&[&from[..], &["--recovery", "l2"]].concat(), "not supported: --recovery on a surface");
}

#[test]
fn one_point_may_be_given_twice() {
    let place = Place::new();
    let words = ["distance", "sphere:1", "--metric", "uniform", "-o", "out.vtu", "--canvas-size", "500"];
    let points = ["--from", "1,0,0", "--from", "1,0,0", "--to", "1,0,0", "--report", "out.json"];
    let output = place.run(&[&words[..], &points].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    let report: Value = serde_json::from_slice(&place.read("out.json")).unwrap();
    assert_eq!((&report["distance"], &report["path_length"]), (&Value::from(0.0), &Value::from(0.0)));
}
