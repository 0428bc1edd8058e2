//! `--periodic` in files: what `.mesh`, `.msh` and `.su2` hold of curves that correspond; and the rules of SU2's own reader.

use crate::common::{Place, stderr};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

/// Thickness of the trailing edge, and of the slit behind it.
const SLIT: f64 = 1.0 / 128.0;

/// A round far field (label 2) around an aerofoil-like shape (1), cut open along a wake that bends: the upper side of the cut has
/// label 3, the lower one 4.
fn aerofoil() -> String {
    let wake = |i: u32| (1.0 + 0.5 * f64::from(i), 0.01 * f64::from(i * i));
    let half = 0.5 * SLIT;
    let (far_x, far_y) = wake(8);
    let (radius, start) = ((far_x - 0.5).hypot(far_y), far_y.atan2(far_x - 0.5));
    let far = |i: u32| start + TAU * f64::from(i) / 32.0;
    let thickness = |x: f64| half * x + 0.25 * x.sqrt() * (1.0 - x);
    let chord = |i: u32| (f64::from(i) / 20.0).powi(2);
    let mut corners = vec![(far_x, far_y + half, 2)];
    corners.extend((1..32).map(|i| (0.5 + radius * far(i).cos(), radius * far(i).sin(), 2)));
    corners.extend((1..=8).rev().map(|i| (wake(i).0, wake(i).1 - half, 4)));
    corners.extend((1..=20).rev().map(|i| (chord(i), -thickness(chord(i)), 1)));
    corners.extend((0..20).map(|i| (chord(i), thickness(chord(i)), 1)));
    corners.extend((0..8).map(|i| (wake(i).0, wake(i).1 + half, 3)));
    poly(&corners)
}

/// The unit square with labels 1 to 4 from its lower side on.
const SQUARE: [(f64, f64, i32); 4] = [(0.0, 0.0, 1), (1.0, 0.0, 2), (1.0, 1.0, 3), (0.0, 1.0, 4)];

/// A polygon as a `.poly` file: its corners with the label of the segment that begins there.
fn poly(corners: &[(f64, f64, i32)]) -> String {
    let n = corners.len();
    let rows = |row: &dyn Fn(usize) -> String| (1..=n).map(row).collect::<Vec<String>>().join("\n");
    let points = rows(&|i| format!("{i} {} {}", corners[i - 1].0, corners[i - 1].1));
    let segments = rows(&|i| format!("{i} {i} {} {}", i % n + 1, corners[i - 1].2));
    format!("{n} 2 0 0\n{points}\n{n} 1\n{segments}\n0\n")
}

/// A text as SU2's reader (`CSU2ASCIIMeshReader` of versions 7 and 8) takes it: keywords at fixed columns, as many lines as are announced, one element
/// or point a line, points numbered from 0 in the order of the file.
struct Su2 {
    points: Vec<[f64; 2]>,
    triangles: Vec<[usize; 3]>,
    markers: Vec<(String, Vec<[usize; 2]>)>,
    rest: Vec<String>,
}

fn su2(text: &str) -> Su2 {
    let mut lines = text.lines();
    let mut line = || lines.next().expect("a line more").to_owned();
    // The keyword is erased with as many characters as SU2 erases; what is behind it is read by C's `atoi`.
    let count = |line: &str, keyword: &str| -> usize {
        assert!(line.starts_with(keyword), "{line} for {keyword}");
        line[keyword.len()..].trim().parse().expect("a count")
    };
    let numbers =
        |line: &str| -> Vec<usize> { line.split_whitespace().map(|word| word.parse().expect("a number")).collect() };
    assert_eq!(count(&line(), "NDIME="), 2);
    let elements = count(&line(), "NELEM=");
    let triangles = (0..elements).map(|_| numbers(&line())).map(|row| {
        assert_eq!(row[0], 5, "a triangle");
        [row[1], row[2], row[3]]
    });
    let triangles = triangles.collect();
    let count_of_points = count(&line(), "NPOIN=");
    let points = (0..count_of_points).map(|_| {
        let line = line();
        let mut words = line.split_whitespace().map(|word| word.parse::<f64>().expect("a number"));
        [words.next().expect("x"), words.next().expect("y")]
    });
    let points = points.collect();
    let markers = count(&line(), "NMARK=");
    let markers = (0..markers).map(|_| {
        let tag = line();
        assert!(tag.starts_with("MARKER_TAG="), "{tag}");
        let elements = count(&line(), "MARKER_ELEMS=");
        let rows = (0..elements).map(|_| numbers(&line())).map(|row| {
            assert!(row[0] == 3 && row.len() == 3, "a line of two points");
            [row[1], row[2]]
        });
        (tag["MARKER_TAG=".len()..].trim().to_owned(), rows.collect())
    });
    Su2 { points, triangles, markers: markers.collect(), rest: lines.map(str::to_owned).collect() }
}

