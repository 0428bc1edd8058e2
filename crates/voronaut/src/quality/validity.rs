//! Whether a mesh is a mesh: by counting and by exact predicates, never by a tolerance.

use super::curved::Jacobians;
use super::curved_boundary;
use super::embedding;
use super::faults::{Fault, duplicates, middle};
use super::meetings::{Excused, Meetings};
use super::self_intersections::{Pair, pairs};
use crate::error::{Error, Result};
use crate::geometry::{Orientation, Point, Point3, is_flat, orientation};
use crate::lists::distinct;
use crate::mesh::edges::{self, NONE};
use crate::mesh::{Edges, Mesh};
use crate::parallel::{join, prelude::*};

/// What was found in a mesh. `valid` means: at least one triangle, every figure marked (fault) is zero. Of curved triangles that is that none folds, and
/// that no two sides on the boundary meet but in their ends; whether one piece of the mesh lies on another is not told. On a surface they are seen each along
/// the normal of the straight triangle between its corners, and whether triangles meet is told of straight ones.
///
/// A mesh is that of a surface if some z is not 0: then `inverted` counts the triangles that are exactly flat. Where
/// numbers are out of range nothing else is looked at. Overlaps are not looked for where triangles are inverted or positions not
/// finite; in the plane, where there is any other fault.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Validity {
    /// Whether there is no fault.
    pub valid: bool,
    /// Triangles whose exact orientation is not counter-clockwise; flat ones count (fault).
    pub inverted: usize,
    /// Curved triangles whose Jacobian is not known to be positive everywhere, nor not to be somewhere (fault).
    #[serde(skip_serializing_if = "is_zero")]
    pub undecided: usize,
    /// Of a curved mesh: the least Jacobian is at least so much, in units of its mean in the same triangle; 1 of straight triangles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub least_jacobian: Option<f64>,
    /// Edges with more than two triangles, or with two that traverse it in the same direction (fault).
    pub non_manifold_edges: usize,
    /// Vertices of a surface whose triangles are not one fan, ends of edges that are not manifold among them (fault). 0 of a
    /// planar mesh, where regions may touch in a vertex.
    pub non_manifold_vertices: usize,
    /// Vertices that lie exactly where one with a smaller number lies (fault).
    pub duplicate_vertices: usize,
    /// Pairs of triangles that have more in common than a vertex or an edge of both, by exact predicates (fault). In the plane
    /// no more than one for each triangle: zero or not is what matters. Of curved triangles: pairs of sides on the boundary that meet, or
    /// are too close to tell.
    pub overlaps: usize,
    /// Vertex or edge numbers that do not exist, and label arrays of the wrong length (fault).
    pub out_of_range: usize,
    /// Vertices with a coordinate that is not finite (fault).
    pub not_finite: usize,
    /// Labelled edges that are no edge of a triangle (fault).
    pub stray_edges: usize,
    /// Vertices of no triangle.
    pub unused_vertices: usize,
    /// Closed curves of which the boundary consists.
    pub boundary_loops: usize,
    /// V - E + F over the vertices in use, the edges of triangles, and triangles.
    pub euler: isize,
    /// Euclidean area; signed on a planar mesh.
    pub area: f64,
    /// Of the mesh of a surface that meets itself: pairs of triangles, and of vertices, that meet where it does.
    pub meetings: Excused,
    /// The first fault, in the order of the checks.
    pub first_fault: Option<Fault>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
fn is_zero(count: &usize) -> bool {
    *count == 0
}

/// Examines a mesh in O(n log n). Never fails: what is wrong is in the answer.
pub fn validity(mesh: &Mesh) -> Validity {
    examine(mesh, None).0
}

/// As [`validity`], of the mesh of a surface: it may meet itself where the surface does, within the longest edge there, and
/// vertices may be at one position ([`Validity::meetings`]).
pub fn validity_on(mesh: &Mesh, surface: &Meetings) -> Validity {
    examined_on(mesh, surface).0
}

/// The same, and the triangles at which a surface has to be meshed anew, in order: those that are flat, have an edge or a vertex that is not
/// manifold, or meet another one where the surface does not meet itself.
pub(crate) fn examined_on(mesh: &Mesh, surface: &Meetings) -> (Validity, Vec<u32>) {
    examine(mesh, Some(surface))
}

