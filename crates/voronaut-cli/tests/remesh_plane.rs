//! `remesh` of planar meshes: mmg2d's options, files and exit codes.

use crate::common::{Place, stderr};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use voronaut::mesh::{Mesh, SolutionValues};
use voronaut_io::{medit, sol, write_mesh};

/// The unit square in cells of a tenth; triangles left of x = 0.5 have label 1, others 2.
fn square() -> Mesh {
    let points = (0..121).map(|k| [f64::from(k % 11) / 10.0, f64::from(k / 11) / 10.0, 0.0]).collect();
    let cells = (0..100_u32).map(|k| (k % 10, k % 10 + k / 10 * 11));
    let halves = cells.flat_map(|(i, a)| {
        let label = if i < 5 { 1 } else { 2 };
        [([a, a + 1, a + 12], label), ([a, a + 12, a + 11], label)]
    });
    let (triangles, triangle_labels) = halves.unzip();
    Mesh { points, triangles, triangle_labels, ..Mesh::default() }
}

/// A directory with the square in `in.mesh`.
fn place() -> Place {
    let place = Place::new();
    write_mesh(&square(), &place.path().join("in.mesh")).unwrap();
    place
}

fn mesh(place: &Place, name: &str) -> Mesh {
    medit::read(place.read(name).as_slice(), name).unwrap().mesh
}

fn sizes(place: &Place, name: &str) -> Vec<f64> {
    match sol::read(place.read(name).as_slice(), name).unwrap().values {
        SolutionValues::Scalar(sizes) => sizes,
        _ => panic!("{name} holds no sizes"),
    }
}

fn done(place: &Place, words: &str) -> String {
    let output = place.run(&words.split_whitespace().collect::<Vec<_>>());
    assert_eq!(output.status.code(), Some(0), "{words}: {}", stderr(&output));
    stderr(&output)
}

/// Values at the vertices of the square, from their places.
fn put_values(place: &Place, name: &str, value: impl Fn(f64, f64) -> Vec<f64>) {
    let rows: Vec<Vec<f64>> = square().points.iter().map(|p| value(p[0], p[1])).collect();
    let mut text = format!("MeshVersionFormatted 2 Dimension 2 SolAtVertices {} 1 {}\n", rows.len(), rows[0].len());
    for row in rows {
        let words: Vec<String> = row.iter().map(f64::to_string).collect();
        text += &(words.join(" ") + "\n");
    }
    place.put(name, text);
}

/// Least and greatest length of edges.
fn range(mesh: &Mesh) -> [f64; 2] {
    let edges = mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let lengths = edges.map(|[a, b]| mesh.point(a).distance(mesh.point(b)));
    lengths.fold([f64::INFINITY, 0.0], |[least, most], l| [least.min(l), most.max(l)])
}

fn bits(mesh: &Mesh, v: u32) -> [u64; 3] {
    mesh.points[v as usize].map(f64::to_bits)
}

/// Edges of a list, with their labels, to the last bit.
fn edges_of(mesh: &Mesh, numbers: impl IntoIterator<Item = u32>) -> BTreeSet<(BTreeSet<[u64; 3]>, i32)> {
    let edge = |e: u32| (mesh.edges[e as usize].map(|v| bits(mesh, v)).into(), mesh.edge_labels[e as usize]);
    numbers.into_iter().map(edge).collect()
}

/// The area of each label.
fn areas(mesh: &Mesh) -> BTreeMap<i32, f64> {
    let mut areas = BTreeMap::new();
    for (&t, &label) in mesh.triangles.iter().zip(&mesh.triangle_labels) {
        let [a, b, c] = mesh.corners_of(t);
        *areas.entry(label).or_default() += 0.5 * (b - a).cross(c - a);
    }
    areas
}

