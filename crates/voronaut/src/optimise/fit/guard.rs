//! Moves of vertices shortened until no triangle comes to harm, or to meet another one.

use super::samples::Sheet;
use crate::geometry::{Corners, Point3, Vector3, contacts};
use crate::lists::distinct;
use crate::parallel::prelude::*;
use crate::triangulation::{FaceId, VertexId};

/// What a mesh was like before anything moved, and the surface below it.
pub(super) struct Guard<'a> {
    surface: &'a Sheet<'a>,
    shapes: Vec<Shape>,
    /// Triangles that cross in the input, in order: they may go on doing so.
    crossing: Vec<[FaceId; 2]>,
}

/// What is asked of a triangle.
#[derive(Clone, Copy)]
struct Shape {
    /// 4 sqrt(3) area over the sum of the squares of its sides: 1 if equilateral, 0 of a line.
    quality: f64,
    /// Cosine of the angle between its normal and the surface's below its middle.
    facing: f64,
    /// A triangle of the surface near the middle's closest point.
    below: FaceId,
}

/// Positions after the moves.
pub(super) struct Limited {
    pub(super) positions: Vec<Point3>,
    /// How many vertices moved less than asked.
    pub(super) held_back: usize,
}

/// A triangle is a sliver below this quality ...
const SLIVER: f64 = 0.1;
/// ... and must not become one from more than this many times that.
const WORSE: f64 = 0.5;
/// Normals of mesh and surface must not come to differ by more than an angle of this cosine.
const FACING: f64 = 0.2;
/// A move is halved so many times before it is given up.
const HALVINGS: i32 = 4;

impl<'a> Guard<'a> {
    /// Notes the state of a mesh. `below` is a triangle of the surface near the middle of each triangle.
    pub(super) fn new(surface: &'a Sheet<'a>, mesh: &Sheet, below: impl Fn(FaceId) -> FaceId + Sync) -> Self {
        let slots: Vec<FaceId> = (0..mesh.topology.face_slots() as u32).map(FaceId).collect();
        let shapes = slots.par_iter().map(|&f| shape(surface, mesh, f, below(f))).collect();
        Self { surface, shapes, crossing: crossings(mesh, |_| true) }
    }

    /// Moves vertices, less far than asked where a triangle would fold, become a sliver or cross another one. Triangles of
    /// which no corner moves are as they were.
    pub(super) fn limit(&self, mesh: &Sheet, moves: &[Vector3]) -> Limited {
        let mut halvings = vec![0; moves.len()];
        let mut moved = mesh.clone();
        loop {
            for (v, position) in moved.positions.iter_mut().enumerate() {
                let share = if halvings[v] > HALVINGS { 0.0 } else { 0.5_f64.powi(halvings[v]) };
                *position = if share > 0.0 { mesh.positions[v] + moves[v] * share } else { mesh.positions[v] };
            }
            let harmed = self.harmed(mesh, &moved);
            if harmed.is_empty() {
                break;
            }
            let vertices = distinct(harmed.iter().flat_map(|&f| mesh.topology.corners(f)).map(VertexId::index));
            for v in vertices {
                halvings[v] += 1;
            }
        }
        let held_back = (0..moves.len()).filter(|&v| halvings[v] > 0 && moves[v] != Vector3::default()).count();
        Limited { positions: moved.positions, held_back }
    }

    /// Triangles with moved corners that are not as they should be; crossings are looked for when all shapes are right.
    fn harmed(&self, before: &Sheet, after: &Sheet) -> Vec<FaceId> {
        let has_moved = |f: FaceId| {
            let mut corners = before.topology.corners(f).into_iter();
            corners.any(|v| before.positions[v.index()] != after.positions[v.index()])
        };
        let faces: Vec<FaceId> = before.topology.faces().collect();
        let bad: Vec<FaceId> = faces.into_par_iter().filter(|&f| has_moved(f) && !self.is_well(after, f)).collect();
        if !bad.is_empty() {
            return bad;
        }
        let crossing = crossings(after, has_moved);
        let new = crossing.into_iter().filter(|pair| self.crossing.binary_search(pair).is_err());
        new.flatten().filter(|&f| has_moved(f)).collect()
    }

    fn is_well(&self, mesh: &Sheet, f: FaceId) -> bool {
        let was = &self.shapes[f.index()];
        let is = shape(self.surface, mesh, f, was.below);
        let is_sliver = is.quality < SLIVER && is.quality < WORSE * was.quality;
        is.facing.is_finite() && is.facing >= FACING.min(was.facing) && !is_sliver
    }
}