fn examine(mesh: &Mesh, surface: Option<&Meetings>) -> (Validity, Vec<u32>) {
    let (mut found, mut faulty) = (Validity::default(), Vec::new());
    found.examine_numbers(mesh);
    if found.out_of_range == 0 {
        // A flat surface may face either way, and meet itself.
        let is_planar = surface.is_none() && mesh.is_planar();
        let (edges, duplicates) = join(|| Edges::of(&mesh.triangles), || duplicates(mesh));
        found.examine_vertices(mesh, duplicates, surface);
        if mesh.curved.is_none() || !is_planar {
            faulty.extend(found.examine_triangles(mesh, is_planar));
        }
        if mesh.curved.is_some() {
            found.examine_curved(mesh, is_planar);
        }
        if mesh.curved.is_some() && is_planar {
            found.examine_sides(mesh, &edges);
        }
        faulty.extend(found.examine_edges(mesh, &edges));
        if is_planar && mesh.curved.is_none() {
            if found.first_fault.is_none() {
                found.examine_embedding(mesh, &edges);
            }
        } else if !is_planar {
            let may_meet = found.inverted == 0 && found.not_finite == 0;
            let (met, split) =
                join(|| if may_meet { pairs(mesh) } else { Vec::new() }, || split_vertices(mesh, &edges));
            faulty.extend(found.examine_fans(mesh, &split));
            faulty.extend(found.examine_contacts(mesh, met, surface));
        }
    }
    found.valid = found.first_fault.is_none();
    (found, distinct(faulty))
}

/// Nothing for a valid mesh (see [`validity`]).
///
/// # Errors
/// [`Error::Mesh`] with the first fault of a mesh that is not valid.
pub fn check(mesh: &Mesh) -> Result<()> {
    validity(mesh).demand()
}

impl Validity {
    /// Nothing if the mesh is valid.
    ///
    /// # Errors
    /// [`Error::Mesh`] with the first fault.
    pub fn demand(&self) -> Result<()> {
        match self.first_fault.clone() {
            None => Ok(()),
            Some(Fault { what, place }) => {
                Err(Error::mesh(what, place, "repair the mesh there, or mesh its domain anew"))
            }
        }
    }

    fn fault(&mut self, what: impl Into<String>, place: impl Into<String>) {
        self.first_fault.get_or_insert_with(|| Fault { what: what.into(), place: place.into() });
    }

    /// A fault in the middle of some vertices.
    fn fault_at(&mut self, what: impl Into<String>, mesh: &Mesh, vertices: &[u32]) {
        if self.first_fault.is_none() {
            let at = middle(mesh, vertices);
            let planar = || Point::new(at.x, at.y).to_string();
            self.fault(what, if mesh.is_planar() { planar() } else { at.to_string() });
        }
    }

    fn examine_numbers(&mut self, mesh: &Mesh) {
        let vertices = mesh.points.len();
        self.examine_range("triangle", mesh.triangles.as_flattened(), 3, vertices);
        self.examine_range("edge", mesh.edges.as_flattened(), 2, vertices);
        self.examine_range("corner", &mesh.corners, 1, vertices);
        self.examine_range("required vertex", &mesh.required_points, 1, vertices);
        self.examine_range("required edge", &mesh.required_edges, 1, mesh.edges.len());
        self.examine_range("ridge", &mesh.ridges, 1, mesh.edges.len());
        self.examine_range("required triangle", &mesh.required_triangles, 1, mesh.triangles.len());
        for (name, labels, entries) in [
            ("vertices", mesh.point_labels.len(), vertices),
            ("triangles", mesh.triangle_labels.len(), mesh.triangles.len()),
            ("edges", mesh.edge_labels.len(), mesh.edges.len()),
        ] {
            if labels != entries {
                self.out_of_range += 1;
                self.fault(format!("{entries} {name} but {labels} labels of {name}"), "the arrays of labels");
            }
        }
        if mesh.triangles.is_empty() {
            self.fault("there are no triangles", "the array of triangles");
        }
    }

