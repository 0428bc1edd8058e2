//! The way down from a place to a seed: against M^-1 grad d on the embedded canvas.
//!
//! (RR-9103 descends along the gradient of the distance itself; the shortest path follows that gradient raised by the
//! metric's inverse. The two agree only where the metric is isotropic.) Distances are interpolated linearly in each face, so
//! that the way is straight there; where it would leave the face that it has just come from, it follows the edge between
//! the two down to a vertex. Each face is laid out by itself ([`Ground::triangle`]), on a surface by its metric lengths.

use super::seeds::Start;
use super::{Flat, Ground};
use crate::error::{Error, Result};
use crate::geometry::{Point, Vector, holds};
use crate::planar::Location;
use crate::triangulation::{FaceId, HalfEdge, VertexId};

/// The descent to one seed, or to whichever of several the distances lead to.
pub(super) struct Descent<'a, G> {
    pub(super) ground: G,
    /// The distances of canvas vertices to the nearest of the seeds; infinite where not known.
    pub(super) distance: &'a dyn Fn(VertexId) -> f64,
    /// The vertex that the distance of a vertex came from, where that is known: it is nearer.
    pub(super) parent: &'a dyn Fn(VertexId) -> Option<VertexId>,
}

/// A place on the way.
#[derive(Clone, Copy, Debug)]
pub(super) enum At {
    /// In a face as it is laid out, or on its edge: the half-edge of the face through which it was entered, if there is one.
    Face(Point, FaceId, Option<HalfEdge>),
    /// At a vertex.
    Vertex(VertexId),
}

/// Crossings nearer to a vertex than this share of the edge are at the vertex.
const AT_VERTEX: f64 = 1e-6;

impl<'g, G: Ground<'g>> Descent<'_, G> {
    /// The places on the way from one to where the end is seen, and what is seen there; `None` where the distances lead to
    /// no end.
    pub(super) fn trace<T>(&self, from: At, seen: impl Fn(At) -> Option<T>) -> Option<(Vec<At>, T)> {
        let (mut at, mut way) = (from, vec![from]);
        // Distances decrease on the way, so that no face is met often; the bound guards against rounding.
        for _ in 0..4 * self.ground.embedded().face_slots() {
            if let Some(end) = seen(at) {
                return Some((way, end));
            }
            at = match at {
                At::Face(p, f, entered) => self.cross(p, f, entered)?,
                At::Vertex(v) => self.leave(v)?,
            };
            way.push(at);
        }
        None
    }

    /// The ends of a half-edge, and the apex of its face, as that is laid out.
    pub(super) fn corners(&self, h: HalfEdge) -> [Point; 3] {
        let mut corners = self.ground.triangle(h.face());
        corners.rotate_left(h.index() % 3);
        corners
    }

    /// The direction of descent in a face, with the metric at a point of it.
    fn direction(&self, f: FaceId, at: Point) -> Option<Vector> {
        let [a, b, c] = self.ground.triangle(f);
        let [da, db, dc] = self.ground.embedded().corners(f).map(|v| (self.distance)(v));
        let (u, v) = (b - a, c - a);
        // grad d with grad d . u = db - da and grad d . v = dc - da.
        let gradient = (v.perpendicular() * (da - db) + u.perpendicular() * (dc - da)) * (1.0 / u.cross(v));
        let down = -self.ground.metric(at).inverse().apply(gradient);
        (down.x.is_finite() && down.y.is_finite() && down != Vector::default()).then_some(down)
    }

    /// From a point of a face to its edge, or down along the edge through which the face was entered.
    fn cross(&self, p: Point, f: FaceId, entered: Option<HalfEdge>) -> Option<At> {
        let topology = self.ground.embedded();
        let Some(down) = self.direction(f, p) else { return self.lowest(topology.corners(f)) };
        let leads_out = |h: HalfEdge| {
            let [a, b, _] = self.corners(h);
            (b - a).cross(down) <= 0.0
        };
        if let Some(h) = entered.filter(|&h| leads_out(h)) {
            return self.lowest(topology.ends(h));
        }
        let others = f.half_edges().into_iter().filter(|&h| Some(h) != entered);
        let exits = others.filter_map(|h| self.exit(p, down, h).map(|(s, t)| (s, t, h)));
        let (_, t, h) = exits.min_by(|x, y| x.0.total_cmp(&y.0))?;
        Some(self.arrive(h, t))
    }

    /// When a ray meets an edge, and where on it (0 at its start, 1 at its end).
    fn exit(&self, p: Point, down: Vector, h: HalfEdge) -> Option<(f64, f64)> {
        let [a, b, _] = self.corners(h);
        let rate = (b - a).cross(down);
        if rate >= 0.0 {
            return None;
        }
        let s = ((b - a).cross(p - a) / -rate).max(0.0);
        let t = (p + down * s - a).dot(b - a) / (b - a).dot(b - a);
        Some((s, t.clamp(0.0, 1.0)))
    }

    /// At a place on an edge, to go on into the face beyond; at the border the next step then leads along it.
    fn arrive(&self, h: HalfEdge, t: f64) -> At {
        let topology = self.ground.embedded();
        if !(AT_VERTEX..=1.0 - AT_VERTEX).contains(&t) {
            return At::Vertex(if t > 0.5 { topology.target(h) } else { topology.origin(h) });
        }
        let beyond = topology.twin(h).unwrap_or(h);
        let [a, b, _] = self.corners(beyond);
        At::Face(if beyond == h { a.lerp(b, t) } else { b.lerp(a, t) }, beyond.face(), Some(beyond))
    }

    /// From a vertex through the face where the descent is steepest, else along the steepest edge, else to its parent.
    fn leave(&self, v: VertexId) -> Option<At> {
        let topology = self.ground.embedded();
        let here = (self.distance)(v);
        let mut best: Option<(f64, At)> = None;
        let mut offer = |rate: f64, place: At| {
            if rate > best.map_or(0.0, |b| b.0) {
                best = Some((rate, place));
            }
        };
        for h in topology.star(v) {
            let [at, a, b] = self.corners(h);
            let down = self.direction(h.face(), at).filter(|&w| (a - at).cross(w) >= 0.0 && w.cross(b - at) >= 0.0);
            if let Some((down, (_, t))) = down.and_then(|down| Some((down, self.exit(at, down, h.next())?))) {
                offer(self.ground.metric(at).length(down), self.arrive(h.next(), t));
            }
            for (u, e) in [(topology.target(h), h), (topology.apex(h), h.prev())] {
                offer((here - (self.distance)(u)) / topology.length(e), At::Vertex(u));
            }
        }
        best.map(|b| b.1).or_else(|| (self.parent)(v).map(At::Vertex))
    }

    fn lowest<const N: usize>(&self, vertices: [VertexId; N]) -> Option<At> {
        let least = vertices.into_iter().min_by(|&a, &b| (self.distance)(a).total_cmp(&(self.distance)(b)))?;
        (self.distance)(least).is_finite().then_some(At::Vertex(least))
    }
}

