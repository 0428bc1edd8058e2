//! Refinement in the plane: the metrically longest edge is halved, and the metric's flips follow, again and again.
//!
//! Everything here happens in the embedded triangulation, before any flip by lengths: a point on a straight edge has
//! coordinates, one on a flipped edge has none.

use super::CanvasCounters;
use super::buckets::Buckets;
use super::steiner::Steiner;
use crate::error::Result;
use crate::geodesic::chord_near;
use crate::geometry::Point;
use crate::metric::MetricField;
use crate::planar::Planar;
use crate::triangulation::{HalfEdge, VertexId};

/// Where edges begin to be measured by one evaluation, if nothing is known of the field.
pub(crate) const COARSE: usize = 20_000;
/// Ends agree on an edge's length if they differ by less than this share of their sum.
const ALIKE: f64 = 0.05;
/// A fixed edge that the middle of another sees under an angle with a cosine below this is halved first.
const CREEPING: f64 = -0.99;
/// Faces no higher than this share of their coordinates are flat.
const ROUNDING: f64 = 1e-15;

/// Refines until there are `vertices` vertices. Edges are measured by five evaluations of the field while there are fewer than `coarse`, by
/// one from then on: long edges may hide in their middle what their ends do not tell.
///
/// # Errors
/// The metric is not positive definite at a vertex.
pub(super) fn refine(
    planar: Planar,
    field: &dyn MetricField,
    coarse: usize,
    vertices: usize,
    counters: &mut CanvasCounters,
) -> Result<Planar> {
    let mut refiner = Refiner::new(planar, field, coarse)?;
    for h in refiner.steiner.planar.topology.edges().collect::<Vec<_>>() {
        refiner.enqueue(h);
    }
    while refiner.steiner.planar.topology.vertex_count() < vertices {
        let Some([a, b]) = refiner.queue.pop() else { break };
        if let Some(h) = refiner.steiner.planar.topology.edge_between(a, b) {
            refiner.split(h, counters)?;
        }
    }
    Ok(refiner.steiner.planar)
}

/// Halves edges, given by their ends, with the flips that follow; an edge that a flip has taken away is passed over.
///
/// # Errors
/// The metric is not positive definite at a vertex.
pub(super) fn halve(
    planar: Planar,
    field: &dyn MetricField,
    edges: &[[VertexId; 2]],
    counters: &mut CanvasCounters,
) -> Result<Planar> {
    let mut refiner = Refiner::new(planar, field, COARSE)?;
    for &[a, b] in edges {
        if let Some(h) = refiner.steiner.planar.topology.edge_between(a, b) {
            refiner.split(h, counters)?;
        }
    }
    Ok(refiner.steiner.planar)
}

struct Refiner<'a> {
    steiner: Steiner<'a>,
    field: &'a dyn MetricField,
    queue: Buckets<[VertexId; 2]>,
    coarse: usize,
}

impl<'a> Refiner<'a> {
    fn new(planar: Planar, field: &'a dyn MetricField, coarse: usize) -> Result<Self> {
        Ok(Self { steiner: Steiner::metric(planar, field)?, field, queue: Buckets::default(), coarse })
    }

    /// Halves an edge, or first the fixed edge beside it that its middle encroaches: else new vertices creep ever closer
    /// to a border that they see under a small angle.
    fn split(&mut self, h: HalfEdge, counters: &mut CanvasCounters) -> Result<()> {
        let [a, b] = self.steiner.planar.topology.ends(h);
        if let Some(fixed) = self.encroached(h)
            && self.halve(fixed, counters)?
        {
            if let Some(h) = self.steiner.planar.topology.edge_between(a, b) {
                self.enqueue(h);
            }
            return Ok(());
        }
        self.halve(h, counters).map(drop)
    }

