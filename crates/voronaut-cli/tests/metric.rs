//! `voronaut metric`: sources, limits, figures, faults by their names; and --gradation of the other commands.

use crate::common::{Place, stderr};
use serde_json::Value;
use std::fmt::Write;

/// The unit square as 2 n^2 triangles in a .mesh.
fn square(n: u32) -> String {
    let mut text = format!("MeshVersionFormatted 2\nDimension 2\nVertices {}\n", (n + 1) * (n + 1));
    for k in 0..(n + 1) * (n + 1) {
        let _ = writeln!(text, "{} {} 0", f64::from(k % (n + 1)) / f64::from(n), f64::from(k / (n + 1)) / f64::from(n));
    }
    let _ = writeln!(text, "Triangles {}", 2 * n * n);
    for a in (0..n * n).map(|k| k % n + k / n * (n + 1) + 1) {
        let _ = writeln!(text, "{a} {} {} 0\n{a} {} {} 0", a + 1, a + n + 2, a + n + 2, a + n + 1);
    }
    text + "End\n"
}

/// A function at the vertices of that square.
fn solution(n: u32, f: impl Fn(f64, f64) -> f64) -> String {
    let mut text = format!("MeshVersionFormatted 2\nDimension 2\nSolAtVertices {}\n1 1\n", (n + 1) * (n + 1));
    for k in 0..(n + 1) * (n + 1) {
        let _ = writeln!(text, "{}", f(f64::from(k % (n + 1)) / f64::from(n), f64::from(k / (n + 1)) / f64::from(n)));
    }
    text
}

fn tensors(file: &[u8]) -> Vec<[f64; 3]> {
    let text = String::from_utf8(file.to_vec()).unwrap();
    let rows = text.split("1 3\n").nth(1).unwrap().lines().take_while(|line| line.contains(' '));
    rows.map(|line| {
        let numbers: Vec<f64> = line.split(' ').map(|word| word.parse().unwrap()).collect();
        [numbers[0], numbers[1], numbers[2]]
    })
    .collect()
}

fn with_square() -> Place {
    let place = Place::new();
    place.put("square.mesh", square(12));
    place
}

/// Runs `metric` on the square; what it wrote and reported.
fn made(place: &Place, more: &[&str]) -> (Vec<[f64; 3]>, Value) {
    let words = [&["metric", "square.mesh", "-o", "out.sol", "--report", "out.json"][..], more].concat();
    let output = place.run(&words);
    assert!(output.status.success(), "{more:?}: {}", stderr(&output));
    (tensors(&place.read("out.sol")), serde_json::from_slice(&place.read("out.json")).unwrap())
}

#[test]
fn solutions_and_expressions_give_the_same_metric() {
    let place = with_square();
    place.put("u.sol", solution(12, |x, y| x * x + 3.0 * x * y - 2.0 * y * y));
    let (exact, report) = made(&place, &["--metric", "hessian:x^2 + 3*x*y - 2*y^2", "--complexity", "100"]);
    assert_eq!(exact.len(), 169);
    assert!((report["complexity"].as_f64().unwrap() / 100.0 - 1.0).abs() < 1e-6);
    assert_eq!(report["expected_vertices"], 115);
    for source in [
        &["hessian:u.sol"][..],
        &["hessian:u.sol", "--recovery", "l2"],
        &["hessian:x^2 + 3*x*y - 2*y^2", "--recovery", "fit"],
    ] {
        let (found, _) = made(&place, &[&["--complexity", "100", "--metric"], source].concat());
        let differs = found.iter().flatten().zip(exact.iter().flatten()).any(|(a, b)| (a - b).abs() > 1e-6 * 100.0);
        assert!(!differs, "{source:?}");
    }
    assert_eq!(place.files(), ["out.json", "out.sol", "square.mesh", "u.sol"]);
}

