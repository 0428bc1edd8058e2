//! The way down from a vertex to a source by the lengths of a triangulation alone: against the gradient of the distances, linear
//! in each face as it lies unfolded. In the plane of a face with its metric lengths the metric is Euclidean, so that what is
//! M^-1 grad d in [`descend`](super::descend) is the gradient itself.

use crate::geodesic::layout;
use crate::geometry::{Point, Vector};
use crate::triangulation::{HalfEdge, Triangulation, VertexId};

/// A place on an edge: its ends, and the share of the way from the first to the second; a vertex twice for that.
pub(crate) type OnEdge = ([VertexId; 2], f64);

/// The descent to whichever source the distances lead to.
pub(super) struct Unfolding<'a> {
    pub(super) topology: &'a Triangulation,
    pub(super) sources: &'a [VertexId],
    /// Infinite where not known.
    pub(super) distances: &'a [f64],
    /// The vertex that the distance of a vertex came from, where that is known: it is nearer.
    pub(super) parent: &'a dyn Fn(VertexId) -> Option<VertexId>,
}

#[derive(Clone, Copy)]
enum At {
    Vertex(VertexId),
    /// On the edge through which its face was entered, at a share of the way along it.
    Edge(HalfEdge, f64),
}

/// Crossings nearer to a vertex than this share of the edge are at the vertex.
const AT_VERTEX: f64 = 1e-6;

impl Unfolding<'_> {
    /// The way from a vertex to a source; `None` where the distances lead to none.
    pub(super) fn trace(&self, from: VertexId) -> Option<Vec<OnEdge>> {
        let mut at = At::Vertex(from);
        let mut way = vec![self.on_edge(at)];
        // Distances decrease on the way, so that no face is met often; the bound guards against rounding.
        for _ in 0..4 * self.topology.face_slots() {
            if let Some(source) = self.seen(at) {
                way.push(([source, source], 0.0));
                way.dedup();
                return Some(way);
            }
            at = match at {
                At::Vertex(v) => self.leave(v)?,
                At::Edge(h, t) => self.cross(h, t)?,
            };
            way.push(self.on_edge(at));
        }
        None
    }

    fn on_edge(&self, at: At) -> OnEdge {
        match at {
            At::Vertex(v) => ([v, v], 0.0),
            At::Edge(h, t) => (self.topology.ends(h), t),
        }
    }

    /// The source here or at a corner of the face that lies ahead.
    fn seen(&self, at: At) -> Option<VertexId> {
        let is_source = |v: &VertexId| self.sources.contains(v);
        match at {
            At::Vertex(v) => Some(v).filter(is_source),
            At::Edge(h, _) => self.topology.corners(h.face()).into_iter().find(is_source),
        }
    }

    /// The face of a half-edge laid out with its origin at zero and its target on the axis: target, apex, the way down.
    fn layout(&self, h: HalfEdge) -> (Point, Point, Vector) {
        let [base, to_end, to_start] = [h, h.next(), h.prev()].map(|h| self.topology.length(h));
        let (x, y) = layout(base, to_start, to_end);
        let ends = [self.topology.origin(h), self.topology.target(h), self.topology.apex(h)];
        let [a, b, c] = ends.map(|v| self.distances[v.index()]);
        let along = (b - a) / base;
        let across = (c - a - along * x) / y;
        (Point::new(base, 0.0), Point::new(x, y), Vector::new(-along, -across))
    }

    /// From a point of a face's edge through the face, or down along the edge.
    fn cross(&self, h: HalfEdge, t: f64) -> Option<At> {
        let (end, apex, down) = self.layout(h);
        if !(down.y > 0.0 && down.x.is_finite() && down.y.is_finite()) {
            return self.lowest(self.topology.ends(h));
        }
        let p = Point::new(t * end.x, 0.0);
        let is_right = down.cross(apex - p) > 0.0;
        let (exit, from, to) = if is_right { (h.next(), end, apex) } else { (h.prev(), apex, Point::default()) };
        Some(self.arrive(exit, (p - from).cross(down) / (to - from).cross(down)))
    }

    /// At a place of an edge, to go on into the face beyond; at the border the next step then leads along it.
    fn arrive(&self, h: HalfEdge, t: f64) -> At {
        if !(AT_VERTEX..=1.0 - AT_VERTEX).contains(&t) {
            return At::Vertex(if t > 0.5 { self.topology.target(h) } else { self.topology.origin(h) });
        }
        self.topology.twin(h).map_or(At::Edge(h, t), |beyond| At::Edge(beyond, 1.0 - t))
    }

    /// From a vertex through the face where the descent is steepest, else along the steepest edge, else to its parent.
    fn leave(&self, v: VertexId) -> Option<At> {
        let here = self.distances[v.index()];
        let mut best: Option<(f64, At)> = None;
        let mut offer = |rate: f64, at: At| {
            if rate > best.map_or(0.0, |best| best.0) {
                best = Some((rate, at));
            }
        };
        for h in self.topology.star(v) {
            let (end, apex, down) = self.layout(h);
            if down.y > 0.0 && down.cross(apex - Point::default()) >= 0.0 {
                let exit = (Point::default() - end).cross(down) / (apex - end).cross(down);
                offer(down.norm(), self.arrive(h.next(), exit));
            }
            for (u, edge) in [(self.topology.target(h), h), (self.topology.apex(h), h.prev())] {
                offer((here - self.distances[u.index()]) / self.topology.length(edge), At::Vertex(u));
            }
        }
        best.map(|best| best.1).or_else(|| (self.parent)(v).map(At::Vertex))
    }

    fn lowest(&self, vertices: [VertexId; 2]) -> Option<At> {
        let distance = |v: VertexId| self.distances[v.index()];
        let least = vertices.into_iter().min_by(|&a, &b| distance(a).total_cmp(&distance(b)))?;
        distance(least).is_finite().then_some(At::Vertex(least))
    }
}