    /// The fixed edge of a face beside an edge that the edge's middle nearly lies on.
    fn encroached(&self, h: HalfEdge) -> Option<HalfEdge> {
        let topology = &self.steiner.planar.topology;
        if topology.is_fixed(h) {
            return None;
        }
        let [p, q] = self.steiner.planar.ends(h);
        let middle = p.midpoint(q);
        let tensor =
            (self.steiner.tensors[topology.origin(h).index()] + self.steiner.tensors[topology.target(h).index()]) * 0.5;
        let is_near = |e: &HalfEdge| {
            let [a, b] = self.steiner.planar.ends(*e);
            let (u, v) = (a - middle, b - middle);
            topology.is_fixed(*e) && tensor.dot(u, v) < CREEPING * tensor.length(u) * tensor.length(v)
        };
        topology.sides(h).flat_map(|side| [side.next(), side.prev()]).find(is_near)
    }

    /// Halves an edge, flips around the new vertex, and queues the edges there; whether it did. An edge whose middle rounding has
    /// put beyond a neighbour stays whole, and so does one beside a face that is flat but for rounding.
    fn halve(&mut self, h: HalfEdge, counters: &mut CanvasCounters) -> Result<bool> {
        if is_beside_flat(&self.steiner.planar, h) {
            return Ok(false);
        }
        let [p, q] = self.steiner.planar.ends(h);
        let Some(v) = self.steiner.planar.insert_on_edge(h, p.midpoint(q)) else { return Ok(false) };
        counters.splits += 1;
        counters.planar_flips += self.steiner.added(v, Some(v))?;
        let spokes: Vec<HalfEdge> = self.steiner.planar.topology.spokes(v).collect();
        for h in spokes {
            self.enqueue(h);
        }
        Ok(true)
    }

    fn enqueue(&mut self, h: HalfEdge) {
        let ends = self.steiner.planar.topology.ends(h);
        let [p, q] = self.steiner.planar.ends(h);
        let length = if self.steiner.planar.positions.len() < self.coarse {
            chord_near(self.field, p, q, self.steiner.nears[ends[0].index()])
        } else {
            self.simpson(ends, p, q)
        };
        self.queue.push(length, ends);
    }

    /// Metric length along an edge by Simpson's rule; without its middle, where the ends agree.
    fn simpson(&self, [a, b]: [VertexId; 2], p: Point, q: Point) -> f64 {
        let d = q - p;
        let [at_a, at_b] = [a, b].map(|v| self.steiner.tensors[v.index()].length(d));
        let at_ends = at_a + at_b;
        if (at_a - at_b).abs() < ALIKE * at_ends {
            return 0.5 * at_ends;
        }
        let middle = self.field.at_near(p.midpoint(q), &mut self.steiner.nears[a.index()].clone());
        (at_ends + 4.0 * middle.length(d)) / 6.0
    }
}

/// Whether one of an edge's faces is no higher over it than rounding. Splitting such an edge would leave a face half as
/// high, again and again, down to where numbers end.
pub(super) fn is_beside_flat(planar: &Planar, h: HalfEdge) -> bool {
    let [p, q] = planar.ends(h);
    let rounding = ROUNDING * [p.x, p.y, q.x, q.y].iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let area = |side: HalfEdge| (q - p).cross(planar.position(planar.topology.apex(side)) - p).abs();
    planar.topology.sides(h).any(|side| area(side) <= rounding * p.distance(q))
}

#[cfg(test)]
mod tests {
    use crate::canvas::{COARSE, even};
    use crate::geometry::{Point, Tensor};
    use crate::test_cases::plate;

    #[test]
    fn a_border_that_is_halved_no_more_ends_the_work() {
        // Both long sides are encroached along all of their length, and nothing but rounding lies between them.
        let needle = plate(&[&[[-6e-10, 6e-10], [953.125, -1250.0], [0.0, 0.0]]]);
        let even = even(needle.planar(), &|_: Point| Tensor::IDENTITY, COARSE, 1000).unwrap();
        assert!(even.positions.len() <= 1000 + 120, "{}", even.positions.len());
    }
}
