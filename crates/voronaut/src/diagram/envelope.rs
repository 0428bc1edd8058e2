//! The nerve below the size of the canvas: Voronoi vertices within faces.
//!
//! On a flat face, the squares of the distances to two seeds differ by a linear function. With the distances from every
//! nearby seed at the three vertices of a face, the cells within it are thus the lower envelope of as many linear
//! functions, whatever the size of the face: the Voronoi vertices in it need not be separated by canvas vertices, and each is
//! found with its place. On a curved canvas this holds to second order in the size of the face.

use super::nerve::{Nerve, NerveEdge, NerveTriangle};
use super::overlap::Overlap;
use super::{Diagram, Ground};
use crate::parallel::prelude::*;
use crate::triangulation::{FaceId, HalfEdge, VertexId, smallest_first};

/// A Voronoi vertex this far (barycentric) outside a face still counts: it may lie on the edge.
const ON_EDGE: f64 = 1e-9;
/// Colours looked at in one face at most, the nearest.
const COLOURS: usize = 12;

/// A colour near a face and its squared distances from the face's vertices.
#[derive(Clone, Copy)]
pub(super) struct Near<const N: usize> {
    pub(super) colour: u32,
    pub(super) squares: [f64; N],
}

impl<const N: usize> Near<N> {
    fn at(&self, weights: [f64; N]) -> f64 {
        self.squares.iter().zip(weights).map(|(square, weight)| square * weight).sum()
    }
}

impl<'a, G: Ground<'a>> Diagram<'a, G> {
    /// The nerve of the cells with their borders drawn within canvas faces: exact on a flat canvas, where
    /// [`Diagram::nerve`] needs witnesses among whole faces. Distances are computed anew around every cell.
    pub(crate) fn sharp_nerve(&self) -> Nerve {
        let overlap = self.overlap();
        let topology = self.ground.topology();
        let faces: Vec<FaceId> = topology.faces().collect();
        let triangles: Vec<NerveTriangle> =
            faces.par_iter().with_min_len(1024).flat_map_iter(|&f| self.vertices_in(overlap, f)).collect();
        let edges: Vec<HalfEdge> = topology.edges().collect();
        let pairs: Vec<NerveEdge> =
            edges.par_iter().with_min_len(1024).flat_map_iter(|&h| self.borders_on(overlap, h)).collect();
        Nerve::new(self.coloured_vertices(), pairs, triangles)
    }

    /// The Voronoi vertices in a face.
    fn vertices_in(&self, overlap: &Overlap, witness: FaceId) -> Vec<NerveTriangle> {
        let near = near(overlap, self.ground.topology().corners(witness));
        let mut found = Vec::new();
        for i in 0..near.len() {
            for j in 0..i {
                for k in 0..j {
                    let Some((weights, turn)) = meeting([&near[k], &near[j], &near[i]]) else { continue };
                    if weights.iter().any(|&w| w < -ON_EDGE) {
                        continue;
                    }
                    let level = near[i].at(weights);
                    let others = near.iter().enumerate().filter(|(n, _)| ![i, j, k].contains(n));
                    let gaps = others.map(|(_, other)| (other.colour, other.at(weights) / level - 1.0));
                    let fourth = gaps.min_by(|a, b| a.1.total_cmp(&b.1));
                    if fourth.is_none_or(|(_, gap)| gap >= 0.0) {
                        let [a, b, c] = [near[k].colour, near[j].colour, near[i].colour];
                        let colours = smallest_first(if turn > 0.0 { [a, b, c] } else { [a, c, b] });
                        let square = Some(level);
                        found.push(NerveTriangle { colours, witness, witnesses: 1, fourth, square });
                    }
                }
            }
        }
        found
    }

    /// The pairs of cells whose border crosses an edge.
    fn borders_on(&self, overlap: &Overlap, h: HalfEdge) -> Vec<NerveEdge> {
        let topology = self.ground.topology();
        let near = near(overlap, topology.ends(h));
        let border = topology.twin(h).is_none().then_some(h);
        let mut found = Vec::new();
        for i in 0..near.len() {
            for j in 0..i {
                let [p, q] = [0, 1].map(|end| near[i].squares[end] - near[j].squares[end]);
                if (p < 0.0) == (q < 0.0) {
                    continue;
                }
                let t = p / (p - q);
                let weights = [1.0 - t, t];
                let level = near[i].at(weights).min(near[j].at(weights));
                let is_lowest = (0..near.len()).all(|n| n == i || n == j || near[n].at(weights) >= level);
                if is_lowest {
                    let (a, b) = (near[i].colour, near[j].colour);
                    found.push(NerveEdge { colours: [a.min(b), a.max(b)], witness: h, border });
                }
            }
        }
        found
    }
}