#[test]
fn files_are_named_as_mmg2d_names_them() {
    let place = place();
    for (words, out) in [
        ("in.mesh", ["in.o.mesh", "in.o.sol"]),
        ("in fine", ["fine.mesh", "fine.sol"]),
        ("-in in.mesh -out other.mesh", ["other.mesh", "other.sol"]),
        ("in.mesh third.vtu", ["third.vtu", "third.sol"]),
    ] {
        done(&place, &format!("remesh {words} -hsiz 0.4 -v 0"));
        assert!(out.iter().all(|name| place.files().contains(&(*name).into())), "{words}: {:?}", place.files());
    }
}

#[test]
fn a_metric_is_honoured_within_limits() {
    let place = place();
    put_values(&place, "h.sol", |x, _| vec![0.03 + 0.2 * x]);
    done(&place, "remesh in.mesh a.mesh -sol h.sol -hmin 0.05 -hmax 0.1 -hgrad -1 -q --report run.json");
    let report: Value = serde_json::from_slice(&place.read("run.json")).unwrap();
    assert!(report["metric_edge_length"]["unit_fraction"].as_f64().unwrap() > 0.95);
    let used = sizes(&place, "a.sol");
    assert_eq!(used.len(), mesh(&place, "a.mesh").points.len());
    assert!(used.iter().all(|h| (0.05 - 1e-9..=0.1 + 1e-9).contains(h)), "{used:?}");
    assert_eq!((report["options"]["hmin"].as_f64(), report["options"]["hgrad"].as_f64()), (Some(0.05), None));
    // The one next to the mesh, by its name, is found, and another one comes first.
    put_values(&place, "in.sol", |_, _| vec![0.2]);
    done(&place, "remesh in.mesh b.mesh -q");
    assert!(sizes(&place, "b.sol").iter().all(|h| (h - 0.2).abs() < 1e-9));
    done(&place, "remesh in.mesh c.mesh -met h.sol -q");
    assert!(sizes(&place, "c.sol").iter().any(|&h| h < 0.1));
}

#[test]
fn tensors_are_stretched_as_they_say() {
    let place = place();
    put_values(&place, "m.sol", |_, _| vec![1.0 / 0.0025, 0.0, 1.0 / 0.16]);
    done(&place, "remesh in.mesh a.mesh -sol m.sol -q --report run.json");
    let report: Value = serde_json::from_slice(&place.read("run.json")).unwrap();
    // From 0.935 to 1, if tensors change by a billionth: a square has ties.
    assert!(report["metric_edge_length"]["unit_fraction"].as_f64().unwrap() > 0.9);
    let solution = sol::read(place.read("a.sol").as_slice(), "a.sol").unwrap();
    let SolutionValues::Tensor(tensors) = solution.values else { panic!("tensors") };
    assert!(tensors.iter().all(|m| (m[0] / 400.0 - 1.0).abs() < 1e-9 && (m[2] / 6.25 - 1.0).abs() < 1e-9));
}

#[test]
fn sizes_that_jump_grow_by_hgrad() {
    let place = place();
    put_values(&place, "h.sol", |x, y| vec![if x == 0.0 && y == 0.0 { 0.05 } else { 1.0 }]);
    done(&place, "remesh in.mesh a.mesh -sol h.sol -q");
    let found = mesh(&place, "a.mesh");
    for (p, h) in found.points.iter().zip(sizes(&place, "a.sol")) {
        // Along edges of a grid the way is up to sqrt(2) as long as the straight one.
        let (away, growth) = (p[0].hypot(p[1]), 1.3_f64.ln());
        assert!(h < 1.05 * (0.05 + 1.42 * growth * away) && h > 0.04, "{h} at {p:?}");
    }
    done(&place, "remesh in.mesh b.mesh -sol h.sol -hgrad -1 -q");
    assert!(mesh(&place, "b.mesh").points.len() < found.points.len());
}

#[test]
fn one_size_everywhere() {
    let place = place();
    done(&place, "remesh in.mesh a.mesh -hsiz 0.07 -q");
    let [least, most] = range(&mesh(&place, "a.mesh"));
    assert!(least > 0.035 && most < 0.12, "{least} {most}");
    // Without anything the square needs no more than its corners and what keeps its triangles in shape.
    done(&place, "remesh in.mesh b.mesh -q");
    assert!(mesh(&place, "b.mesh").points.len() < 20);
}

