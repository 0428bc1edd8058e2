//! A hole's best triangulation without new vertices.

use crate::geometry::{Point3, Vector3};
use crate::mesh::unordered;
use crate::surface::build::has_area;

/// A closed curve of border edges, from each vertex to the next.
pub(super) struct Rim<'a> {
    pub(super) vertices: &'a [u32],
    pub(super) corners: &'a [Point3],
    /// The third corner of the triangle beside each edge.
    pub(super) apexes: &'a [Point3],
}

/// Triangles that meet at a sharper angle than this (between their normals: 150 degrees) are folded onto each other.
const FOLDED: f64 = -0.866;
/// The surface goes on straight over an edge where normals differ by less than this (60 degrees).
const STRAIGHT: f64 = 0.5;

/// Of all ways to triangulate a hole the one whose sharpest angle between neighbours, those beside the hole included, is
/// smallest, and of these the one of least area (Liepa 2003; the search is that of Barequet and Sharir 1995, of cubic
/// cost in the number of edges).
///
/// `None` if every way has a flat or a folded triangle, or an edge that is there already, or if the surface does not go on
/// straight over half of the rim at least: the end of a tube is no damage.
pub(super) fn fill(rim: &Rim, is_edge: impl Fn([u32; 2]) -> bool) -> Option<Vec<[u32; 3]>> {
    let n = rim.vertices.len();
    let mut table: Vec<Option<Part>> = vec![None; n * n];
    for span in 2..n {
        for i in 0..n - span {
            let k = i + span;
            if span < n - 1 && is_edge(unordered([rim.vertices[i], rim.vertices[k]])) {
                continue;
            }
            let ways = (i + 1..k).filter_map(|m| part(rim, &table, [i, m, k]));
            table[i * n + k] = ways.reduce(|best, way| if way.is_better(&best) { way } else { best });
        }
    }
    let mut triangles = Vec::new();
    let mut straight = 0;
    let mut left = vec![[0, n - 1]];
    while let Some([i, k]) = left.pop() {
        let m = table[i * n + k]?.middle;
        triangles.push([i, m, k]);
        for [p, q] in [[i, m], [m, k]] {
            if q - p > 1 {
                left.push([p, q]);
            } else {
                straight += usize::from(is_straight(rim, p, [i, m, k]));
            }
        }
    }
    let closing = [0, table[n - 1]?.middle, n - 1];
    straight += usize::from(is_straight(rim, n - 1, closing));
    (2 * straight >= n).then(|| triangles.iter().map(|t| t.map(|i| rim.vertices[i])).collect())
}

/// The best triangulation of a part of a hole, between two of its vertices.
#[derive(Clone, Copy)]
struct Part {
    /// The third corner of the triangle at the chord between the two.
    middle: usize,
    /// The least cosine of the angle between the normals of neighbours.
    cosine: f64,
    area: f64,
}

impl Part {
    fn is_better(&self, other: &Part) -> bool {
        self.cosine.total_cmp(&other.cosine).then(other.area.total_cmp(&self.area)).is_gt()
    }
}

fn part(rim: &Rim, table: &[Option<Part>], [i, m, k]: [usize; 3]) -> Option<Part> {
    let n = rim.vertices.len();
    let [p, q, r] = [i, m, k].map(|v| rim.corners[v]);
    if !has_area([p, q, r]) {
        return None;
    }
    let mut found = Part { middle: m, cosine: 1.0, area: (q - p).cross(r - p).norm() };
    for ([from, to], apex) in [([i, m], r), ([m, k], p)] {
        let beyond = if to - from == 1 {
            rim.apexes[from]
        } else {
            let part = table[from * n + to]?;
            found.cosine = found.cosine.min(part.cosine);
            found.area += part.area;
            rim.corners[part.middle]
        };
        found.cosine = found.cosine.min(cosine(rim.corners[from], rim.corners[to], apex, beyond));
    }
    if [i, k] == [0, n - 1] {
        found.cosine = found.cosine.min(cosine(r, p, q, rim.apexes[n - 1]));
    }
    (found.cosine > FOLDED).then_some(found)
}

fn is_straight(rim: &Rim, edge: usize, triangle: [usize; 3]) -> bool {
    let next = (edge + 1) % rim.vertices.len();
    let apex = triangle.into_iter().find(|&v| v != edge && v != next).unwrap_or(edge);
    cosine(rim.corners[edge], rim.corners[next], rim.corners[apex], rim.apexes[edge]) >= STRAIGHT
}

/// Of the angle between the normals of two triangles on both sides of the edge from p to q.
fn cosine(p: Point3, q: Point3, apex: Point3, beyond: Point3) -> f64 {
    let normal = |v: Vector3| v.unit().unwrap_or_default();
    normal((q - p).cross(apex - p)).dot(normal((beyond - p).cross(q - p)))
}
