//! What tells whether four seeds are on the right side of each other's circles.

use super::Known;
use crate::geodesic::{Margin, PathLength};
use crate::geometry::Vector;
use std::collections::HashMap;

/// Number of levels at most: one tensor for the quadrilateral; lengths from the expansions at the seeds; geodesics with 4, 8
/// and 16 modes; the circumcentre with geodesics of 8 and of 16 modes. On a surface geodesics are of one kind.
pub const LEVELS: usize = 7;
/// Where the margin is known this well and still may be zero, four seeds count as being on a circle.
pub(super) const RESOLUTION: f64 = 1e-9;

/// The best lengths known, by their ends, the smaller first.
pub type Lengths = HashMap<(u32, u32), Known>;

/// Seeds of the plane in a metric field, or of a surface: all that a triangulation knows of where they are.
pub trait Judge: Sync {
    /// Whether there is such a seed, and a metric there.
    fn is_seed(&self, i: u32) -> bool;
    /// The direction of a seed seen from another, in a frame there.
    fn direction(&self, from: u32, to: u32) -> Vector;
    /// The squared circumradius of a triangle, roughly, in the metric there; infinite where it is turned over.
    fn size(&self, triangle: [u32; 3]) -> f64;
    /// Whether a loop of seeds turns so that there are triangles missing within it.
    fn encloses(&self, outline: &[u32]) -> bool;
    /// Whether a level can add to what is known of an edge, which the given level settled so far.
    fn may_tell(&self, quad: &Quad, level: usize, lengths: &Lengths, settled: Option<usize>) -> bool;
    /// Whether a level asks for the lengths that quadrilaterals lack.
    fn is_by_lengths(&self, level: usize) -> bool;
    /// The length between two seeds at such a level.
    fn solve(&self, i: u32, j: u32, level: usize) -> Option<Known>;
    /// The outcome of the test at a level.
    fn margin(&self, quad: &Quad, level: usize, lengths: &Lengths) -> Margin;
    /// The greatest error of a margin whose sign is followed although it is not certain.
    fn doubt(&self) -> f64;
}

/// The four seeds around an edge a-b: c to the left, d to the right of a -> b.
#[derive(Clone, Copy)]
pub struct Quad {
    /// One end.
    pub a: u32,
    /// The other.
    pub b: u32,
    /// To its left.
    pub c: u32,
    /// To its right.
    pub d: u32,
}

impl Quad {
    /// The pairs a-b, a-c, b-c, a-d, b-d.
    pub fn pairs(&self) -> [(u32, u32); 5] {
        let Quad { a, b, c, d } = *self;
        [(a, b), (a, c), (b, c), (a, d), (b, d)].map(|(i, j): (u32, u32)| (i.min(j), i.max(j)))
    }

    /// The five lengths, if they are known and of geodesics: ways around holes make no triangles that a test could use.
    pub(super) fn lengths(&self, known: &Lengths) -> Option<[PathLength; 5]> {
        let length = |pair| known.get(&pair).filter(|known| !known.is_vetoed).map(|known| known.length);
        let found = self.pairs().map(length);
        let [Some(ab), Some(ac), Some(bc), Some(ad), Some(bd)] = found else { return None };
        Some([ab, ac, bc, ad, bd])
    }
}
