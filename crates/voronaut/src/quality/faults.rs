//! What is wrong with a mesh, and where: faults and their places, vertices at one position, segments to be found by place.

use crate::geometry::{Aabb, BoxTree, Point, Point3};
use crate::mesh::Mesh;
use crate::parallel::prelude::*;
use std::fmt;

/// What is wrong, and where.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Fault {
    /// What, with numbers from 1 as in files.
    pub what: String,
    /// Coordinates, or an entry of an array.
    pub place: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} at {}", self.what, self.place)
    }
}

/// A place: two coordinates on a planar mesh, three on a surface.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[serde(untagged)]
pub enum Position {
    /// x and y.
    Plane([f64; 2]),
    /// x, y and z.
    Space([f64; 3]),
}

impl Position {
    /// The coordinates in order.
    pub fn coordinates(&self) -> &[f64] {
        match self {
            Position::Plane(at) => at,
            Position::Space(at) => at,
        }
    }

    /// x and y of a point.
    pub(super) fn in_plane(p: Point3) -> Self {
        Position::Plane([p.x, p.y])
    }
}

impl From<Point3> for Position {
    fn from(p: Point3) -> Self {
        Position::Space(p.to_array())
    }
}

/// The middle of some vertices.
pub(super) fn middle(mesh: &Mesh, vertices: &[u32]) -> Point3 {
    let sum = |axis: usize| vertices.iter().map(|&v| mesh.points[v as usize][axis]).sum::<f64>();
    Point3::from([0, 1, 2].map(|axis| sum(axis) / vertices.len() as f64))
}

/// Vertices that lie exactly where one with a smaller number lies, behind that one; finite ones.
pub(super) fn duplicates(mesh: &Mesh) -> Vec<[u32; 2]> {
    let mut sorted: Vec<([u64; 3], u32)> =
        (0..).zip(&mesh.points).filter(|(_, p)| is_finite(p)).map(|(v, p)| (bits(*p), v)).collect();
    sorted.par_sort_unstable();
    sorted.windows(2).filter(|pair| pair[0].0 == pair[1].0).map(|pair| [pair[0].1, pair[1].1]).collect()
}

/// The longest edge of a triangle.
pub(super) fn longest([a, b, c]: [Point3; 3]) -> f64 {
    a.distance(b).max(b.distance(c)).max(c.distance(a))
}

/// Whether all coordinates are numbers.
pub(super) fn is_finite(p: &[f64; 3]) -> bool {
    p.iter().all(|x| x.is_finite())
}

/// Equal for equal coordinates: 0 and -0 are the same place.
fn bits(p: [f64; 3]) -> [u64; 3] {
    p.map(|x| (x + 0.0).to_bits())
}

/// A segment with a number to know it by.
pub(crate) struct Piece {
    pub(crate) a: Point,
    pub(crate) b: Point,
    pub(crate) id: u32,
}

impl Piece {
    /// The point of the segment (as a closed set) nearest to `p`.
    fn nearest(&self, p: Point) -> Point {
        let found = p.nearest_between(self.a, self.b);
        // It is not if the segment has no length.
        if found.is_finite() { found } else { self.a }
    }
}

/// Segments that can be searched by place.
pub(crate) struct Segments {
    tree: BoxTree<Piece, 2>,
}

impl Segments {
    /// An index of segments, numbered in their order; all coordinates are finite.
    pub(crate) fn new(segments: impl Iterator<Item = [Point; 2]>) -> Self {
        let boxed = |(id, [a, b]): (u32, [Point; 2])| Some((Aabb::of([a, b])?.into(), Piece { a, b, id }));
        Self { tree: BoxTree::new((0..).zip(segments).filter_map(boxed)) }
    }

    /// The pieces whose bounding box meets a box (both closed).
    pub(crate) fn meeting(&self, bounds: Aabb) -> impl Iterator<Item = &Piece> {
        self.tree.meeting(bounds.into())
    }

    /// The largest coordinate x of any piece.
    pub(crate) fn right_end(&self) -> f64 {
        self.tree.bounds().map_or(f64::NEG_INFINITY, |bounds| bounds[1][0])
    }

    /// Euclidean distance from a point to the nearest piece; `None` where there is no piece.
    pub(crate) fn distance(&self, p: Point) -> Option<f64> {
        let nearest = self.tree.nearest([p.x, p.y], |piece| {
            let away = p - piece.nearest(p);
            away.dot(away)
        });
        nearest.map(|piece| piece.nearest(p).distance(p))
    }
}