#[test]
fn labels_stay() {
    let place = place();
    let mut given = square();
    given.edges = vec![[0, 11], [11, 22], [5, 16]];
    given.edge_labels = vec![7, 7, 9];
    write_mesh(&given, &place.path().join("in.mesh")).unwrap();
    done(&place, "remesh in.mesh a.mesh -hsiz 0.06 -q");
    let found = mesh(&place, "a.mesh");
    let areas = areas(&found);
    assert!(areas.len() == 2 && areas.values().all(|area| (area - 0.5).abs() < 1e-12), "{areas:?}");
    let length = |label: i32| -> f64 {
        let edges = found.edges.iter().zip(&found.edge_labels).filter(|(_, l)| **l == label);
        edges.map(|(&[a, b], _)| found.point(a).distance(found.point(b))).sum()
    };
    assert!((length(7) - 0.2).abs() < 1e-12 && (length(9) - 0.1).abs() < 1e-12, "{} {}", length(7), length(9));
    // The boundary, and the interface.
    assert!((length(0) - 4.7).abs() < 1e-12, "{}", length(0));
}

#[test]
fn what_is_required_is_there_to_the_last_bit() {
    let place = place();
    let mut given = square();
    given.points[37] = [0.412_345_678_901_234_5, 0.298_765_432_109_876_5, 0.0];
    (given.required_points, given.corners) = (vec![37, 99], vec![60]);
    given.edges = vec![[0, 1], [1, 2], [70, 71], [44, 55]];
    (given.edge_labels, given.required_edges) = (vec![3, 3, 4, 5], vec![0, 2]);
    write_mesh(&given, &place.path().join("in.mesh")).unwrap();
    done(&place, "remesh in.mesh a.mesh -hsiz 0.2 -q");
    let found = mesh(&place, "a.mesh");
    assert_eq!(edges_of(&found, found.required_edges.clone()), edges_of(&given, [0, 2]));
    let required: BTreeSet<_> = found.required_points.iter().map(|&v| bits(&found, v)).collect();
    assert_eq!(required, [37, 99].map(|v| bits(&given, v)).into());
    // Corners are those of the list, of the square, the interface's ends, and the ends of the required edge inside.
    let corners: BTreeSet<_> = found.corners.iter().map(|&v| bits(&found, v)).collect();
    assert_eq!(corners, [0, 10, 110, 120, 60, 5, 115, 70, 71].map(|v| bits(&given, v)).into());
}

#[test]
fn nosurf_leaves_boundary_and_interfaces() {
    let place = place();
    done(&place, "remesh in.mesh a.mesh -nosurf -hmax 0.3 -q");
    let (found, given) = (mesh(&place, "a.mesh"), square());
    let boundary: BTreeSet<_> = edges_of(&found, 0..found.edges.len() as u32);
    let number = |i: u32, j: u32| bits(&given, j * 11 + i);
    let sides = (0..10).flat_map(|k| {
        [
            [[k, 0], [k + 1, 0]],
            [[k, 10], [k + 1, 10]],
            [[0, k], [0, k + 1]],
            [[10, k], [10, k + 1]],
            [[5, k], [5, k + 1]],
        ]
    });
    assert_eq!(boundary, sides.map(|edge| (edge.map(|[i, j]| number(i, j)).into(), 0)).collect());
    assert!(found.required_edges.is_empty() && found.required_points.is_empty());
    // Their size is that of what is near them, unless told otherwise.
    done(&place, "remesh in.mesh b.mesh -nosurf -nosizreq -hmax 0.3 -q");
    assert!(mesh(&place, "b.mesh").points.len() < found.points.len());
}

