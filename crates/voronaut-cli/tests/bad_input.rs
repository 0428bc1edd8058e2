//! Every kind of bad input: the exit code, what is wrong and where, what to do about it, and no file left behind.

use crate::common::{Place, stderr};

const SQUARE: &str = "MeshVersionFormatted 2\nDimension 2\nVertices 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n\
                      Triangles 2\n1 2 3 1\n1 3 4 1\nEnd\n";
/// The last words of a command that names its domain and metric before.
const REST: [&str; 4] = ["-n", "100", "-o", "out.mesh"];

/// Runs a command that must fail with this exit code and say all of `expected` on stderr.
fn refused_with(code: i32, place: &Place, words: &[&str], expected: &[&str]) {
    let before = place.files();
    let output = place.run(words);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(code), "{words:?}: {said}");
    assert!(said.starts_with("error: "), "{words:?}: {said}");
    assert!(expected.iter().all(|part| said.contains(part)), "{words:?}: {expected:?} in {said}");
    let help = if code == 2 { "--help" } else { "\n  help: " };
    assert!(said.contains(help), "{words:?}: no help in {said}");
    assert!(!said.contains("panicked") && !said.contains("RUST_BACKTRACE"), "{words:?}: {said}");
    assert!(said.len() < 2000, "{words:?}: {} bytes", said.len());
    assert_eq!(place.files(), before, "{words:?} left files");
}

fn refused(place: &Place, words: &[&str], expected: &[&str]) {
    refused_with(1, place, words, expected);
}

/// A domain that `mesh` must refuse.
fn domain_refused(name: &str, bytes: impl AsRef<[u8]>, expected: &[&str]) {
    let place = Place::new();
    place.put(name, bytes);
    refused(&place, &[&["mesh", name, "--metric", "uniform"][..], &REST].concat(), expected);
}

/// A shape or a metric that `mesh` must refuse.
fn words_refused(domain: &str, metric: &str, expected: &[&str]) {
    refused(&Place::new(), &[&["mesh", domain, "--metric", metric][..], &REST].concat(), expected);
}

/// A solution on the unit square that `mesh` must refuse.
fn solution_refused(values: impl AsRef<[u8]>, expected: &[&str]) {
    let place = Place::new();
    place.put("square.mesh", SQUARE);
    place.put("metric.sol", values);
    refused(&place, &[&["mesh", "square.mesh", "--metric", "metric.sol"][..], &REST].concat(), expected);
}

/// A `.poly` file of these vertices (`x y`) and segments (`from to`).
fn poly(vertices: &[&str], segments: &[&str]) -> String {
    let rows = |rows: &[&str]| (1..).zip(rows).fold(String::new(), |text, (i, row)| text + &format!("{i} {row}\n"));
    format!("{} 2 0 0\n{}{} 0\n{}0\n", vertices.len(), rows(vertices), segments.len(), rows(segments))
}

fn solution(dimension: u32, kind: u32, values: &[&str]) -> String {
    let rows = values.join("\n");
    format!("MeshVersionFormatted 2\nDimension {dimension}\nSolAtVertices {}\n1 {kind}\n{rows}\nEnd\n", values.len())
}