    fn examine_range(&mut self, name: &str, numbers: &[u32], per_entry: usize, limit: usize) {
        let mut wrong = numbers.iter().enumerate().filter(|&(_, &number)| number as usize >= limit);
        if let Some((index, &number)) = wrong.next() {
            self.out_of_range += 1 + wrong.count();
            let what = format!("number {} does not exist, the last is {limit}", u64::from(number) + 1);
            self.fault(what, format!("{name} {}", index / per_entry + 1));
        }
    }

    fn examine_vertices(&mut self, mesh: &Mesh, duplicates: Vec<[u32; 2]>, surface: Option<&Meetings>) {
        for (v, [x, y, z]) in (1..).zip(&mesh.points).filter(|(_, p)| !p.iter().all(|x| x.is_finite())) {
            self.not_finite += 1;
            self.fault(format!("vertex {v} is not finite"), format!("({x}, {y}, {z})"));
        }
        let reach = if duplicates.is_empty() || surface.is_none() { Vec::new() } else { longest_edges(mesh) };
        for [v, w] in duplicates {
            let at_both = || reach[v as usize].max(reach[w as usize]);
            if surface.is_some_and(|surface| surface.excuse(mesh.position(v), at_both(), false)) {
                self.meetings.add(mesh.position(v));
                continue;
            }
            self.duplicate_vertices += 1;
            let what = format!("vertices {} and {} are at the same position", v + 1, w + 1);
            self.fault_at(what, mesh, &[v]);
        }
        let used = mesh.used_vertices();
        self.unused_vertices = used.iter().filter(|&&used| !used).count();
    }

    /// Which are inverted or flat.
    fn examine_triangles(&mut self, mesh: &Mesh, planar: bool) -> Vec<u32> {
        let area = |&t: &[u32; 3]| {
            let ([a, b, c], [p, q, r]) = (mesh.corners_of(t), mesh.positions_of(t));
            0.5 * if planar { (b - a).cross(c - a) } else { (q - p).cross(r - p).norm() }
        };
        self.area = mesh.triangles.iter().map(area).sum();
        let wrong = |&t: &u32| {
            let [a, b, c] = mesh.triangles[t as usize];
            let [p, q, r] = mesh.corners_of([a, b, c]);
            let is_wrong = || orientation(p, q, r) != Orientation::Left;
            a == b || b == c || c == a || if planar { is_wrong() } else { is_flat(mesh.positions_of([a, b, c])) }
        };
        let inverted: Vec<u32> = (0..mesh.triangles.len() as u32).into_par_iter().filter(wrong).collect();
        self.inverted = inverted.len();
        if let Some(&t) = inverted.first() {
            let corners = mesh.triangles[t as usize];
            let [a, b, c] = corners.map(|v| u64::from(v) + 1);
            let what = format!("triangle {} (vertices {a} {b} {c}) is inverted or flat", t + 1);
            self.fault_at(what, mesh, &corners);
        }
        inverted
    }

    fn examine_curved(&mut self, mesh: &Mesh, is_planar: bool) {
        if let Err(error) = mesh.check_numbers() {
            self.out_of_range += 1;
            return self.fault(error.to_string(), "the nodes of curved triangles");
        }
        let found = Jacobians::of(mesh, is_planar);
        (self.inverted, self.undecided) = (self.inverted + found.inverted.len(), found.undecided.len());
        self.least_jacobian = Some(found.least);
        if is_planar {
            self.area = found.area;
        }
        for (wrong, what) in
            [(found.inverted, "folds"), (found.undecided, "may fold: its Jacobian comes too near zero")]
        {
            if let Some(&t) = wrong.first() {
                self.fault_at(format!("curved triangle {} {what}", t + 1), mesh, &mesh.triangles[t]);
            }
        }
    }

    /// Whether sides of curved triangles on the boundary meet.
    fn examine_sides(&mut self, mesh: &Mesh, edges: &Edges) {
        let meetings = curved_boundary::meetings(mesh, edges);
        self.overlaps = meetings.len();
        if let Some(&[[a, b], [c, d]]) = meetings.first() {
            let what = format!("the sides {}-{} and {}-{} on the boundary meet", a + 1, b + 1, c + 1, d + 1);
            self.fault_at(what, mesh, &[a, b, c, d]);
        }
    }

