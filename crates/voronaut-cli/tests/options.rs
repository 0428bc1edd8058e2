//! Every option of `voronaut mesh` with everything that can be meshed: each changes what it should, or is refused by name.

use crate::common::{Place, stderr};
use serde_json::Value;
use std::collections::BTreeMap;
use std::process::Output;

/// What an option comes to.
#[derive(Clone, Copy, Debug)]
enum Says {
    /// Another mesh.
    Mesh,
    /// The same mesh, and another entry of the report.
    Report(&'static str),
    /// The same mesh, and another file, or one more.
    File(&'static str),
    /// A mesh where there is none without it.
    Allows,
    /// There is nothing that it could change.
    Nothing,
    /// Exit code 1, and a message with these words.
    Refused(&'static str),
}

use Says::{Allows, File, Mesh, Nothing, Refused, Report};

/// Of an option: what it is given with and how, and what it says to a planar domain, a closed surface, and one with features. A first
/// word without a dash is meshed instead of these.
struct Row {
    with: &'static [&'static str],
    words: &'static [&'static str],
    says: [Option<Says>; 3],
}

/// A row for all three.
const fn all(with: &'static [&'static str], words: &'static [&'static str], says: Says) -> Row {
    Row { with, words, says: [Some(says); 3] }
}

/// A row for the plane only.
const fn plane(with: &'static [&'static str], words: &'static [&'static str], says: Says) -> Row {
    Row { with, words, says: [Some(says), None, None] }
}

/// A row for surfaces only.
const fn surfaces(with: &'static [&'static str], words: &'static [&'static str], says: Says) -> Row {
    Row { with, words, says: [None, Some(says), Some(says)] }
}

/// What an option says to each.
const fn each(words: &'static [&'static str], says: [Says; 3]) -> Row {
    Row { with: &[], words, says: [Some(says[0]), Some(says[1]), Some(says[2])] }
}

const LAYER: &[&str] = &["--metric", "formula:9/(0.1 + x*x); 0; 20"];
const HESSIAN: &[&str] = &["--metric", "hessian:x^4 + 0.3*y^2 + x*y*y", "-n", "60"];
const HESSIAN_IN_SPACE: &[&str] = &["--metric", "hessian:x^4 + 0.3*y^2 + x*y*z", "-n", "60"];
const JUMP: &[&str] = &["--metric", "formula:if(x<0.1,99,1); 0; 9; 0; 0; 9", "-n", "90"];
const RECOVERED: &[&str] = &["--metric", "hessian:u.sol", "-n", "60"];
const OF_FILE: &[&str] = &["--metric", "tensors.sol"];
const PROTECTED: &[&str] = &["--seeding", "protected"];
// Where facets are as large as triangles, geodesics take long.
const ROUND: &[&str] = &["sphere:1", "-n", "60"];
const ROUND_PROTECTED: &[&str] = &["sphere:1", "-n", "60", "--seeding", "protected"];
const PICKED: &[&str] = &["--metric", "formula:9/(0.1 + x*x); 0; 20", "--seeding", "protected", "--lloyd", "0"];
const BY_CANVAS: &[&str] = &["--dual", "canvas", "--canvas-size", "3"];
const BY_LENGTHS: &[&str] = &["--dual", "geodesic"];
const STARS: &[&str] = &["--mesher", "starset"];
const DRAWN: &[&str] = &["--picture", "p.svg"];