/// What SU2 asks of a mesh of triangles in the plane.
fn demand_rules(text: &str) -> Su2 {
    let mesh = su2(text);
    let n = mesh.points.len();
    assert!(mesh.triangles.as_flattened().iter().all(|&v| v < n), "points are numbered from 0");
    let used: BTreeSet<usize> = mesh.triangles.as_flattened().iter().copied().collect();
    assert_eq!(used.len(), n, "every point is in an element");
    // Half-edges of counter-clockwise triangles: those without the opposite one are the boundary.
    let halves: BTreeSet<[usize; 2]> = mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    assert_eq!(halves.len(), 3 * mesh.triangles.len(), "two elements at an edge at most, of one orientation");
    for &[a, b, c] in &mesh.triangles {
        let [p, q, r] = [a, b, c].map(|v| mesh.points[v]);
        assert!((q[0] - p[0]) * (r[1] - p[1]) > (q[1] - p[1]) * (r[0] - p[0]), "counter-clockwise");
    }
    let boundary: BTreeSet<[usize; 2]> = halves.iter().copied().filter(|&[a, b]| !halves.contains(&[b, a])).collect();
    let marked: Vec<[usize; 2]> = mesh.markers.iter().flat_map(|(_, rows)| rows.iter().copied()).collect();
    assert_eq!(
        marked.iter().copied().collect::<BTreeSet<_>>(),
        boundary,
        "markers have the boundary, the domain on the left"
    );
    assert_eq!(marked.len(), boundary.len(), "each edge is in one marker");
    let tags: BTreeSet<&str> = mesh.markers.iter().map(|(tag, _)| tag.as_str()).collect();
    assert_eq!(tags.len(), mesh.markers.len(), "each marker has a name of its own");
    assert!(tags.iter().all(|tag| !tag.is_empty() && !tag.contains(' ') && *tag != "SEND_RECEIVE"));
    // Behind the markers nothing but comments: a section NPERIODIC is an error since version 7.
    assert!(mesh.rest.iter().all(|line| line.starts_with('%') && !line.contains("NPERIODIC=")), "{:?}", mesh.rest);
    mesh
}

