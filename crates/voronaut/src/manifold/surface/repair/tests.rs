//! One test for each kind of damage.

use super::*;
use crate::geometry::Point3;
use crate::test_cases::cases;
use proptest::prelude::*;

/// The cube of side one, each face n x n squares of two triangles, turned outwards.
fn cube(n: u32) -> Mesh {
    let mut mesh = Mesh::default();
    let mut known = std::collections::HashMap::new();
    for (axis, is_far) in (0..3).flat_map(|axis| [(axis, false), (axis, true)]) {
        let mut vertex = |i: u32, j: u32| {
            let mut p = [0; 3];
            (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (if is_far { n } else { 0 }, i, j);
            *known.entry(p).or_insert_with(|| {
                mesh.points.push(p.map(|x| f64::from(x) / f64::from(n)));
                mesh.points.len() as u32 - 1
            })
        };
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
            mesh.triangles.extend([[a, b, c], [a, c, d]].map(|[p, q, r]| if is_far { [p, q, r] } else { [p, r, q] }));
        }
    }
    mesh
}

/// A flat sheet of n x n squares.
fn sheet(n: u32) -> Mesh {
    let at = |i: u32, j: u32| i * (n + 1) + j;
    let cells = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    let points = (0..=n).flat_map(|i| (0..=n).map(move |j| [f64::from(i), f64::from(j), 0.0]));
    let triangles = cells.flat_map(|(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    Mesh { points: points.collect(), triangles: triangles.collect(), ..Mesh::default() }
}

fn tried(mesh: &Mesh, repair: bool) -> Result<(Surface, Mended)> {
    let (made, mended) = repaired(mesh, RepairOptions { repair })?;
    Ok((Surface::new(&made)?, mended))
}

fn refusal(mesh: &Mesh) -> String {
    let error = tried(mesh, false).unwrap_err();
    assert!(error.help().contains("`repair`"), "{}", error.help());
    error.to_string()
}

/// Euler characteristic and border loops of what comes out, and how often the damage was found.
fn shape(mesh: &Mesh, repair: bool, kind: Damage) -> (isize, usize, usize) {
    let (surface, mended) = tried(mesh, repair).unwrap();
    (surface.euler_characteristic(), surface.border_loops().len(), mended.count(kind))
}

#[test]
fn surfaces_without_damage_come_back_as_they_are() {
    for mesh in [cube(1), cube(5), sheet(4)] {
        for repair in [false, true] {
            let (made, mended) = repaired(&mesh, RepairOptions { repair }).unwrap();
            assert_eq!((made, mended), (mesh.clone(), Mended::default()));
        }
    }
}

#[test]
fn soups_are_welded() {
    let mesh = cube(3);
    let soup = |off: f64| {
        let mut points: Vec<[f64; 3]> =
            mesh.triangles.as_flattened().iter().map(|&v| mesh.points[v as usize]).collect();
        (0..points.len()).for_each(|i| points[i][i % 3] += off * (i % 5) as f64);
        let triangles = (0..mesh.triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        Mesh { points, triangles, ..Mesh::default() }
    };
    let doubled = 3 * mesh.triangles.len() - mesh.points.len();
    assert_eq!(shape(&soup(0.0), false, Damage::Welded), (2, 0, doubled));
    assert_eq!(shape(&soup(1e-10), false, Damage::Welded), (2, 0, doubled));
    assert_eq!(shape(&soup(1e-6), false, Damage::Welded).2, 0, "these are apart");
}

#[test]
fn sheets_that_touch_stay_as_they_are_numbered() {
    // Two cubes that share a corner, an edge, or a face, each with its own vertices.
    for shift in [[1.0, 1.0, 1.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0]] {
        let mut two = cube(2);
        let (vertices, one) = (two.points.len() as u32, two.clone());
        two.points.extend(one.points.iter().map(|p| [0, 1, 2].map(|i| p[i] + shift[i])));
        two.triangles.extend(one.triangles.iter().map(|t| t.map(|v| v + vertices)));
        for repair in [false, true] {
            assert_eq!(
                repaired(&two, RepairOptions { repair }).unwrap(),
                (two.clone(), Mended::default()),
                "{shift:?}"
            );
        }
    }
}

#[test]
fn a_ribbon_whose_ends_lie_on_each_other_with_a_twist_stays_open() {
    let at = |i: u32| {
        let angle = std::f64::consts::TAU * f64::from(i / 2 % 6) / 6.0;
        // Once around, the two sides have changed places.
        let across = if i.is_multiple_of(2) == (i < 12) { 0.3 } else { -0.3 };
        let r = 1.0 + across * (0.5 * angle).cos();
        [r * angle.cos(), r * angle.sin(), across * (0.5 * angle).sin()]
    };
    let strip = (0..6).flat_map(|k| [[2 * k, 2 * k + 1, 2 * k + 2], [2 * k + 1, 2 * k + 3, 2 * k + 2]]);
    let ribbon = Mesh { points: (0..14).map(at).collect(), triangles: strip.collect(), ..Mesh::default() };
    assert_eq!(shape(&ribbon, false, Damage::Seam), (1, 1, 1));
    let mut moebius = ribbon.clone();
    moebius.triangles.iter_mut().flatten().for_each(|v| *v = [*v, 1, 0][(*v as usize).saturating_sub(11).min(2)]);
    assert!(refusal(&moebius).contains("a one-sided surface"));
    assert_eq!(shape(&moebius, true, Damage::OneSided), (1, 1, 1));
}

#[test]
fn triangles_without_area_go_and_neighbours_meet() {
    // A vertex in the middle of an edge, on one side of which a cap fills the gap.
    let mut mesh = cube(2);
    let [a, b, c] = mesh.triangles[4];
    let middle = mesh.points.len() as u32;
    mesh.points.push(mesh.position(a).lerp(mesh.position(b), 0.5).to_array());
    mesh.triangles[4] = [a, middle, c];
    mesh.triangles.extend([[middle, b, c], [middle, a, b], [b, b, c]]);
    assert_eq!(shape(&mesh, false, Damage::Degenerate), (2, 0, 2));
    // A needle: two vertices that are nearly one.
    let mut mesh = cube(2);
    let [a, b, c] = mesh.triangles[4];
    let near = mesh.points.len() as u32;
    let p = mesh.position(a).lerp(mesh.position(b), 1e-15);
    mesh.points.push(p.to_array());
    mesh.triangles[4] = [near, b, c];
    mesh.triangles.extend([[a, near, c], [a, b, near]]);
    assert_eq!(shape(&mesh, false, Damage::Degenerate), (2, 0, 2));
}

#[test]
fn only_flat_triangles_are_no_surface() {
    let points = (0..4).map(|i| [f64::from(i), 0.0, 0.0]).collect();
    let flat = Mesh { points, triangles: vec![[0, 1, 2], [1, 3, 2]], ..Mesh::default() };
    for repair in [false, true] {
        let error = tried(&flat, repair).unwrap_err().to_string();
        assert!(error.contains("area"), "{error}");
    }
    assert!(tried(&Mesh::default(), true).unwrap_err().to_string().contains("no triangles"));
}

#[test]
fn duplicates_are_dropped_to_one() {
    let mut mesh = cube(2);
    let [a, b, c] = mesh.triangles[3];
    mesh.triangles.extend([[b, c, a], [b, a, c]]);
    assert_eq!(shape(&mesh, false, Damage::Duplicate), (2, 0, 2));
    // With vertices of its own, and with one of its own.
    let mut mesh = cube(2);
    let (n, p) = (mesh.points.len() as u32, mesh.triangles[3].map(|v| mesh.points[v as usize]));
    mesh.points.extend(p);
    mesh.triangles.extend([[n, n + 1, n + 2], [a, b, n + 2]]);
    assert_eq!(shape(&mesh, false, Damage::Duplicate), (2, 0, 2));
}

#[test]
fn coordinates_that_are_not_finite_cost_their_triangles() {
    let mut mesh = cube(4);
    let v = mesh.triangles[9][0];
    mesh.points[v as usize][1] = f64::INFINITY;
    assert!(refusal(&mesh).contains(&format!("a coordinate is not finite at vertex {} (", v + 1)));
    let lost = mesh.triangles.iter().filter(|t| t.contains(&v)).count();
    assert_eq!(shape(&mesh, true, Damage::NotFinite), (2, 0, lost));
    assert_eq!(shape(&mesh, true, Damage::Closed).2, 1);
    let mut mesh = cube(1);
    mesh.points.push([f64::NAN; 3]);
    assert_eq!(shape(&mesh, false, Damage::NotFinite), (2, 0, 0), "nobody uses it");
}

#[test]
fn t_junctions_are_named_or_closed() {
    let mut mesh = cube(1);
    let [a, b, c] = mesh.triangles[4];
    // Three vertices inside an edge, on one of its sides only.
    let n = mesh.points.len() as u32;
    for t in [0.25, 0.5, 0.7] {
        mesh.points.push(mesh.position(a).lerp(mesh.position(b), t).to_array());
    }
    mesh.triangles[4] = [a, n, c];
    mesh.triangles.extend([[n, n + 1, c], [n + 1, n + 2, c], [n + 2, b, c]]);
    assert!(refusal(&mesh).contains("a T-junction: a vertex inside an edge of triangle"));
    assert_eq!(shape(&mesh, true, Damage::TJunction), (2, 0, 3));
    // Vertices inside the edge from both sides, nowhere the same.
    let beside = mesh.triangles.iter().position(|t| t.contains(&a) && t.contains(&b)).unwrap();
    let k = (0..3).find(|&k| ![a, b].contains(&mesh.triangles[beside][k])).unwrap();
    let [apex, p, q] = [0, 1, 2].map(|i| mesh.triangles[beside][(k + i) % 3]);
    mesh.points.push(mesh.position(p).lerp(mesh.position(q), 0.4).to_array());
    mesh.triangles[beside] = [apex, p, n + 3];
    mesh.triangles.push([apex, n + 3, q]);
    assert_eq!(shape(&mesh, true, Damage::TJunction), (2, 0, 4));
}

#[test]
fn borders_that_touch_are_no_t_junction() {
    let points = vec![[0.0; 3], [2.0, 0.0, 0.0], [1.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.5, 1.0, 0.0], [1.5, 1.0, 0.0]];
    let mesh = Mesh { points, triangles: vec![[0, 2, 1], [3, 5, 4]], ..Mesh::default() };
    assert_eq!(shape(&mesh, false, Damage::TJunction), (2, 2, 0));
}

#[test]
fn small_holes_are_told_or_closed() {
    let mut mesh = cube(4);
    mesh.triangles.remove(40);
    mesh.triangles.drain(8..10);
    assert_eq!(shape(&mesh, false, Damage::Open), (0, 2, 2));
    assert_eq!(shape(&mesh, true, Damage::Closed), (2, 0, 2));
    let (made, _) = repaired(&mesh, RepairOptions { repair: true }).unwrap();
    assert!((Surface::new(&made).unwrap().area() - 6.0).abs() < 1e-12, "the faces are flat again");
}

#[test]
fn borders_that_were_meant_stay_open() {
    // A sheet, and a tube of six sides whose ends have six edges.
    let at = |i: u32| {
        let angle = std::f64::consts::TAU * f64::from(i % 6) / 6.0;
        [angle.cos(), angle.sin(), f64::from(i / 6)]
    };
    let rings = (0..8).flat_map(|k| (0..6).map(move |i| (6 * k + i, 6 * k + (i + 1) % 6)));
    let tube = rings.flat_map(|(a, b)| [[a, b, b + 6], [a, b + 6, a + 6]]).collect();
    let tube = Mesh { points: (0..54).map(at).collect(), triangles: tube, ..Mesh::default() };
    for mesh in [tube, sheet(2), sheet(6)] {
        assert_eq!(repaired(&mesh, RepairOptions { repair: true }).unwrap(), (mesh, Mended::default()));
    }
}

#[test]
fn edges_of_three_triangles_are_named_or_cut() {
    let mut mesh = cube(3);
    let ([a, b, _], n) = (mesh.triangles[7], mesh.points.len() as u32);
    mesh.points.push([0.5, 0.5, 0.6]);
    mesh.triangles.push([a, b, n]);
    assert!(refusal(&mesh).contains("an edge of 3 triangles (among them"));
    let (surface, mended) = tried(&mesh, true).unwrap();
    let parts: Vec<_> = surface.components().iter().map(|c| (c.faces.len(), c.borders)).collect();
    assert_eq!((parts, mended.count(Damage::Edge), mended.count(Damage::Fin)), (vec![(108, 0)], 1, 1));
}

#[test]
fn two_cubes_that_share_an_edge_by_number_are_cut() {
    let (one, mut two) = (cube(2), cube(2));
    let vertices = two.points.len() as u32;
    let shifted = |p: &[f64; 3]| [p[0] + 1.0, p[1] + 1.0, p[2]];
    let number = |v: u32| {
        let p = shifted(&one.points[v as usize]);
        one.points.iter().position(|q| Point3::from(*q) == p.into()).map_or(v + vertices, |at| at as u32)
    };
    two.points.extend(one.points.iter().map(shifted));
    two.triangles.extend(one.triangles.iter().map(|t| t.map(number)));
    assert!(refusal(&two).contains("an edge of 4 triangles"));
    let (surface, mended) = tried(&two, true).unwrap();
    assert_eq!((surface.border_loops().len(), mended.count(Damage::Edge)), (0, 2));
}

#[test]
fn sheets_that_meet_in_a_point_are_named_or_cut() {
    let mut mesh = cube(3);
    let (n, v) = (mesh.points.len() as u32, mesh.triangles[20][0]);
    mesh.points.extend([[2.0, 0.0, 0.0], [2.0, 1.0, 0.0]]);
    mesh.triangles.push([v, n, n + 1]);
    assert!(refusal(&mesh).contains(&format!("triangles that meet in a point only at vertex {} (", v + 1)));
    let (made, mended) = repaired(&mesh, RepairOptions { repair: true }).unwrap();
    assert_eq!((made.points.len(), mended.count(Damage::Point)), (mesh.points.len() + 1, 1));
    assert_eq!(Point3::from(made.points[mesh.points.len()]), mesh.points[v as usize].into());
    assert_eq!(made.triangles[..108], mesh.triangles[..108]);
}

#[test]
fn triangles_that_are_turned_are_counted() {
    let mut mesh = cube(2);
    for t in [3, 17, 40] {
        mesh.triangles[t].swap(0, 1);
    }
    let (made, mended) = repaired(&mesh, RepairOptions::default()).unwrap();
    assert_eq!((made, mended.count(Damage::Turned)), (mesh.clone(), 3));
    mesh.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    assert_eq!(tried(&mesh, false).unwrap().1.count(Damage::Turned), 3, "inside out as a whole it stays");
}

#[test]
fn lists_and_labels_come_along() {
    let mut mesh = sheet(2);
    // A soup but for the list of edges: those on the left border, and a diagonal that a T-junction cuts.
    mesh.triangle_labels = (0..8).collect();
    mesh.point_labels = (0..9).collect();
    (mesh.edges, mesh.edge_labels) = (vec![[1, 0], [0, 4], [4, 8]], vec![5, 6, 7]);
    (mesh.ridges, mesh.required_edges, mesh.required_triangles) = (vec![1], vec![0, 2], vec![0, 7]);
    (mesh.corners, mesh.required_points) = (vec![0, 8], vec![4]);
    let n = mesh.points.len() as u32;
    mesh.points.extend([[0.5, 0.5, 0.0], [0.0, 0.0, 0.0]]);
    mesh.point_labels.extend([9, 10]);
    // Triangle 0 is 0 3 4, triangle 1 is 0 4 1; the first is cut at 9 and one of its parts has vertex 10 for 0.
    assert_eq!(mesh.triangles[..2], [[0, 3, 4], [0, 4, 1]]);
    mesh.triangles[0] = [n + 1, 3, n];
    mesh.triangles.push([3, 4, n]);
    mesh.triangle_labels.push(0);
    mesh.triangles.insert(2, [5, 5, 4]);
    mesh.triangle_labels.insert(2, 77);
    mesh.required_triangles = vec![1, 2, 8];
    let (made, mended) = repaired(&mesh, RepairOptions { repair: true }).unwrap();
    assert_eq!(
        (mended.count(Damage::TJunction), mended.count(Damage::Degenerate), mended.count(Damage::Welded)),
        (1, 1, 1)
    );
    assert_eq!(made.edges, [[1, 0], [0, n], [n, 4], [4, 8]]);
    assert_eq!((made.edge_labels, made.ridges, made.required_edges), (vec![5, 6, 6, 7], vec![1, 2], vec![0, 3]));
    assert_eq!(made.triangle_labels, [0, 1, 2, 3, 4, 5, 6, 7, 0, 1]);
    assert_eq!((made.required_triangles, made.corners, made.required_points), (vec![1, 7, 9], vec![0, 8], vec![4]));
    assert_eq!((made.triangles[0], made.triangles[1], made.triangles[9]), ([0, 3, n], [0, n, 1], [n, 4, 1]));
}

#[test]
fn mistakes_in_the_list_of_edges_are_told_as_before() {
    let mut mesh = sheet(2);
    mesh.edges = vec![[0, 8]];
    assert!(tried(&mesh, false).unwrap_err().to_string().contains("edge 1 of the list is no edge of a triangle"));
    assert_eq!(shape(&mesh, true, Damage::Listed), (1, 1, 1));
    mesh.triangles[0][0] = 99;
    assert!(tried(&mesh, true).unwrap_err().to_string().contains("vertex 99 (from 0) does not exist"));
}

#[test]
fn what_a_cut_leaves_behind_is_found_in_another_look() {
    let points: [[u8; 3]; 8] = [[0, 0, 0], [1, 2, 2], [0, 1, 0], [0, 0, 0], [1, 2, 2], [0, 0, 1], [2, 1, 2], [2, 1, 2]];
    let triangles = vec![[4, 0, 6], [1, 7, 5], [2, 1, 7], [6, 5, 1], [0, 4, 7], [0, 0, 0], [6, 5, 4], [0, 7, 1]];
    let mesh = Mesh { points: points.map(|p| p.map(f64::from)).into(), triangles, ..Mesh::default() };
    let (made, _) = repaired(&mesh, RepairOptions { repair: true }).unwrap();
    assert!(repaired(&made, RepairOptions { repair: true }).is_ok());
}

proptest! {
    #![proptest_config(cases(512))]
    /// Whatever the triangles of a few vertices at a few places, there is a surface or an error, and repair refuses nothing
    /// but what has no area.
    #[test]
    fn any_triangles_are_mended_or_refused(
        places in prop::collection::vec(prop::array::uniform3(0..3_u8), 4..9),
        corners in prop::collection::vec(prop::array::uniform3(0..9_u32), 1..24),
    ) {
        let points: Vec<_> = places.iter().map(|p| p.map(f64::from)).collect();
        let n = points.len() as u32;
        let mesh = Mesh { triangles: corners.iter().map(|t| t.map(|v| v % n)).collect(), points, ..Mesh::default() };
        if let Ok((made, _)) = repaired(&mesh, RepairOptions { repair: false }) {
            prop_assert!(Surface::new(&made).is_ok());
        }
        match repaired(&mesh, RepairOptions { repair: true }) {
            Ok((made, _)) => {
                let again = repaired(&made, RepairOptions { repair: true });
                prop_assert!(again.is_ok(), "{again:?}");
            }
            Err(error) => prop_assert!(error.to_string().contains("area"), "{error}"),
        }
    }
}