fn shape(surface: &Sheet, mesh: &Sheet, f: FaceId, below: FaceId) -> Shape {
    let [a, b, c] = mesh.triangle(f);
    let area_vector = mesh.area_vector(f);
    let squares: f64 = [b - a, c - b, a - c].iter().map(|e| e.dot(*e)).sum();
    let quality = 2.0 * 3.0_f64.sqrt() * area_vector.norm() / squares;
    let below = surface.descend(below, Point3::weighted([a, b, c], [1.0 / 3.0; 3])).face;
    let [own, other] = [area_vector, surface.area_vector(below)].map(|n| n.unit().unwrap_or_default());
    Shape { quality, facing: own.dot(other), below }
}

/// All pairs of triangles that meet, exactly ([`contacts`]), in order, the smaller number first; only pairs of which one at least is
/// `asked` for.
pub(super) fn crossings(sheet: &Sheet, asked: impl Fn(FaceId) -> bool + Sync) -> Vec<[FaceId; 2]> {
    let faces: Vec<FaceId> = sheet.topology.faces().collect();
    let corners = |&f: &FaceId| Corners { vertices: sheet.topology.corners(f).map(|v| v.0), points: sheet.triangle(f) };
    let met = contacts(&faces.iter().map(corners).collect::<Vec<_>>(), |i| asked(faces[i]));
    met.into_iter().map(|(pair, _)| pair.map(|i| faces[i])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifold::Manifold;
    use crate::manifold::surface::torus;
    use crate::triangulation::Triangulation;

    fn limited(mesh: &Manifold, surface: &Manifold, moves: &[Vector3]) -> Limited {
        let (own, other) = (Sheet::of(mesh), Sheet::of(surface));
        let below = |f| {
            let middle = Point3::weighted(mesh.triangle(f), [1.0 / 3.0; 3]);
            surface.closest_of_triangles(middle).unwrap().place.face
        };
        Guard::new(&other, &own, below).limit(&own, moves)
    }

    #[test]
    fn small_moves_are_free_and_those_across_a_neighbour_are_not() {
        let [mesh, surface] = [0.6, 0.2].map(|edge| Manifold::new(torus(2.0, 0.7, edge).unwrap(), None));
        let neighbour = mesh.topology().target(mesh.topology().start(VertexId(5)).unwrap());
        let across = mesh.positions()[neighbour.index()] - mesh.positions()[5];
        let moved = |part: f64| {
            let mut moves = vec![Vector3::default(); mesh.positions().len()];
            moves[5] = across * part;
            let found = limited(&mesh, &surface, &moves);
            let reached = found.positions[5].distance(mesh.positions()[5]) / across.norm();
            assert!((0..moves.len()).all(|v| v == 5 || found.positions[v] == mesh.positions()[v]));
            (found.held_back, reached)
        };
        assert_eq!(moved(0.25).0, 0);
        assert!((moved(0.25).1 - 0.25).abs() < 1e-14);
        let (held_back, reached) = moved(2.0);
        assert_eq!(held_back, 1);
        assert!(reached == 0.0 || (reached < 1.0 && reached > 0.0), "{reached}");
        // A hundred lengths away no halving is enough.
        assert_eq!(moved(100.0), (1, 0.0));
    }

    fn count(points: &[[f64; 3]], triangles: &[[u32; 3]]) -> usize {
        let topology = Triangulation::from_triangles(points.len(), triangles, &vec![0; triangles.len()]);
        let sheet = Sheet { topology: &topology, positions: points.iter().map(|&p| p.into()).collect() };
        let all = crossings(&sheet, |_| true);
        assert_eq!(all, crossings(&sheet, |f| f == FaceId(1)), "one asks for both");
        all.len()
    }

    #[test]
    fn triangles_pierce_touch_and_share_corners() {
        let ground = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
        let with = |other: [[f64; 3]; 3]| count(&[ground, other].concat(), &[[0, 1, 2], [3, 4, 5]]);
        assert_eq!(with([[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 9.0, 1.0]]), 1, "an edge through it");
        assert_eq!(with([[1.0, -1.0, -1.0], [1.0, -1.0, 1.0], [1.0, 1.0, 0.5]]), 1, "and its edge through the other");
        assert_eq!(with([[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [9.0, 9.0, 1.0]]), 1, "touches it");
        assert_eq!(with([[1.0, 1.0, 1e-300], [1.0, 1.0, 1.0], [9.0, 9.0, 1.0]]), 0, "is above it");
        assert_eq!(with([[1.0, 1.0, 0.0], [5.0, 1.0, 0.0], [5.0, 5.0, 0.0]]), 1, "lies on it in its plane");
        let fan = |other: [f64; 3], another: [f64; 3]| {
            count(&[&ground[..], &[other, another]].concat(), &[[0, 1, 2], [0, 3, 4]])
        };
        assert_eq!(fan([1.0, 1.0, 1.0], [1.0, 1.0, -1.0]), 1, "a corner in common, through it");
        assert_eq!(fan([1.0, 1.0, 1.0], [-1.0, -1.0, 1.0]), 0, "a corner in common");
    }
}