#[test]
fn edges_inside_a_region_are_kept_if_asked_for() {
    let place = place();
    let mut given = square();
    (given.edges, given.edge_labels) = (vec![[57, 58], [58, 59], [0, 60]], vec![6, 6, 6]);
    write_mesh(&given, &place.path().join("in.mesh")).unwrap();
    let inner = |words: &str| {
        done(&place, &format!("remesh in.mesh a.mesh -hsiz 0.2 -v 0 {words}"));
        mesh(&place, "a.mesh").edge_labels.iter().filter(|&&label| label == 6).count()
    };
    assert_eq!(inner(""), 0);
    assert!(inner("-opnbdy") > 0);
    let said = done(&place, "remesh in.mesh a.mesh -hsiz 0.2");
    assert!(said.contains("3 edges of the list are left out"), "{said}");
}

#[test]
fn optim_keeps_the_sizes_that_are_there() {
    let place = place();
    let mut thin = square();
    thin.points.iter_mut().for_each(|p| p[1] *= 0.2);
    write_mesh(&thin, &place.path().join("thin.mesh")).unwrap();
    done(&place, "remesh thin.mesh a.mesh -optim -A -q --report run.json");
    let found = mesh(&place, "a.mesh");
    assert!((90..=150).contains(&found.points.len()), "{}", found.points.len());
    let solution = sol::read(place.read("a.sol").as_slice(), "a.sol").unwrap();
    let SolutionValues::Tensor(tensors) = solution.values else { panic!("tensors") };
    assert!(tensors.iter().all(|m| m[2] > 15.0 * m[0]), "{tensors:?}");
    done(&place, "remesh in.mesh b.mesh -optim -q");
    assert!(sizes(&place, "b.sol").iter().all(|h| (0.08..0.13).contains(h)));
}

#[test]
fn curves_are_as_fine_as_hausd_asks() {
    let place = place();
    let ring = (0..200).map(|k| std::f64::consts::TAU * f64::from(k) / 200.0);
    let disc = Mesh {
        points: ring.map(|t| [t.cos(), t.sin(), 0.0]).collect(),
        edges: (0..200).map(|k| [k, (k + 1) % 200]).collect(),
        edge_labels: vec![4; 200],
        ..Mesh::default()
    };
    // Without triangles: the boundary of a domain.
    write_mesh(&disc, &place.path().join("disc.mesh")).unwrap();
    let borders = [0.05, 0.005].map(|hausd| {
        done(&place, &format!("remesh disc.mesh a.mesh -hausd {hausd} -q --report run.json"));
        let report: Value = serde_json::from_slice(&place.read("run.json")).unwrap();
        assert!(report["fidelity"]["from_domain"]["distance"].as_f64().unwrap_or(0.0) <= hausd, "{report:#}");
        let found = mesh(&place, "a.mesh");
        assert!(found.edge_labels.iter().all(|&label| label == 4) && found.corners.is_empty());
        found.edges.len() as f64
    });
    // sqrt(8 hausd) on a circle of radius one, and edges of unit length are as long in the mean.
    let expected = [0.05_f64, 0.005].map(|hausd| std::f64::consts::TAU / (8.0 * hausd).sqrt());
    assert!(borders.iter().zip(expected).all(|(n, e)| (0.8..1.5).contains(&(n / e))), "{borders:?} {expected:?}");
    done(&place, "remesh disc.mesh b.mesh -hausd 0.005 -A -q");
    assert!(matches!(sol::read(place.read("b.sol").as_slice(), "b.sol").unwrap().values, SolutionValues::Tensor(_)));
}

#[test]
fn meshes_with_z_are_planar_where_it_is_zero() {
    let place = place();
    let text = String::from_utf8(place.read("in.mesh")).unwrap();
    let mut lines: Vec<String> = text.lines().map(Into::into).collect();
    let first = lines.iter().position(|line| line == "121").unwrap() + 1;
    for line in &mut lines[first..first + 121] {
        *line = line.rsplit_once(' ').map(|(xy, label)| format!("{xy} 0 {label}")).unwrap();
    }
    place.put("space.mesh", lines.join("\n").replace("Dimension 2", "Dimension 3"));
    let said = done(&place, "remesh space.mesh a.mesh -hsiz 0.2 -3dMedit 3");
    assert!(said.contains("warning: -3dMedit changes nothing"), "{said}");
    done(&place, "remesh in.mesh b.mesh -hsiz 0.2 -q");
    assert_eq!(place.read("a.mesh"), place.read("b.mesh"));
}

