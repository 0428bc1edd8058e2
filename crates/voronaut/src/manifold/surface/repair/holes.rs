//! Small holes that look like damage, and the best triangulation of one without new vertices.

use super::fans::Sewn;
use super::mended::Damage;
use super::work::Work;
use crate::geometry::{Aabb3, Point3, Vector3};
use crate::lists::{Classes, in_order};
use crate::manifold::surface::build::has_area;
use crate::mesh::edges::NONE;
use crate::mesh::{EdgeSide, Edges, Network, edges_of};
use std::collections::{HashMap, HashSet};

/// A hole with more edges than this is no small one.
const EDGES: usize = 12;
/// Its bounding box has at most this share of the diagonal of its component's.
const EXTENT: f64 = 0.5;

/// Closes small holes, if damage is to be repaired, and else counts them.
///
/// A border of at most twelve edges is a small hole if it is at most half as large as its component and can be filled so that
/// the surface goes on over it ([`fill`]). All others are borders that were meant.
pub(super) fn close(work: &mut Work, sewn: &mut Sewn) {
    let edges = Edges::of(&sewn.triangles);
    let borders: Vec<EdgeSide> = edges.boundary().collect();
    if borders.is_empty() {
        return;
    }
    let position = |v: u32| match (v as usize).checked_sub(work.mesh.points.len()) {
        Some(i) => sewn.added[i].0,
        None => work.position(v),
    };
    let sizes = component_sizes(work, sewn, &position);
    let mut chords: HashSet<[u32; 2]> = HashSet::new();
    let (mut patches, mut places) = (Vec::new(), Vec::new());
    let vertices = work.mesh.points.len() + sewn.added.len();
    for rim in loops(vertices, &borders).into_iter().filter(|rim| (3..=EDGES).contains(&rim.len())) {
        let corners: Vec<Point3> = rim.iter().map(|side| position(side.0)).collect();
        let size = Aabb3::of(corners.iter().copied()).map_or(0.0, |bounds| bounds.diagonal());
        if size > EXTENT * sizes[rim[0].1 as usize] {
            continue;
        }
        let vertices: Vec<u32> = rim.iter().map(|side| side.0).collect();
        let apexes = rim.iter().enumerate().map(|(i, side)| {
            let ends = [side.0, vertices[(i + 1) % vertices.len()]];
            sewn.triangles[side.1 as usize].into_iter().find(|v| !ends.contains(v)).map_or(corners[i], position)
        });
        let is_edge = |ends: [u32; 2]| !edges.at(ends).is_empty() || chords.contains(&ends);
        let rim_of = Rim { vertices: &vertices, corners: &corners, apexes: &apexes.collect::<Vec<_>>() };
        let Some(patch) = fill(&rim_of, is_edge) else { continue };
        chords.extend(patch.iter().copied().flat_map(edges_of).map(in_order));
        let number = sewn.numbers[rim[0].1 as usize].into_iter().find(|&v| v != NONE).unwrap_or(0);
        places.push(format!("{} edges at {}", rim.len(), work.vertex(number)));
        patches.push((patch, rim[0].1));
    }
    let kind = if work.options.repair { Damage::Closed } else { Damage::Open };
    for place in places {
        work.mended.add(kind, place);
    }
    for (patch, beside) in patches.into_iter().filter(|_| work.options.repair) {
        for triangle in patch {
            sewn.triangles.push(triangle);
            sewn.numbers.push([NONE; 3]);
            sewn.sources.push(sewn.sources[beside as usize]);
        }
    }
}

/// For each triangle the diagonal of its component's bounding box.
fn component_sizes(work: &Work, sewn: &Sewn, position: &impl Fn(u32) -> Point3) -> Vec<f64> {
    let mut parts = Classes::new(work.mesh.points.len() + sewn.added.len());
    for &[a, b, c] in &sewn.triangles {
        parts.join(a, b);
        parts.join(b, c);
    }
    parts.flatten();
    let mut bounds: HashMap<u32, Aabb3> = HashMap::new();
    for &v in sewn.triangles.as_flattened() {
        let p = position(v);
        let found = bounds.entry(parts.of(v)).or_insert(Aabb3 { min: p, max: p });
        *found = Aabb3::of([found.min, found.max, p]).unwrap_or(*found);
    }
    sewn.triangles.iter().map(|t| bounds[&parts.of(t[0])].diagonal()).collect()
}

/// The closed curves of the border: vertices in order, each with the triangle beside the edge to the next.
fn loops(vertices: usize, borders: &[EdgeSide]) -> Vec<Vec<(u32, u32)>> {
    let network = Network::new(vertices, borders.iter().map(|side| side.ends));
    let curve = |(mut v, edges): (u32, Vec<u32>)| {
        let step = |i| {
            let from = v;
            v = network.across(v, i);
            (from, borders[i as usize].half_edge / 3)
        };
        edges.into_iter().map(step).collect()
    };
    network.chains(|_| false).into_iter().map(curve).collect()
}

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
            if span < n - 1 && is_edge(in_order([rim.vertices[i], rim.vertices[k]])) {
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