const ROWS: &[Row] = &[
    all(&[], &["--vertices", "80"], Mesh),
    all(&[], &["--complexity", "70"], Mesh),
    each(&["--hausd", "0.02"], [Nothing, Mesh, Report("fidelity")]),
    plane(&["disk:0,0,1"], &["--hausd", "0.001"], Mesh),
    all(&[], &["--h-min", "0.6"], Mesh),
    all(&[], &["--h-max", "0.15"], Mesh),
    plane(LAYER, &["--a-max", "1.1"], Mesh),
    surfaces(&["--metric", "formula:99; 0; 9; 0; 0; 9"], &["--a-max", "1.1"], Mesh),
    plane(LAYER, &["--gradation", "1.1"], Mesh),
    surfaces(JUMP, &["--gradation", "1.1"], Mesh),
    plane(LAYER, &["--smooth-metric", "9"], Mesh),
    surfaces(JUMP, &["--smooth-metric", "9"], Mesh),
    plane(HESSIAN, &["--norm", "1"], Mesh),
    surfaces(HESSIAN_IN_SPACE, &["--norm", "1"], Mesh),
    all(&[], &["--norm", "1"], Refused("--norm")),
    plane(RECOVERED, &["--recovery", "l2"], Mesh),
    plane(HESSIAN, &["--recovery", "l2"], Refused("--recovery")),
    surfaces(HESSIAN_IN_SPACE, &["--recovery", "l2"], Refused("--recovery")),
    // Polishing would take the closed one away from its surface, and a note says so.
    Row { with: HESSIAN_IN_SPACE, words: &["--polish", "0"], says: [None, Some(Report("notes")), Some(Mesh)] },
    surfaces(&["--metric", "hessian:x^4 + 0.3*y^2 + x*y*z", "--h-min", "0.1"], &["--polish", "5"], Refused("--polish")),
    all(&[], &["--recovery", "l2"], Refused("--recovery")),
    plane(OF_FILE, &["--tensor-order", "diagonal"], Mesh),
    surfaces(OF_FILE, &["--tensor-order", "diagonal"], Mesh),
    all(&[], &["--tensor-order", "diagonal"], Refused("--tensor-order")),
    plane(&["rect:0,0,1,1", "--metric", "tensors.sol"], &["--background", "plane.mesh"], Allows),
    plane(&[], &["--background", "plane.mesh"], Refused("background")),
    surfaces(&[], &["--background", "plane.mesh"], Refused("--background")),
    each(&["--fit"], [Refused("--fit"), Mesh, Report("fidelity")]),
    each(&["--ar", "95"], [Refused("--ar"), Nothing, Mesh]),
    each(&["--nr"], [Refused("--nr"), Nothing, Mesh]),
    each(&["--repair"], [Nothing, Nothing, Nothing]),
    each(&["--mesher", "starset"], [Mesh, Refused("--mesher"), Refused("--mesher")]),
    each(&["--order", "2"], [Mesh, Refused("a surface of triangles"), Refused("a surface of triangles")]),
    surfaces(&["sphere:1"], &["--order", "2"], Mesh),
    plane(&["disk:0,0,1", "--order", "2"], &["--boundary", "polyline"], Mesh),
    surfaces(&["sphere:1", "--order", "2"], &["--boundary", "spline"], Refused("--boundary")),
    all(&[], &["--boundary", "spline"], Refused("--boundary")),
    plane(STARS, &["--order", "3"], Refused("--order")),
    each(&["--periodic", "4,2"], [Mesh, Refused("--periodic"), Refused("--periodic")]),
    plane(STARS, &["--periodic", "4,2"], Refused("--periodic")),
    each(&["--required"], [Mesh, Refused("--required"), Refused("--required")]),
    all(&[], &["--effort", "best"], Mesh),
    plane(&[], &["--effort", "fast"], Mesh),
    all(&[], &["--lloyd", "0"], Mesh),
    plane(STARS, &["--lloyd", "0"], Mesh),
    all(&[], &["--centroid", "canvas", "--canvas-size", "3"], Mesh),
    plane(STARS, &["--centroid", "canvas", "--lloyd", "9"], Refused("--centroid")),
    plane(HESSIAN, &["--polish", "0"], Mesh),
    plane(&["--metric", "hessian:x^4 + 0.3*y^2", "--h-min", "0.1"], &["--polish", "5"], Refused("--polish")),
    all(&[], &["--polish", "5"], Refused("--polish")),
    all(&[], &["--dual", "canvas", "--canvas-size", "3"], Report("canvas")),
    plane(STARS, &["--dual", "canvas"], Refused("--dual")),
    all(BY_CANVAS, &["--geodesic", "dijkstra"], Report("diagram")),
    all(BY_LENGTHS, &["--geodesic", "dijkstra"], Refused("--geodesic")),
    surfaces(&[], &["--geodesic", "dijkstra"], Refused("--geodesic")),
    all(&["-n", "200"], &["--seeding", "farthest", "--canvas-size", "3"], Mesh),
    Row { with: &[], words: PROTECTED, says: [Some(Mesh), None, Some(Report("protection"))] },
    Row { with: ROUND, words: PROTECTED, says: [None, Some(Report("protection")), None] },
    plane(STARS, &["--seeding", "farthest"], Refused("--seeding")),
    Row {
        with: PROTECTED,
        words: &["--protection", "0.05"],
        says: [Some(Report("protection")), None, Some(Report("protection"))],
    },
    Row { with: ROUND_PROTECTED, words: &["--protection", "0.05"], says: [None, Some(Report("protection")), None] },
    all(&[], &["--protection", "0.05"], Refused("--protection")),
    plane(PICKED, &["--picking-radius", "0.1"], Mesh),
    all(PROTECTED, &["--picking-radius", "0.1"], Refused("--picking-radius")),
    surfaces(&["--seeding", "protected", "--lloyd", "0"], &["--picking-radius", "0.1"], Refused("--picking-radius")),
    all(&[], &["--picking-radius", "0.1"], Refused("--picking-radius")),
    all(&[], &["--net"], Report("net")),
    plane(&["-n", "2500"], &["--parts", "2"], Mesh),
    surfaces(&["-n", "2500"], &["--parts", "2"], Mesh),
    all(BY_CANVAS, &["--canvas", "starset"], Report("canvas")),
    all(BY_LENGTHS, &["--canvas", "starset"], Refused("--canvas")),
    plane(&["--dual", "geodesic", "--picture", "p.svg", "--show", "cells"], &["--canvas", "isotropic"], File("p.svg")),
    surfaces(&["--picture", "p.svg", "--show", "cells"], &["--canvas-size", "90"], File("p.svg")),
    all(&["--dual", "canvas"], &["--canvas-size", "900"], Report("canvas")),
    all(BY_LENGTHS, &["--canvas-size", "90"], Refused("--canvas-size")),
    all(&[], &["--memory-limit", "1e-6"], Refused("--memory-limit")),
    all(&[], &["--time-limit", "1e-6"], Refused("--time-limit")),
    all(&[], &["--picture", "p.svg"], File("p.svg")),
    all(DRAWN, &["--show", "cells"], File("p.svg")),
    all(&[], &["--view", "v.html"], File("v.html")),
    all(&["--view", "v.html"], &["--cells"], File("v.html")),
    all(DRAWN, &["--pixels", "99"], File("p.svg")),
    plane(DRAWN, &["--window", "0,0,0.5,0.5"], File("p.svg")),
    surfaces(DRAWN, &["--window", "0,0,0.5,0.5"], Refused("--window")),
    each(&["--histograms", "h.svg"], [File("h.svg"), File("h.svg"), File("h.svg")]),
    all(&[], &["--threads", "1"], Nothing),
    all(&[], &["--quiet"], Nothing),
    all(&[], &["--verbose"], Nothing),
];