#[test]
fn options_without_sense_are_taken_with_a_warning() {
    let place = place();
    let words = "-noswap -noinsert -nomove -nreg -xreg 0.2 -rmc -hgradreq 2 -keep-ref -nofem -d -m 4000 -v 0 --no-fit";
    let said = done(&place, &format!("remesh in.mesh a.mesh -hsiz 0.4 {words}"));
    for option in [
        "-noswap",
        "-noinsert",
        "-nomove",
        "-nreg",
        "-xreg",
        "-rmc",
        "-hgradreq",
        "-keep-ref",
        "-nofem",
        "-d",
        "--no-fit",
    ] {
        assert!(said.contains(&format!("warning: {option} changes nothing: ")), "{option}: {said}");
    }
    let said = done(&place, "remesh in.mesh a.mesh -hsiz 0.4 -v 0 -nosurf -opnbdy -nosizreq");
    assert!(said.is_empty(), "{said}");
    // As mmg2d has it, which goes on, too.
    let said = done(&place, "remesh in.mesh a.mesh -sol none.sol -q");
    assert!(said.contains("warning: none.sol not found"), "{said}");
}

#[test]
fn what_is_wrong_is_said_and_nothing_is_written() {
    let place = place();
    put_values(&place, "negative.sol", |x, _| vec![x - 0.5]);
    place.put("short.sol", "MeshVersionFormatted 2 Dimension 2 SolAtVertices 1 1 1 0.5");
    place.put("vector.sol", "MeshVersionFormatted 2 Dimension 2 SolAtVertices 1 1 2 0.5 0.5");
    let mut fixed = square();
    fixed.required_triangles = vec![3];
    write_mesh(&fixed, &place.path().join("fixed.mesh")).unwrap();
    place.put(
        "edges.mesh",
        "MeshVersionFormatted 2 Dimension 2 Vertices 3 0 0 0 1 0 0 0 1 0 Edges 3 1 2 0 2 3 0 3 1 0 End",
    );
    place.put("open.mesh", "MeshVersionFormatted 2 Dimension 2 Vertices 3 0 0 0 1 0 0 0 1 0 Edges 2 1 2 0 2 3 0 End");
    let before = place.files();
    for (words, message) in [
        ("remesh none.mesh", "none.mesh"),
        ("remesh in.mesh -ls 0.5", "not supported: remesh -ls"),
        ("remesh in.mesh -sol short.sol", "1 sizes for 121 vertices"),
        ("remesh in.mesh -sol vector.sol", "no planar metric"),
        ("remesh in.mesh -sol negative.sol", "h = -0.5 is not positive"),
        ("remesh in.mesh -hmin 2 -hmax 1", "h_min = 2 is larger than h_max = 1"),
        ("remesh in.mesh -hgrad 0.5", "hgrad = 0.5"),
        ("remesh in.mesh -hmax", "hmax"),
        ("remesh in.mesh -hmax -1", "-1"),
        ("remesh in.mesh -hsiz 0.1 -sol short.sol", "cannot be used with"),
        ("remesh in.mesh -hsiz 0.1 -optim", "cannot be used with"),
        ("remesh in.mesh -optim -sol short.sol", "cannot be used with"),
        ("remesh edges.mesh -optim", "-optim"),
        ("remesh open.mesh", "open.mesh, "),
        ("remesh fixed.mesh", "1 RequiredTriangles"),
        ("remesh in.mesh nowhere/a.mesh", "nowhere"),
        ("remesh in.mesh a.foo", "foo"),
        ("remesh in.mesh -hsiz 1e-4 -m 1", "limit exceeded"),
    ] {
        // mmg's code where it writes no mesh, and ours for wrong usage.
        let output = place.run(&words.split_whitespace().collect::<Vec<_>>());
        assert_eq!(output.status.code(), Some(2), "{words}: {}", stderr(&output));
        assert!(stderr(&output).contains(message), "{words}: {}", stderr(&output));
    }
    assert_eq!(place.files(), before);
}
