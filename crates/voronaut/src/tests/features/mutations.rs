//! The checker finds what is wrong, and nothing where nothing is; parts are what they are said to be.

use super::common::faults;
use crate::manifold::surface::Surface;
use crate::mesh::Mesh;
use crate::quality::validity;
use crate::tests::parts::{self, Part};

/// The same surface with its features listed: what a mesher would hand back at best.
fn copied(part: &Part) -> Mesh {
    if part.mesh.edges.is_empty() { part.clone().listed().mesh } else { part.mesh.clone() }
}

/// Faults of the copy after a change.
fn after(part: &Part, change: impl FnOnce(&mut Mesh)) -> Vec<String> {
    let mut mesh = copied(part);
    change(&mut mesh);
    faults(part, &mesh, 1e-9)
}

fn part(name: &str) -> Part {
    parts::all().into_iter().find(|part| part.name == name).unwrap()
}

/// After a change there is a fault that begins so.
fn assert_found(part: &Part, change: impl FnOnce(&mut Mesh), begins: &str) {
    let found = after(part, change);
    assert!(found.iter().any(|fault| fault.starts_with(begins)), "{}: {begins} not among {found:?}", part.name);
}

#[test]
fn parts_are_surfaces_with_the_features_they_are_said_to_have() {
    let known = [
        ("cube", 2, 0, 12, 8),
        ("cube_plain", 2, 0, 12, 8),
        ("bracket", -2, 0, 32, 16),
        ("bracket_cad", -2, 0, 32, 16),
        ("patch", 0, 2, 7, 6),
        ("two", 2, 0, 1, 0),
        ("blade", 2, 0, 21, 14),
    ];
    for (part, (name, euler, borders, chains, corners)) in parts::all().iter().zip(known) {
        let found = validity(&part.mesh);
        assert!(found.valid && found.unused_vertices == 0, "{name}: {found:?}");
        assert_eq!((part.name, found.euler, found.boundary_loops), (name, euler, borders));
        assert_eq!((part.features.chains.len(), part.features.corners.len()), (chains, corners), "{name}");
        assert_eq!(Surface::new(&part.mesh).unwrap().turned(), 0, "{name}");
    }
}

#[test]
fn vertices_of_the_bracket_are_on_its_faces() {
    for part in ["bracket", "bracket_cad"].map(part) {
        let mut most = 0.0_f64;
        for (t, &label) in part.mesh.triangles.iter().zip(&part.mesh.triangle_labels) {
            for p in part.mesh.positions_of(*t) {
                let off = match label {
                    4 => (p.x - 0.9).hypot(p.z - 0.9) - 0.3,
                    8 => (p.x - 0.4).hypot(p.z - 0.4) - 0.4,
                    11 => (p.x - 2.5).hypot(p.y - 0.4) - 0.25,
                    12 => (p.y - 1.0).hypot(p.z - 1.6) - 0.3,
                    13 => (p.x - 1.8).hypot(p.y - 1.2) - 0.5,
                    14 => (p.x - 1.8).hypot(p.z - 1.05) - 0.25,
                    1 => p.z,
                    2 => p.x - 3.0,
                    3 => p.z - 0.6,
                    5 => p.x - 0.6,
                    6 => p.z - 2.2,
                    7 => p.x,
                    9 => p.y,
                    10 => p.y - 2.0,
                    15 => p.z - 1.5,
                    _ => p.y - 2.2,
                };
                most = most.max(off.abs());
            }
        }
        assert!(most < 1e-14, "{}: {most}", part.name);
    }
}

#[test]
fn a_copy_is_faultless() {
    for part in parts::all() {
        assert_eq!(faults(&part, &copied(&part), 1e-9), Vec::<String>::new(), "{}", part.name);
    }
}

#[test]
fn a_corner_that_moved_is_found() {
    for name in ["cube", "cube_plain", "bracket", "bracket_cad", "patch", "blade"] {
        let part = part(name);
        let corner = *part.features.corners.first().unwrap() as usize;
        let nudge = |mesh: &mut Mesh| mesh.points[corner][0] += 1e-12;
        assert_found(&part, nudge, "corner: no vertex at");
        assert_found(&part, nudge, "the part's chain from");
    }
}

#[test]
fn chain_vertices_off_their_chain_are_found() {
    for part in parts::all() {
        let chain = part.features.chains.iter().find(|chain| chain.vertices.len() > 3).unwrap();
        let vertex = chain.vertices[1] as usize;
        for k in 0..3 {
            // Along one axis at least that is not the chain's.
            let mut mesh = copied(&part);
            mesh.points[vertex][k] += 1e-6;
            let found = faults(&part, &mesh, 1e-5);
            let off = found.iter().any(|fault| fault.contains("off the part's chain"));
            let ends = [0, 2].map(|i| part.mesh.points[chain.vertices[i] as usize][k]);
            assert!(off || (ends[0] - ends[1]).abs() > 1e-3, "{}: {found:?}", part.name);
        }
    }
}