/// Options with which the others are tested, and one that leaves a folder.
const USED: [&str; 6] = ["--metric", "--out", "--report", "--help", "--version", "--parts-dir"];

/// What is meshed in each column, with its metric.
const MESHED: [[&str; 3]; 3] = [
    ["plane.mesh", "--metric", "uniform:20,0,20"],
    ["sphere.obj", "--metric", "formula:5; 0; 5; 0; 0; 5"],
    ["cube.obj", "--metric", "formula:9; 0; 9; 0; 0; 9"],
];

/// What a run left.
struct Left {
    output: Output,
    files: BTreeMap<String, Vec<u8>>,
}

impl Left {
    fn report(&self, key: &str) -> Value {
        let report: Value = serde_json::from_slice(&self.files["r.json"]).expect("JSON");
        report[key].clone()
    }

    fn is_done(&self) -> bool {
        self.output.status.code() == Some(0)
    }
}

/// A place with the files of a column, and its inputs.
fn place(column: usize) -> Place {
    let place = Place::new();
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nf 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    place.put("cube.obj", cube);
    for words in [
        ["mesh", "rect:0,0,1,1", "--metric", "uniform", "-n", "40", "-o", "plane.mesh", "-q"],
        ["mesh", "sphere:1", "--metric", "uniform", "-n", "80", "-o", "sphere.obj", "-q"],
    ] {
        assert!(place.run(&words).status.success());
    }
    let solution = |dimension, kind: u32, count: usize, value: &dyn Fn(usize) -> String| {
        let values: Vec<String> = (0..count).map(value).collect();
        let head = format!("MeshVersionFormatted 2\nDimension {dimension}\nSolAtVertices\n{count}\n1 {kind}\n");
        format!("{head}{}\nEnd\n", values.join("\n"))
    };
    let vertices = [40, 80, 8][column];
    // Metrics in either order.
    let tensors = match column {
        0 => solution(2, 3, vertices, &|_| "20 9 8".into()),
        _ => solution(3, 3, vertices, &|_| "30 9 20 1 1 12".into()),
    };
    place.put("tensors.sol", tensors);
    if column == 0 {
        let mesh = String::from_utf8(place.read("plane.mesh")).expect("text");
        let lines = mesh.lines().skip_while(|line| line.trim() != "Vertices").skip(2).take(vertices);
        let numbers = |line: &str| line.split_whitespace().map(|word| word.parse().expect("a number")).collect();
        let points: Vec<Vec<f64>> = lines.map(numbers).collect();
        place.put(
            "u.sol",
            solution(2, 1, vertices, &|i| (points[i][0].powi(4) + 0.3 * points[i][1].powi(3)).to_string()),
        );
    }
    place
}

