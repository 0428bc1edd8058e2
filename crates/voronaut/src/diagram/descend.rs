//! The way down from a point to a seed: against M^-1 grad d on the embedded canvas.
//!
//! (RR-9103 descends along the gradient of the distance itself; the shortest path follows that gradient raised by the
//! metric's inverse. The two agree only where the metric is isotropic.) Distances are interpolated linearly in each face, so
//! that the way is straight there; where it would leave the face that it has just come from, it follows the edge between
//! the two down to a vertex.

use super::seeds::Start;
use crate::canvas::Canvas;
use crate::error::{Error, Result};
use crate::geometry::{Orientation, Point, Vector, orientation};
use crate::metric::MetricField;
use crate::planar::Location;
use crate::triangulation::{FaceId, HalfEdge, VertexId};

/// The descent to one seed, or to whichever of several the distances lead to.
pub(super) struct Descent<'a> {
    pub(super) canvas: &'a Canvas,
    pub(super) field: &'a dyn MetricField,
    /// Where the seeds are, and the vertices that they give a distance to.
    pub(super) seeds: &'a [(Point, &'a [Start])],
    /// The distances of canvas vertices to the nearest of the seeds; infinite where not known.
    pub(super) distance: &'a dyn Fn(VertexId) -> f64,
    /// The vertex that the distance of a vertex came from, where that is known.
    pub(super) parent: &'a dyn Fn(VertexId) -> Option<VertexId>,
}

/// A place on the way.
#[derive(Clone, Copy, Debug)]
enum Place {
    /// In a face or on its edge, entered through the half-edge of the face if there is one.
    Face(Point, FaceId, Option<HalfEdge>),
    Vertex(VertexId),
}

/// Crossings nearer to a vertex than this share of the edge are at the vertex.
const AT_VERTEX: f64 = 1e-6;