#[test]
fn a_vertex_that_went_astray_from_its_chain_is_found() {
    // The vertex stays where it is; the feature takes the way around a triangle, over its third corner.
    for part in parts::all().into_iter().filter(Part::is_labelled) {
        let chain = part.features.chains.iter().find(|chain| chain.vertices.len() > 4).unwrap();
        let edge = [chain.vertices[1], chain.vertices[2]];
        let beside = |mesh: &Mesh| mesh.triangles.iter().position(|t| edge.iter().all(|v| t.contains(v))).unwrap();
        let other = |label: i32| *chain.sides.iter().flatten().find(|&&side| side != label).unwrap_or(&label);
        let swap = |mesh: &mut Mesh| {
            let t = beside(mesh);
            mesh.triangle_labels[t] = other(mesh.triangle_labels[t]);
        };
        assert_found(&part, swap, "chain of");
        assert_found(&part, swap, "label: ");
        assert_found(&part, swap, "list: ");
    }
}

#[test]
fn a_feature_that_is_lost_is_found() {
    for part in parts::all() {
        let lost = part.features.chains.iter().position(|chain| chain.sides[0].is_some());
        let Some(lost) = lost else { continue };
        let sides = part.features.chains[lost].sides;
        let forget = |mesh: &mut Mesh| {
            if part.is_labelled() {
                let [from, to] = sides.map(Option::unwrap);
                mesh.triangle_labels.iter_mut().filter(|label| **label == from).for_each(|label| *label = to);
            } else {
                let keep: Vec<usize> =
                    (0..mesh.edges.len()).filter(|&i| mesh.edge_labels[i] as usize != lost + 1).collect();
                mesh.edges = keep.iter().map(|&i| mesh.edges[i]).collect();
                mesh.edge_labels = keep.iter().map(|&i| mesh.edge_labels[i]).collect();
                mesh.ridges.clear();
            }
        };
        assert_found(&part, forget, "the part's chain from");
    }
}

#[test]
fn an_edge_that_is_not_listed_is_found_and_so_is_one_too_many() {
    for part in parts::all() {
        let drop = |mesh: &mut Mesh| {
            mesh.edges.pop();
            mesh.edge_labels.pop();
            mesh.ridges.clear();
        };
        // Where edges are all that is known, the chain ends where no corner is.
        let is_border = part.features.chains.iter().any(|chain| chain.sides[0].is_none());
        assert_found(&part, drop, if part.is_labelled() || is_border { "list: " } else { "chain of" });
        let corner = |mesh: &mut Mesh| mesh.corners.clear();
        assert!(part.features.corners.is_empty() || !after(&part, corner).is_empty(), "{}", part.name);
        let ends = part.mesh.triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]]]).find(|ends| {
            let is_feature = |v: &u32| part.features.chains.iter().any(|chain| chain.vertices.contains(v));
            !ends.iter().any(is_feature)
        });
        let Some(ends) = ends else { continue };
        let add = |mesh: &mut Mesh| {
            mesh.edges.push(ends);
            mesh.edge_labels.push(1);
        };
        assert!(!after(&part, add).is_empty(), "{}", part.name);
    }
}

#[test]
fn edges_with_another_label_are_found() {
    for part in ["bracket", "patch"].map(part) {
        assert_found(&part, |mesh| mesh.edge_labels[5] += 1, "list: ");
    }
}

#[test]
fn flipped_and_missing_triangles_are_found() {
    for part in parts::all() {
        assert_found(&part, |mesh| mesh.triangles[7].swap(0, 1), "validity: ");
        let cut = |mesh: &mut Mesh| {
            mesh.triangles.remove(7);
            mesh.triangle_labels.remove(7);
        };
        assert_found(&part, cut, "topology: ");
    }
}

#[test]
fn a_mesh_inside_out_and_a_dent_are_found() {
    let cube = part("cube");
    assert_found(&cube, |mesh| mesh.triangles.iter_mut().for_each(|t| t.swap(0, 1)), "orientation: ");
    let inside =
        (0..cube.mesh.points.len()).find(|&v| cube.mesh.points[v].iter().filter(|x| **x % 1.0 == 0.0).count() == 1);
    let dent = |mesh: &mut Mesh| mesh.points[inside.unwrap()].iter_mut().for_each(|x| *x = 0.5 + 0.999 * (*x - 0.5));
    assert_found(&cube, dent, "distance: ");
}
