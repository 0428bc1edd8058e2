//! Vertices at one position, and how long edges are.

use crate::geometry::Point3;
use crate::mesh::Mesh;
use crate::parallel::prelude::*;

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