fn polygon(ring: &str) -> String {
    format!(r#"{{"type":"Polygon","coordinates":[{ring}]}}"#)
}

const RING: [&str; 4] = ["1 2", "2 3", "3 4", "4 1"];

#[test]
fn empty_missing_and_binary_files_are_named() {
    let binary: Vec<u8> = (0..4096_u32).map(|i| (i * 197 + i / 7) as u8 | 0x80).collect();
    for name in ["a.mesh", "a.poly", "a.geojson"] {
        domain_refused(name, "", &[name, "the file is empty", "had finished"]);
        domain_refused(name, " \n\t\n", &[name]);
        domain_refused(name, &binary, &[name, "not a text in UTF-8 (byte 1"]);
        words_refused(&format!("no/{name}"), "uniform", &[name, "No such file"]);
    }
    domain_refused("a.mesh", b"\0\0\0\x01\x02", &["a.mesh, byte 4: the file ends in the head of the file"]);
    solution_refused("", &["metric.sol: the file is empty"]);
    solution_refused(&binary, &["metric.sol:1: not a text in UTF-8 (byte 1 of the line)"]);
    let place = Place::new();
    place.put("a.mesh", &binary);
    refused(&place, &["check", "a.mesh"], &["a.mesh:1: not a text"]);
    refused(&place, &["check", "b.mesh"], &["b.mesh", "No such file"]);
    refused(&place, &["mesh", "rect:0,0,1,1", "--metric", "b.sol", "-o", "out.mesh"], &["b.sol", "No such file"]);
}

#[test]
fn cut_off_files_and_wrong_numbers_are_named_by_their_line() {
    domain_refused("a.poly", "4 2 0 0\n1 0 0\n2 1 0\n", &["a.poly:3", "row 3 of 4 of vertices", "cut off"]);
    domain_refused("a.poly", "4000000000 2 0 0\n1 0 0\n", &["a.poly:2", "row 2 of 4000000000"]);
    domain_refused("a.poly", "99999999999999999999 2\n", &["a.poly:1", "out of range"]);
    let numbered = poly(&["0 0", "1 0", "1 1", "0 1"], &["1 2", "2 3", "3 4", "4 9"]);
    domain_refused("a.poly", numbered, &["a.poly:10", "vertex 9 does not exist"]);
    domain_refused("a.mesh", &SQUARE[..60], &["a.mesh:", "cut off"]);
    domain_refused("a.mesh", SQUARE.replace("1 3 4 1", "1 3 7 1"), &["a.mesh:10", "vertex 7 does not exist"]);
    domain_refused("a.mesh", SQUARE.replace("Vertices 4", "Vertices 4000000000"), &["a.mesh:", "4000000000"]);
    domain_refused("a.geojson", r#"{"type":"Polygon","coordinates":["#, &["a.geojson:1", "EOF"]);
    domain_refused("a.geojson", "[".repeat(100_000), &["a.geojson:1"]);
}

#[test]
fn coordinates_that_are_no_numbers_are_refused() {
    domain_refused("a.poly", poly(&["0 0", "nan 0", "1 1", "0 1"], &RING), &["a.poly:3", "'nan' is not a finite"]);
    domain_refused("a.mesh", SQUARE.replace("1 1 0", "inf 1 0"), &["a.mesh:6", "'inf' is not a finite"]);
    domain_refused("a.geojson", polygon("[[0,0],[1,0],[1e999,1],[0,0]]"), &["a.geojson:1", "out of range"]);
    words_refused("rect:0,0,nan,1", "uniform", &["not finite", "(0, 0), (NaN, 1)"]);
    words_refused("disk:0,inf,1", "uniform", &["finite centre"]);
}

#[test]
fn self_crossing_boundaries_are_shown_where_they_cross() {
    let bow = poly(&["0 0", "1 1", "1 0", "0 1"], &RING);
    domain_refused("bow.poly", bow, &["crosses or overlaps itself at (0.5, 0.5)", "vertex 1 (0, 0) - vertex 2 (1, 1)"]);
    domain_refused("bow.geojson", polygon("[[0,0],[1,1],[1,0],[0,1],[0,0]]"), &["(0.5, 0.5)", "ring 1, position 3"]);
    let overlap = poly(&["0 0", "3 0", "3 1", "1 0", "2 0", "2 -1"], &["1 2", "2 3", "3 1", "4 5", "5 6", "6 4"]);
    domain_refused("overlap.poly", overlap, &["crosses or overlaps itself"]);
}

#[test]
fn open_boundaries_are_shown_where_they_end() {
    let open = poly(&["0 0", "1 0", "1 1", "0 1"], &RING[..3]);
    domain_refused("open.poly", open, &["the boundary is open", "vertex 1 (0, 0)", "close the boundary"]);
    domain_refused("open.geojson", polygon("[[0,0],[1,0],[1,1],[0,1]]"), &["not closed", "ring 1, position 4 (0, 1)"]);
    let open = SQUARE.replace("Triangles 2\n1 2 3 1\n1 3 4 1", "Edges 3\n1 2 1\n2 3 1\n3 4 1");
    domain_refused("open.mesh", open, &["the boundary is open", "(0, 0)"]);
    let points = SQUARE.replace("Triangles 2\n1 2 3 1\n1 3 4 1\n", "");
    domain_refused("points.mesh", points, &["neither edges nor triangles", "points.mesh"]);
    let line = poly(&["0 0", "1 0", "2 0"], &["1 2", "2 3", "1 3"]);
    domain_refused("line.poly", line, &["encloses no area"]);
}

#[test]
fn duplicate_points_are_named() {
    let twice = poly(&["0 0", "1 0", "1 1", "0 1", "1 1"], &RING);
    domain_refused("a.poly", twice, &["vertex 3 and vertex 5 have the same coordinates", "a.poly, (1, 1)"]);
    let flat = polygon("[[0,0],[1,0],[1,0],[0,0]]");
    domain_refused("a.geojson", flat, &["a ring without area", "position 1 (0, 0)"]);
    let twice = SQUARE.replace("Vertices 4\n", "Vertices 5\n").replace("0 1 0\n", "0 1 0\n0 1 0\n");
    let edges = "Edges 4\n1 2 1\n2 3 1\n3 4 1\n5 1 1";
    let twice = twice.replace("Triangles 2\n1 2 3 1\n1 3 4 1", edges);
    domain_refused("a.mesh", twice, &["the same coordinates", "(0, 1)"]);
}

#[test]
fn wrong_dimensions_are_refused() {
    domain_refused("a.poly", "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n", &["a.poly:1", "dimension 3, not 2"]);
    let raised = "MeshVersionFormatted 2\nDimension 3\nVertices 4\n0 0 0 0\n1 0 0 0\n1 1 0 0\n0 1 1 0\n\
                  Edges 4\n1 2 1\n2 3 1\n3 4 1\n4 1 1\nEnd\n";
    domain_refused("a.mesh", raised, &["vertex 4 has z = 1", "a.mesh", "planar"]);
    domain_refused("a.geojson", r#"{"type":"Point","coordinates":[0,0]}"#, &["a Point where a Polygon", "feature 1"]);
    solution_refused(solution(3, 3, &["1 0 1 0 0 1"; 4]), &["metric.sol", "no planar metric"]);
    solution_refused(solution(2, 2, &["1 1"; 4]), &["metric.sol", "no planar metric"]);
    words_refused("rect:0,0,1,1", "formula:1;0;1;0;0;1", &["six entries", "not supported"]);
    words_refused("sphere:1", "swirl", &["metric swirl on a surface", "not supported"]);
}

#[test]
fn tensors_that_are_no_metric_are_shown_where_they_are() {
    let square = "rect:-1,-1,1,1";
    words_refused(square, "formula:0/0;0;1", &["m11 = NaN", "not finite at ("]);
    words_refused(square, "formula:x;0;1", &["not positive definite at (-"]);
    words_refused(square, "formula:1;2;1", &["m12 = 2", "not positive definite at ("]);
    words_refused(square, "formula:if(abs(x-0.1)<1e-3,-1,1);0;1", &["m11 = -1", "at (0."]);
    words_refused(square, "uniform:1,2,1", &["m12 = 2", "not positive definite"]);
    words_refused(square, "uniform:nan,0,1", &["m11 = NaN"]);
    solution_refused(solution(2, 3, &["1 0 1", "1 0 1", "1 0 1", "1 2 1"]), &["m12 = 2", "vertex 4 (0, 1)"]);
    solution_refused(solution(2, 3, &["1 0 1", "1 0 1", "1 0 1", "nan 0 1"]), &["metric.sol:8", "'nan'"]);
    solution_refused(solution(2, 1, &["1", "1", "0", "1"]), &["h = 0", "vertex 3 (1, 1)"]);
}

#[test]
fn a_solution_must_fit_its_background() {
    solution_refused(solution(2, 3, &["1 0 1"; 3]), &["3 tensors for 4 vertices", "one value for each vertex"]);
    let place = Place::new();
    place.put("square.mesh", SQUARE);
    place.put("metric.sol", solution(2, 1, &["1"; 4]));
    let far = ["mesh", "rect:10,10,12,12", "--metric", "metric.sol", "-n", "9", "-o", "out.mesh"];
    refused(&place, &far, &["needs a .mesh it belongs to", "--background"]);
    let with = |mesh| [&far[..], &["--background", mesh]].concat();
    refused(&place, &with("square.mesh"), &["reaches beyond the background mesh", "square.mesh ((0, 0) to (1, 1))"]);
    refused(&place, &with("none.mesh"), &["none.mesh", "No such file"]);
}

#[test]
fn metrics_that_nobody_knows_are_answered_with_those_that_are() {
    words_refused("rect:0,0,1,1", "foo", &["`foo` is not a metric", "uniform, uniform:m11,m12,m22, swirl"]);
    words_refused("rect:0,0,1,1", "swirl:mu=3", &["mu"]);
    words_refused("rect:0,0,1,1", "formula:1;0;sni(x)", &["formula m22, column 5", "unknown name `sni`"]);
    words_refused("rect:0,0,1,1", "boundary:growth=2", &["h0 is missing"]);
    let deep = format!("formula:{}1{};0;1", "(".repeat(5000), ")".repeat(5000));
    words_refused("rect:0,0,1,1", &deep, &["column 201", "levels"]);
}

#[test]
fn absurd_sizes_are_refused_before_the_work() {
    let place = Place::new();
    let square = ["mesh", "rect:0,0,1,1", "-o", "out.mesh", "--metric"];
    let with = |words: &[&'static str]| [&square[..], words].concat();
    refused(&place, &with(&["uniform", "-n", "4000000000"]), &["limit exceeded", "MiB", "fewer vertices"]);
    refused(&place, &with(&["uniform", "--complexity", "1e15"]), &["limit exceeded", "MiB"]);
    refused(&place, &with(&["uniform:1e20,0,1e20"]), &["limit exceeded", "MiB", "--memory-limit"]);
    refused(&place, &with(&["uniform", "-n", "100000", "--memory-limit", "0.001"]), &["limit exceeded", "MiB"]);
    words_refused("rect:0,0,1e300,1", "uniform", &["larger than 1e60", "(1e300, 0)"]);
    words_refused("rect:-1e308,0,1e308,1", "uniform", &["not finite", "-1e308"]);
    words_refused("rect:0,0,1e-300,1e-300", "uniform", &["invalid domain"]);
    words_refused("rect:0,0,0,1", "uniform", &["x0 < x1"]);
    words_refused("disk:0,0,-1", "uniform", &["positive radius", "radius -1"]);
    words_refused("disk:1e16,0,1", "uniform", &["too small"]);
}

#[test]
fn outputs_that_cannot_be_written_are_refused_before_the_work() {
    let place = Place::new();
    let square = ["mesh", "rect:0,0,1,1", "--metric", "uniform", "-n", "100", "-o"];
    let with = |words: &[&'static str]| [&square[..], words].concat();
    for name in ["out.xyz", "out", "out.mshx"] {
        refused(&place, &with(&[name]), &[name, "not supported", ".mesh, .meshb, .msh, .su2, .vtu"]);
    }
    refused(&place, &with(&["nowhere/out.mesh"]), &["nowhere: No such file or directory"]);
    refused(&place, &with(&["out.mesh", "--picture", "out.gif"]), &["out.gif", ".svg or .png"]);
    refused(&place, &with(&["out.mesh", "--picture", "nowhere/out.svg"]), &["nowhere"]);
    refused(&place, &with(&["out.mesh", "--report", "nowhere/out.json"]), &["nowhere"]);
    refused(&place, &with(&["out.mesh", "--report", "./out.mesh"]), &["two outputs have the same name"]);
    std::fs::create_dir(place.path().join("folder.mesh")).unwrap();
    refused(&place, &with(&["folder.mesh"]), &["folder.mesh", "directory"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_directory_that_takes_no_files_is_named() {
    let words = ["mesh", "rect:0,0,1,1", "--metric", "uniform", "-n", "10", "-o", "/proc/out.mesh"];
    refused(&Place::new(), &words, &["/proc/out.mesh"]);
}

#[test]
fn unknown_endings_of_domains_are_answered_with_those_that_work() {
    domain_refused("a.stl", "solid\nendsolid\n", &["a.stl", "no triangles"]);
    domain_refused("a.xyz", "solid", &["a.xyz", ".geojson, .json, .poly, .mesh, .meshb, .msh, .su2, .vtu or .vtp"]);
    words_refused("rect:0,0", "uniform", &["2 numbers where 4 are expected", "rect:x0,y0,x1,y1"]);
    let place = Place::new();
    place.put("a.poly", "");
    refused(&place, &["check", "a.poly"], &["a.poly: the name does not end like", ".off"]);
}

#[test]
fn wrong_usage_is_told_apart() {
    let place = Place::new();
    let square = ["mesh", "rect:0,0,1,1", "--metric", "uniform", "-o", "out.mesh"];
    for (more, expected) in [
        (&["-n", "many"][..], "'many'"),
        (&["-n", "2"], "'2'"),
        (&["-n", "9999999999"], "9999999999"),
        (&["-n", "9", "--complexity", "9"], "--complexity"),
        (&["--complexity", "nan"], "not a positive number"),
        (&["--h-min=-1"], "not a positive number"),
        (&["--threads", "0"], "--threads"),
        (&["--frobnicate"], "--frobnicate"),
    ] {
        refused_with(2, &place, &[&square[..], more].concat(), &[expected]);
    }
    refused_with(2, &place, &["mesh", "rect:0,0,1,1", "-n", "9"], &["--metric", "--out"]);
    refused_with(2, &place, &["mash"], &["mash"]);
}

#[test]
fn limits_that_contradict_each_other_are_refused() {
    let place = Place::new();
    let words =
        ["mesh", "rect:0,0,1,1", "--metric", "uniform", "-n", "9", "-o", "out.mesh", "--h-min", "2", "--h-max", "1"];
    refused(&place, &words, &["h_min"]);
}

#[test]
fn an_invalid_mesh_is_reported_and_refused() {
    let place = Place::new();
    place.put("a.mesh", SQUARE.replace("1 3 4 1", "1 4 3 1"));
    let output = place.run(&["check", "a.mesh", "--report", "a.json"]);
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    assert!(said.contains("triangle 2 (vertices 1 4 3) is inverted or flat at (0.33"), "{said}");
    let report: serde_json::Value = serde_json::from_slice(&place.read("a.json")).unwrap();
    assert_eq!((&report["valid"], &report["inverted"]), (&false.into(), &1.into()));
}