#[test]
fn limits_are_numbers_or_files_and_are_counted() {
    let place = with_square();
    place.put("least.sol", solution(12, |x, _| if x < 0.5 { 0.2 } else { 0.01 }));
    let (found, report) =
        made(&place, &["--metric", "uniform:400,0,1", "--h-min", "least.sol", "--h-max", "0.5", "--a-max", "5"]);
    for (v, m) in found.iter().enumerate() {
        let expected = if v % 13 < 6 { [25.0, 0.0, 4.0] } else { [400.0, 0.0, 16.0] };
        assert!(m.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{v}: {m:?}");
    }
    let touched = &report["touched"];
    assert_eq!((&touched["h_min"], &touched["h_max"]), (&Value::from(78), &Value::from(169)));
    assert_eq!((&touched["a_max"], &touched["gradation"]), (&Value::from(91), &Value::from(0)));
    assert!((report["anisotropy"]["max"].as_f64().unwrap() - 5.0).abs() < 1e-9);
    assert_eq!(report["options"]["h_min"], "least.sol");
}

#[test]
fn metrics_are_combined_graded_and_meet_the_complexity() {
    let place = with_square();
    place.put("sizes.sol", solution(12, |x, _| if x < 0.1 { 0.01 } else { 0.5 }));
    let both = ["--metric", "sizes.sol", "--metric", "implied", "--complexity", "300", "--gradation", "1.3"];
    for how in
        [&["--combine", "intersect"][..], &["--combine", "average", "--weights", "1,2"], &["--combine", "average"]]
    {
        let (found, report) = made(&place, &[&both, how].concat());
        assert!((report["complexity"].as_f64().unwrap() / 300.0 - 1.0).abs() < 1e-6, "{how:?}");
        assert!(found.iter().all(|m| m[0] > 0.0 && m[0] * m[2] > m[1] * m[1]));
        assert!(report["touched"]["gradation"].as_u64().unwrap() > 20, "{how:?}");
    }
    // What is written is read.
    let words = ["mesh", "square.mesh", "--metric", "out.sol", "-o", "out.mesh", "-q"];
    let output = place.run(&words);
    assert!(output.status.success(), "{}", stderr(&output));
}

#[test]
fn faults_are_named() {
    let place = with_square();
    place.put("short.sol", solution(3, |x, _| x));
    place.put("tensors.sol", "MeshVersionFormatted 2\nDimension 2\nSolAtVertices 1\n1 3\n1 0 1\n");
    let fails = |more: &[&str], code: i32, said: &str| {
        let before = place.files();
        let output = place.run(&[&["metric", "square.mesh", "-o", "out.sol"][..], more].concat());
        assert_eq!(output.status.code(), Some(code), "{more:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(said), "{more:?}: {}", stderr(&output));
        assert_eq!(place.files(), before);
    };
    let uniform = ["--metric", "uniform"];
    let and = |more: &[&'static str]| [&uniform[..], more].concat();
    fails(&[], 2, "--metric <METRIC>");
    fails(&["--metric", "hessian:short.sol"], 1, "16 values for 169 vertices");
    fails(&["--metric", "hessian:tensors.sol"], 1, "the values are no scalars");
    fails(&["--metric", "hessian:x^^2"], 1, "x^^2");
    fails(&["--metric", "hessian:sqrt(x)"], 1, "is not finite at vertex 1");
    fails(&["--metric", "short.sol"], 1, "16 sizes for 169 vertices");
    fails(&["--metric", "curvature"], 1, "metric curvature");
    fails(&and(&["--norm", "0.5"]), 2, "p is not at least 1");
    fails(&and(&["--complexity", "0"]), 2, "not a positive number");
    fails(&and(&["--h-min", "coarse"]), 2, "neither a positive number nor a file .sol");
    fails(&and(&["--h-min", "short.sol"]), 1, "h_min has 16 values for 169 vertices");
    fails(&and(&["--h-min", "2", "--h-max", "1"]), 1, "h_min = 2 is larger than h_max = 1");
    fails(&and(&["--h-min", "0.1", "--complexity", "500"]), 1, "within the limits it is at most 1.000000e2");
    fails(&and(&["--gradation", "0.5"]), 1, "gradation_factor = 0.5 is not at least 1");
    fails(&and(&["--weights", "1"]), 1, "an intersection has no weights");
    fails(&and(&["--combine", "average", "--weights", "1,2"]), 1, "2 weights for 1 metrics");
    fails(&and(&["--recovery", "clement"]), 2, "no such recovery");
    fails(&and(&["--report", "out.sol"]), 1, "two outputs have the same name");
    fails(&and(&["-o", "out.vtu"]), 2, "cannot be used multiple times");
    let output = place.run(&["metric", "square.mesh", "--metric", "uniform", "-o", "out.vtu"]);
    assert!(stderr(&output).contains("does not end like a solution file"), "{}", stderr(&output));
}

/// On the mesh of a sphere: tensors of space, which are read, and the complexity that was asked for.
#[test]
fn surfaces_have_metrics_at_vertices() {
    let place = Place::new();
    let mesh = ["mesh", "sphere:1", "--metric", "uniform", "-n", "400", "-o", "s.mesh", "-q"];
    assert!(place.run(&mesh).status.success());
    let count = 400;
    let mut values = format!("MeshVersionFormatted 2\nDimension 3\nSolAtVertices {count}\n1 1\n");
    let mesh = String::from_utf8(place.read("s.mesh")).unwrap();
    let rows = mesh.split("Vertices").nth(1).unwrap().lines().filter(|line| line.split(' ').count() >= 3);
    for row in rows.take(count) {
        let x: f64 = row.split(' ').next().unwrap().parse().unwrap();
        let _ = writeln!(values, "{x}");
    }
    place.put("x.sol", values);
    let words = |more: &[&str]| {
        let words =
            [&["metric", "s.mesh", "-o", "m.sol", "--report", "m.json", "--complexity", "900"][..], more].concat();
        let output = place.run(&words);
        assert!(output.status.success(), "{more:?}: {}", stderr(&output));
        serde_json::from_slice::<Value>(&place.read("m.json")).unwrap()
    };
    let sizes = |report: &Value| ["min", "max"].map(|key| report["size"][key].as_f64().unwrap());
    let exact = words(&["--metric", "hessian:x", "--norm", "inf", "--h-max", "0.2"]);
    for source in [&["hessian:x.sol"][..], &["hessian:x", "--recovery", "fit"]] {
        let found = words(&[&["--norm", "inf", "--h-max", "0.2", "--metric"], source].concat());
        assert!((found["complexity"].as_f64().unwrap() / 900.0 - 1.0).abs() < 1e-6);
        assert!(
            sizes(&found).iter().zip(sizes(&exact)).all(|(a, b)| (a / b - 1.0).abs() < 0.05),
            "{found:#} {exact:#}"
        );
    }
    let all = ["--metric", "curvature", "--metric", "implied", "--metric", "hessian:x.sol", "--gradation", "1.5"];
    let made = words(&all);
    assert_eq!(made["expected_vertices"], 1039);
    let output = place.run(&["mesh", "s.mesh", "--metric", "m.sol", "-o", "out.mesh", "-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
    for (more, says) in [
        (&["--metric", "uniform", "--recovery", "l2"][..], "--recovery l2 on a surface"),
        (&["--metric", "swirl"], "metric swirl on a surface"),
        (&["--metric", "x.sol"], "the size h = "),
    ] {
        let output = place.run(&[&["metric", "s.mesh", "-o", "n.sol"][..], more].concat());
        assert!(output.status.code() == Some(1) && stderr(&output).contains(says), "{more:?}: {}", stderr(&output));
    }
}

#[test]
fn other_commands_grade_their_metrics() {
    let place = Place::new();
    let jump = "formula:if(x < 0.5, 400, 4); 0; if(x < 0.5, 400, 4)";
    let words = ["mesh", "rect:0,0,1,1", "--metric", jump, "-n", "400", "-o", "out.mesh", "--report", "out.json", "-q"];
    let output = place.run(&[&words[..], &["--gradation", "1.2"]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    let report: Value = serde_json::from_slice(&place.read("out.json")).unwrap();
    assert_eq!(report["options"]["gradation"], 1.2);
    let unit = |report: &Value| report["metric_edge_length"]["unit_fraction"].as_f64().unwrap();
    assert!(unit(&report) > 0.9, "{}", unit(&report));
    // In the graded metric the mesh is checked to be what it was made for.
    let scale = report["metric_scale"].to_string();
    let words = ["check", "out.mesh", "--metric", jump, "--metric-scale", &scale, "--report", "check.json", "-q"];
    let output = place.run(&[&words[..], &["--gradation", "1.2", "--domain", "rect:0,0,1,1"]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    let checked: Value = serde_json::from_slice(&place.read("check.json")).unwrap();
    assert!((unit(&checked) - unit(&report)).abs() < 0.03, "{} {}", unit(&checked), unit(&report));
}