    /// Triangles with an edge that is not manifold.
    fn examine_edges(&mut self, mesh: &Mesh, edges: &Edges) -> Vec<u32> {
        let used = mesh.points.len() - self.unused_vertices;
        let count = || (edges.ends().count(), edges.not_manifold().collect::<Vec<_>>());
        let ((count, wrong), loops) = join(count, || boundary_loops(edges));
        (self.euler, self.boundary_loops) =
            (used.cast_signed() - count.cast_signed() + mesh.triangles.len().cast_signed(), loops);
        for sides in &wrong {
            self.non_manifold_edges += 1;
            let ([a, b], count) = (sides[0].ends, sides.len());
            let what =
                format!("edge {} {} is not manifold: {count} triangles, or the same direction twice", a + 1, b + 1);
            self.fault_at(what, mesh, &[a, b]);
        }
        for (number, &[a, b]) in (1..).zip(&mesh.edges).filter(|(_, [a, b])| edges.at([*a, *b]).is_empty()) {
            self.stray_edges += 1;
            let what = format!("labelled edge {number} (vertices {} {}) is no edge of a triangle", a + 1, b + 1);
            self.fault_at(what, mesh, &[a, b]);
        }
        wrong.into_iter().flatten().map(|side| side.triangle() as u32).collect()
    }

    /// Triangles at vertices that are split.
    fn examine_fans(&mut self, mesh: &Mesh, split: &[u32]) -> Vec<u32> {
        for &v in split {
            self.non_manifold_vertices += 1;
            self.fault_at(format!("the triangles around vertex {} are not one fan", v + 1), mesh, &[v]);
        }
        let has_split = |t: &[u32; 3]| !split.is_empty() && t.iter().any(|v| split.binary_search(v).is_ok());
        (0..).zip(&mesh.triangles).filter(|(_, t)| has_split(t)).map(|(i, _)| i).collect()
    }

    /// Triangles that meet where the surface does not meet itself.
    fn examine_contacts(&mut self, mesh: &Mesh, met: Vec<Pair>, surface: Option<&Meetings>) -> Vec<u32> {
        let mut faulty = Vec::new();
        for pair in met {
            if surface.is_some_and(|surface| pair.is_excused(mesh, surface)) {
                self.meetings.add(pair.at);
                continue;
            }
            self.overlaps += 1;
            self.first_fault.get_or_insert(pair.fault());
            faulty.extend(pair.triangles.map(|t| t as u32));
        }
        faulty
    }

    fn examine_embedding(&mut self, mesh: &Mesh, edges: &Edges) {
        let overlaps = embedding::overlaps(mesh, edges);
        self.overlaps = overlaps.len();
        if let Some(&[t, u]) = overlaps.first() {
            self.fault_at(format!("triangles {} and {} overlap or touch", t + 1, u + 1), mesh, &mesh.triangles[t]);
        }
    }
}

/// Cycles of the boundary: from each boundary half-edge on through the fan of triangles at its end.
fn boundary_loops(edges: &Edges) -> usize {
    if edges.boundary().next().is_none() {
        return 0;
    }
    let twins = edges.twins();
    let mut seen = vec![false; twins.len()];
    let mut loops = 0;
    for start in edges.boundary() {
        let mut half_edge = start.half_edge;
        loops += usize::from(!seen[half_edge as usize]);
        while !std::mem::replace(&mut seen[half_edge as usize], true) {
            half_edge = edges::next(half_edge);
            while twins[half_edge as usize] != NONE {
                half_edge = edges::next(twins[half_edge as usize]);
            }
        }
    }
    loops
}

/// Vertices with triangles that cannot be reached from another one of theirs across edges at the vertex.
fn split_vertices(mesh: &Mesh, edges: &Edges) -> Vec<u32> {
    let fans = edges::fans(&edges.twins(), |_, _| false);
    edges::vertices_of_several(&fans, mesh.triangles.as_flattened())
}