/// The colours that may be the nearest somewhere between the vertices; empty where one is the nearest at all of them.
fn near<const N: usize>(overlap: &Overlap, vertices: [VertexId; N]) -> Vec<Near<N>> {
    let least = vertices.map(|v| overlap.nearest(v));
    if least.iter().all(|nearest| *nearest == least[0]) {
        return Vec::new();
    }
    let seen = |&(colour, _): &(u32, f64)| {
        let found = vertices.map(|v| overlap.distance(v, colour));
        let squares = found.map(|d| d.unwrap_or(f64::INFINITY).powi(2));
        found.iter().all(Option::is_some).then_some(Near { colour, squares })
    };
    let near: Vec<Near<N>> = overlap.at(vertices[0]).iter().filter_map(seen).collect();
    undominated(&near)
}

/// Leaves out what another colour beats at every vertex, and all but the nearest few.
fn undominated<const N: usize>(near: &[Near<N>]) -> Vec<Near<N>> {
    let beats = |a: &Near<N>, b: &Near<N>| a.squares.iter().zip(b.squares).all(|(&x, y)| x < y);
    let mut kept: Vec<Near<N>> = near.iter().filter(|n| !near.iter().any(|other| beats(other, n))).copied().collect();
    if kept.len() > COLOURS {
        let least = |n: &Near<N>| n.squares.iter().copied().fold(f64::INFINITY, f64::min);
        kept.sort_by(|a, b| least(a).total_cmp(&least(b)).then(a.colour.cmp(&b.colour)));
        kept.truncate(COLOURS);
    }
    kept.sort_unstable_by_key(|n| n.colour);
    kept
}

/// Where three linear functions meet, in barycentric coordinates, and how the colours turn around that place: positive for
/// counter-clockwise.
pub(super) fn meeting([a, b, c]: [&Near<3>; 3]) -> Option<([f64; 3], f64)> {
    // (b - a) and (c - a) vanish: the weights are their cross product, scaled to sum one.
    let u: [f64; 3] = std::array::from_fn(|i| b.squares[i] - a.squares[i]);
    let v: [f64; 3] = std::array::from_fn(|i| c.squares[i] - a.squares[i]);
    let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let sum = cross[0] + cross[1] + cross[2];
    let weights = cross.map(|w| w / sum);
    // In the coordinates (weight 1, weight 2) the gradients' cross product is that same sum; seeds lie against gradients.
    weights.iter().all(|w| w.is_finite()).then_some((weights, sum))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_seeds_meet_at_their_circumcentre() {
        let seeds = [(0.0, 0.0), (2.0, 0.0), (0.0, 2.0)];
        let corners = [(0.5, 0.4), (1.9, 0.7), (0.8, 1.8)];
        let near = |i: usize| {
            let (x, y): (f64, f64) = seeds[i];
            Near { colour: i as u32, squares: corners.map(|(p, q)| (p - x) * (p - x) + (q - y) * (q - y)) }
        };
        let (weights, turn) = meeting([&near(0), &near(1), &near(2)]).unwrap();
        let x: f64 = weights.iter().zip(corners).map(|(w, c)| w * c.0).sum();
        let y: f64 = weights.iter().zip(corners).map(|(w, c)| w * c.1).sum();
        assert!((x - 1.0).abs() < 1e-14 && (y - 1.0).abs() < 1e-14, "{x} {y}");
        assert!(turn > 0.0 && meeting([&near(0), &near(2), &near(1)]).unwrap().1 < 0.0);
        assert!(meeting([&near(0), &near(0), &near(2)]).is_none(), "no place of its own");
    }
}