impl Descent<'_, Flat<'_>> {
    /// The polyline from a point to one of the seeds, which are given with the vertices that they give a distance to.
    ///
    /// # Errors
    /// [`Error::Domain`] of a point outside the domain, or from where the distances do not lead to a seed.
    pub(super) fn polyline(&self, from: Point, seeds: &[(Point, &[Start])]) -> Result<Vec<Point>> {
        let canvas = self.ground.canvas;
        let parent = |v: VertexId| (self.parent)(v).filter(|&parent| self.is_down(v, parent));
        let descent = Descent { parent: &parent, ..*self };
        let traced = canvas.locate(from).and_then(|location| {
            descent.trace(self.begin(from, location), |at| seeds.iter().find(|seed| self.sees(at, seed)).map(|s| s.0))
        });
        let (way, seed) = traced.ok_or_else(|| {
            let help = "take a point of the domain that the seed reaches, or a finer canvas";
            Error::domain("no way from there to a seed", from.to_string(), help)
        })?;
        let point = |&at: &At| match at {
            At::Face(p, ..) => p,
            At::Vertex(v) => canvas.position(v),
        };
        let mut path: Vec<Point> = way.iter().map(point).chain([seed]).collect();
        path.dedup();
        Ok(path)
    }

    fn begin(&self, from: Point, location: Location) -> At {
        match location {
            Location::Face(f) => At::Face(from, f, None),
            Location::Vertex(v) => At::Vertex(v),
            Location::Edge(h) | Location::Behind(h) => {
                let leads_in = |h: &HalfEdge| {
                    let [a, b, _] = self.corners(*h);
                    self.direction(h.face(), from).is_some_and(|w| (b - a).cross(w) > 0.0)
                };
                let side = self.ground.embedded().sides(h).find(leads_in).unwrap_or(h);
                At::Face(from, side.face(), Some(side))
            }
        }
    }

    /// Whether a seed is in the face, or gave the vertex its distance.
    fn sees(&self, at: At, (seed, starts): &(Point, &[Start])) -> bool {
        match at {
            At::Face(_, f, _) => holds(self.ground.triangle(f), *seed),
            At::Vertex(v) => starts.iter().any(|start| start.vertex == v),
        }
    }

    /// Whether the vertex that the distance of a vertex came from is in sight, and nearer.
    fn is_down(&self, v: VertexId, parent: VertexId) -> bool {
        let canvas = self.ground.canvas;
        let near = self.ground.embedded().start(v).map(HalfEdge::face);
        (self.distance)(parent) < (self.distance)(v)
            && near
                .is_some_and(|f| canvas.embedded().walk(f, canvas.position(parent), false) == Location::Vertex(parent))
    }
}