/// For each vertex the longest edge of its triangles.
fn longest_edges(mesh: &Mesh) -> Vec<f64> {
    let mut found = vec![0.0_f64; mesh.points.len()];
    for &t in &mesh.triangles {
        let length = Point3::longest_side(mesh.positions_of(t));
        for v in t {
            let known = &mut found[v as usize];
            *known = known.max(length);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::test_meshes::{fan, grid, lattice, mesh, with_hole};
    use super::*;

    #[test]
    fn two_triangles_are_valid() {
        let found = validity(&grid(1, 1));
        assert!(found.valid, "{found:?}");
        assert_eq!((found.euler, found.boundary_loops, found.area), (1, 1, 1.0));
    }

    #[test]
    fn a_hole_lowers_the_euler_number() {
        let found = validity(&with_hole());
        assert!(found.valid, "{found:?}");
        assert_eq!((found.euler, found.boundary_loops, found.area), (0, 2, 8.0));
    }

    #[test]
    fn scale_does_not_matter() {
        for scale in [1e-9, 1e-3, 1e9] {
            let mut scaled = lattice(12);
            scaled.points.iter_mut().for_each(|p| *p = p.map(|x| x * scale));
            assert!(validity(&scaled).valid);
        }
    }

    #[test]
    fn folded_mesh_is_inverted() {
        let folded = mesh(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.2, 0.2]], &[[0, 1, 2], [2, 1, 3]]);
        let found = validity(&folded);
        assert_eq!((found.valid, found.inverted), (false, 1));
        assert!(check(&folded).unwrap_err().to_string().contains("triangle 2"), "{:?}", check(&folded));
    }

    #[test]
    fn fan_around_a_vertex_turns_once() {
        assert!(validity(&fan(7, 1)).valid);
        assert!(validity(&fan(3, 1)).valid);
        let found = validity(&fan(7, 2));
        assert_eq!((found.valid, found.inverted, found.overlaps > 0), (false, 0, true), "{found:?}");
    }

    #[test]
    fn repeated_directions_and_third_triangles_are_not_manifold() {
        let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.2, 0.9], [0.5, -1.0]];
        assert_eq!(validity(&mesh(&points, &[[0, 1, 2], [0, 1, 3]])).non_manifold_edges, 1);
        assert_eq!(validity(&mesh(&points, &[[0, 1, 2], [0, 1, 3], [1, 0, 4]])).non_manifold_edges, 1);
        assert_eq!(validity(&mesh(&points, &[[0, 1, 2], [0, 1, 2]])).non_manifold_edges, 3);
    }

    #[test]
    fn duplicates_are_found_by_value() {
        let doubled = mesh(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [-0.0, 0.0], [0.0, 0.0]], &[[0, 1, 2]]);
        let found = validity(&doubled);
        assert_eq!((found.valid, found.duplicate_vertices, found.unused_vertices), (false, 2, 2));
    }

    #[test]
    fn broken_numbers_are_faults_not_panics() {
        let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        assert!(!validity(&Mesh::default()).valid);
        assert_eq!(validity(&mesh(&points, &[[0, 1, 3]])).out_of_range, 1);
        assert_eq!(validity(&mesh(&points, &[[0, 1, u32::MAX]])).out_of_range, 1);
        assert_eq!(validity(&mesh(&points, &[[0, 1, 1]])).inverted, 1);
        let found = validity(&mesh(&[[0.0, 0.0], [f64::NAN, 0.0], [0.0, f64::INFINITY]], &[[0, 1, 2]]));
        assert_eq!((found.valid, found.not_finite), (false, 2));
        let mut unlabelled = grid(1, 1);
        unlabelled.triangle_labels.clear();
        assert_eq!(validity(&unlabelled).out_of_range, 1);
        let mut stray = grid(1, 1);
        (stray.edges, stray.edge_labels) = (vec![[1, 2], [0, 3], [0, 1]], vec![1; 3]);
        assert_eq!(validity(&stray).stray_edges, 1);
    }

    #[test]
    fn surfaces_are_examined_for_topology() {
        let mut roof = grid(1, 1);
        roof.points[3][2] = 1.0;
        let found = validity(&roof);
        assert!(found.valid, "{found:?}");
        assert!(found.area > 1.0);
    }
}
