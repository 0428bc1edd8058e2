//! `voronaut distance`: every method, files and figures, faults by their names.

mod common;

use common::{Place, stderr};
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
    fails(&[], 2, "--from <X,Y>");
    fails(&["--from", "1"], 2, "write two numbers, X,Y");
    fails(&["--from", "1,2,3"], 2, "write two numbers, X,Y");
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
    let mesh = ["mesh", "rect:0,0,2,1", "--metric", "uniform", "-n", "60", "--dual", "canvas", "-o", "out.mesh", "-q"];
    for method in ["march", "stvd:window=4", "dijkstra", "konukoglu"] {
        for words in [&[&dual[..], &["--canvas-size", "20"]].concat(), &mesh[..]] {
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