impl Descent<'_> {
    /// The polyline from a point to the seed.
    ///
    /// # Errors
    /// [`Error::Domain`] of a point outside the domain, or from where the distances do not lead to the seed.
    pub(super) fn trace(&self, from: Point) -> Result<Vec<Point>> {
        let location = self.canvas.locate(from).ok_or_else(|| stuck(from))?;
        let mut place = self.begin(from, location);
        let mut path = vec![from];
        // Distances decrease on the way, so that no face is met often; the bound guards against rounding.
        let most = 4 * self.canvas.embedded().topology.face_slots();
        for _ in 0..most {
            if let Some(seed) = self.seen(place) {
                path.push(seed);
                path.dedup();
                return Ok(path);
            }
            place = self.step(place).ok_or_else(|| stuck(from))?;
            path.push(self.point(place));
        }
        Err(stuck(from))
    }

    fn begin(&self, from: Point, location: Location) -> Place {
        match location {
            Location::Face(f) => Place::Face(from, f, None),
            Location::Vertex(v) => Place::Vertex(v),
            Location::Edge(h) | Location::Behind(h) => {
                let twin = self.canvas.embedded().topology.twin(h);
                let leads_in = |h: &HalfEdge| {
                    let [a, b] = self.canvas.embedded().ends(*h);
                    self.direction(h.face(), from).is_some_and(|w| (b - a).cross(w) > 0.0)
                };
                let side = [Some(h), twin].into_iter().flatten().find(leads_in).unwrap_or(h);
                Place::Face(from, side.face(), Some(side))
            }
        }
    }

    fn point(&self, place: Place) -> Point {
        match place {
            Place::Face(p, ..) => p,
            Place::Vertex(v) => self.canvas.position(v),
        }
    }

    /// The seed that is in the face, or gave the vertex its distance.
    fn seen(&self, place: Place) -> Option<Point> {
        let sees = |(seed, starts): &&(Point, &[Start])| match place {
            Place::Face(_, f, _) => {
                let [a, b, c] = self.canvas.embedded().triangle(f);
                [(a, b), (b, c), (c, a)].iter().all(|&(u, v)| orientation(u, v, *seed) != Orientation::Right)
            }
            Place::Vertex(v) => starts.iter().any(|start| start.vertex == v),
        };
        self.seeds.iter().find(sees).map(|seed| seed.0)
    }

    fn step(&self, place: Place) -> Option<Place> {
        match place {
            Place::Face(p, f, entered) => self.cross(p, f, entered),
            Place::Vertex(v) => self.leave(v),
        }
    }

    /// The direction of descent in a face, with the metric at a point of it.
    fn direction(&self, f: FaceId, at: Point) -> Option<Vector> {
        let embedded = self.canvas.embedded();
        let [a, b, c] = embedded.triangle(f);
        let [da, db, dc] = embedded.topology.corners(f).map(|v| (self.distance)(v));
        let (u, v) = (b - a, c - a);
        // grad d with grad d . u = db - da and grad d . v = dc - da.
        let gradient = (v.perpendicular() * (da - db) + u.perpendicular() * (dc - da)) * (1.0 / u.cross(v));
        let down = -self.field.at(at).inverse().apply(gradient);
        (down.x.is_finite() && down.y.is_finite() && down != Vector::default()).then_some(down)
    }

    /// From a point of a face to its edge, or down along the edge through which the face was entered.
    fn cross(&self, p: Point, f: FaceId, entered: Option<HalfEdge>) -> Option<Place> {
        let embedded = self.canvas.embedded();
        let Some(down) = self.direction(f, p) else { return self.lowest(embedded.topology.corners(f)) };
        let leads_out = |h: HalfEdge| (embedded.ends(h)[1] - embedded.ends(h)[0]).cross(down) <= 0.0;
        if let Some(h) = entered.filter(|&h| leads_out(h)) {
            return self.lowest(embedded.topology.ends(h));
        }
        let others = f.half_edges().into_iter().filter(|&h| Some(h) != entered);
        let exits = others.filter_map(|h| self.exit(p, down, h).map(|(s, t)| (s, t, h)));
        let (_, t, h) = exits.min_by(|x, y| x.0.total_cmp(&y.0))?;
        Some(self.arrive(h, t))
    }

    /// When a ray meets an edge, and where on it (0 at its start, 1 at its end).
    fn exit(&self, p: Point, down: Vector, h: HalfEdge) -> Option<(f64, f64)> {
        let [a, b] = self.canvas.embedded().ends(h);
        let rate = (b - a).cross(down);
        if rate >= 0.0 {
            return None;
        }
        let s = ((b - a).cross(p - a) / -rate).max(0.0);
        let t = (p + down * s - a).dot(b - a) / (b - a).dot(b - a);
        Some((s, t.clamp(0.0, 1.0)))
    }

    /// At a place on an edge, to go on into the face beyond; at the border the next step then leads along it.
    fn arrive(&self, h: HalfEdge, t: f64) -> Place {
        let embedded = self.canvas.embedded();
        if !(AT_VERTEX..=1.0 - AT_VERTEX).contains(&t) {
            return Place::Vertex(if t > 0.5 { embedded.topology.target(h) } else { embedded.topology.origin(h) });
        }
        let [a, b] = embedded.ends(h);
        let beyond = embedded.topology.twin(h).unwrap_or(h);
        Place::Face(a.lerp(b, t), beyond.face(), Some(beyond))
    }

    /// From a vertex through the face where the descent is steepest, else along the steepest edge, else to its parent.
    fn leave(&self, v: VertexId) -> Option<Place> {
        let embedded = self.canvas.embedded();
        let (topology, at) = (&embedded.topology, embedded.position(v));
        let mut best: Option<(f64, Place)> = None;
        let mut offer = |rate: f64, place: Option<Place>| {
            if let Some(place) = place.filter(|_| rate > best.map_or(0.0, |b| b.0)) {
                best = Some((rate, place));
            }
        };
        let here = (self.distance)(v);
        let edge =
            |u: VertexId, h: HalfEdge| ((here - (self.distance)(u)) / topology.length(h), Some(Place::Vertex(u)));
        for h in topology.star(v) {
            let [a, b] = [topology.target(h), topology.apex(h)].map(|u| embedded.position(u) - at);
            let down = self.direction(h.face(), at);
            if let Some(down) = down.filter(|&w| a.cross(w) >= 0.0 && w.cross(b) >= 0.0) {
                let exit = self.exit(at, down, h.next());
                offer(self.field.at(at).length(down), exit.map(|(_, t)| self.arrive(h.next(), t)));
            }
            for (u, e) in [(topology.target(h), h), (topology.apex(h), h.prev())] {
                let (rate, place) = edge(u, e);
                offer(rate, place);
            }
        }
        best.map(|b| b.1).or_else(|| self.parent(v))
    }

    /// The vertex that the distance of a vertex came from, if it is in sight and nearer.
    fn parent(&self, v: VertexId) -> Option<Place> {
        let parent = (self.parent)(v)?;
        let near = self.canvas.embedded().topology.start(v)?.face();
        let seen = self.canvas.embedded().walk(near, self.canvas.position(parent), false);
        let is_down = (self.distance)(parent) < (self.distance)(v) && seen == Location::Vertex(parent);
        is_down.then_some(Place::Vertex(parent))
    }

    fn lowest<const N: usize>(&self, vertices: [VertexId; N]) -> Option<Place> {
        let least = vertices.into_iter().min_by(|&a, &b| (self.distance)(a).total_cmp(&(self.distance)(b)))?;
        (self.distance)(least).is_finite().then_some(Place::Vertex(least))
    }
}

fn stuck(from: Point) -> Error {
    let help = "take a point of the domain that the seed reaches, or a finer canvas";
    Error::domain("no way from there to a seed", from.to_string(), help)
}