fn meshed(domain: &str, words: &[&str], out: &str) -> (String, Value) {
    let place = Place::new();
    place.put("domain.poly", domain);
    let common = ["mesh", "domain.poly", "--report", "r.json", "-o", out];
    let output = place.run(&[&common[..], words].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    let text = String::from_utf8(place.read(out)).expect("text");
    (text, serde_json::from_slice(&place.read("r.json")).expect("JSON"))
}

const CUT: [&str; 6] = [
    "--metric",
    "formula:1/(0.03+0.15*sqrt((x-0.5)^2+y^2))^2; 0; 1/(0.03+0.15*sqrt((x-0.5)^2+y^2))^2",
    "-n",
    "1500",
    "--periodic",
    "3,4",
];

#[test]
fn files_keep_the_rules_of_su2_s_reader() {
    for (domain, words) in [
        (aerofoil(), &CUT[..4]),
        (poly(&SQUARE), &["--metric", "uniform", "-n", "200"]),
        (poly(&SQUARE), &["--metric", "swirl", "-n", "300", "--periodic", "1,3", "--periodic", "4,2"]),
    ] {
        demand_rules(&meshed(&domain, words, "out.su2").0);
    }
}

#[test]
fn an_o_domain_s_cut_matches_to_the_last_bit() {
    let (text, report) = meshed(&aerofoil(), &CUT, "out.su2");
    let mesh = demand_rules(&text);
    let side = |name: &str| {
        let (_, rows) = mesh.markers.iter().find(|(tag, _)| tag == name).expect("the marker");
        let at: BTreeSet<usize> = rows.as_flattened().iter().copied().collect();
        let places: BTreeMap<u64, f64> = at.iter().map(|&v| (mesh.points[v][0].to_bits(), mesh.points[v][1])).collect();
        assert_eq!(places.len(), rows.len() + 1);
        places
    };
    let (upper, lower) = (side("3"), side("4"));
    assert_eq!(upper.keys().collect::<Vec<_>>(), lower.keys().collect::<Vec<_>>());
    // The thickness is a power of two, and y of the lower side is that of the upper one less it, rounded once.
    assert!(
        upper
            .values()
            .zip(lower.values())
            .all(|(u, l)| (u - SLIT).to_bits() == l.to_bits() || (u - l - SLIT).abs() < 1e-16)
    );
    assert_eq!(mesh.points.len(), 1500);
    let pair = &report["periodic"][0];
    assert_eq!(pair["labels"], serde_json::json!([3, 4]));
    assert_eq!(pair["vertices"], upper.len());
    assert_eq!(mesh.rest, [format!("% MARKER_PERIODIC= ( 3, 4, 0, 0, 0, 0, 0, 0, 0, {}, 0 )", -SLIT)]);
}

#[test]
fn gmsh_has_the_pairs_and_medit_the_places() {
    let words = ["--metric", "uniform", "-n", "150", "--periodic", "1,3,4,2"];
    let (text, report) = meshed(&poly(&SQUARE), &words, "out.msh");
    let section: Vec<&str> = text[text.find("$Periodic").expect("the section")..].lines().collect();
    let (count, first) = (section[1], section[3]);
    assert_eq!((count, first), ("2", "16 1 0 0 0 0 1 0 1 0 0 1 0 0 0 0 1"));
    let pairs: usize = section[4].parse().expect("a count");
    assert_eq!(report["periodic"][0]["vertices"], pairs);
    assert!(section.last().is_some_and(|line| *line == "$EndPeriodic"));
    let (text, _) = meshed(&poly(&SQUARE), &words, "out.mesh");
    let rows = |name: &str| -> Vec<Vec<f64>> {
        let lines = text.lines().map(str::trim).skip_while(|line| *line != name).skip(2);
        let numbers = |line: &str| line.split_whitespace().map(str::parse).collect::<Result<_, _>>().ok();
        lines.map_while(|line| numbers(line).filter(|row: &Vec<f64>| !row.is_empty())).collect()
    };
    let (points, edges) = (rows("Vertices"), rows("Edges"));
    let heights = |label: f64| -> BTreeSet<u64> {
        let ends = edges.iter().filter(|row| row[2].to_bits() == label.to_bits()).flat_map(|row| [row[0], row[1]]);
        ends.map(|v| points[v as usize - 1][1].to_bits()).collect()
    };
    assert!(heights(4.0).len() > 5 && heights(4.0) == heights(2.0));
}

#[test]
fn pairs_that_do_not_fit_are_told() {
    let place = Place::new();
    place.put("domain.poly", poly(&SQUARE));
    for (asked, expected) in
        [("1,7", "no boundary has label 7"), ("1", "not two labels A,B"), ("1,x", "not two labels A,B")]
    {
        let output =
            place.run(&["mesh", "domain.poly", "--metric", "uniform", "-n", "50", "--periodic", asked, "-o", "o.su2"]);
        assert!(!output.status.success() && stderr(&output).contains(expected), "{}", stderr(&output));
        assert_eq!(place.files(), ["domain.poly"]);
    }
}