fn run(place: &Place, column: usize, words: &[&str]) -> Left {
    let [domain, metric, value] = MESHED[column];
    let (domain, words) = match words.split_first() {
        Some((first, rest)) if !first.starts_with('-') => (*first, rest),
        _ => (domain, words),
    };
    let own = if words.contains(&"--metric") { &[][..] } else { &[metric, value] };
    let kept = place.files();
    let output = place.run(&[&["mesh", domain], own, words, &["-o", "out.mesh", "--report", "r.json"]].concat());
    let new: Vec<String> = place.files().into_iter().filter(|name| !kept.contains(name)).collect();
    let files = new.into_iter().map(|name| (name.clone(), place.take(&name))).collect();
    Left { output, files }
}

fn walk(column: usize) {
    let place = place(column);
    let mut before: BTreeMap<&[&str], Left> = BTreeMap::new();
    let mut wrong = Vec::new();
    for row in ROWS {
        let Some(says) = row.says[column] else { continue };
        if !matches!(says, Refused(_)) {
            before.entry(row.with).or_insert_with(|| run(&place, column, row.with));
        }
        let is = run(&place, column, &[row.with, row.words].concat());
        if !holds(says, before.get(row.with), &is) {
            wrong.push(format!("{:?} with {:?} {says:?}: {}", row.words, row.with, stderr(&is.output)));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Whether a run says of an option what is expected, beside one without it.
fn holds(says: Says, was: Option<&Left>, is: &Left) -> bool {
    if let Refused(name) = says {
        return is.output.status.code() == Some(1) && is.files.is_empty() && stderr(&is.output).contains(name);
    }
    let Some(was) = was else { return false };
    let is_other = |name: &str| is.files.get(name) != was.files.get(name);
    is.is_done()
        && was.is_done() != matches!(says, Allows)
        && match says {
            Mesh | Allows => is_other("out.mesh"),
            Report(key) => is.report(key) != was.report(key),
            File(name) => is_other(name) && is.files.contains_key(name) && !is_other("out.mesh"),
            Nothing => !is_other("out.mesh"),
            Refused(_) => false,
        }
}

#[test]
fn in_the_plane() {
    walk(0);
}

#[test]
fn on_a_closed_surface() {
    walk(1);
}

#[test]
fn on_a_surface_with_features() {
    walk(2);
}

#[test]
fn every_option_is_walked() {
    let help = Place::new().run(&["mesh", "--help"]);
    let help = String::from_utf8(help.stdout).expect("UTF-8");
    let walked = |option: &str| ROWS.iter().any(|row| row.words[0] == option) || USED.contains(&option);
    let options = help.lines().map(str::trim).filter(|line| line.starts_with('-'));
    let long = options.filter_map(|line| line.split_whitespace().find(|word| word.starts_with("--")));
    let missing: Vec<&str> = long.filter(|option| !walked(option)).collect();
    assert!(missing.is_empty(), "{missing:?}");
}
