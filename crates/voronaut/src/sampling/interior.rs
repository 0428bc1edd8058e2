//! The interior: seeds one at a time at the circumcentre of the face whose metric circumradius is largest.

use super::queue::{Entry, Queue};
use crate::dual::{Dual, Kind, Moving};
use crate::elementary::Elementary;
use crate::error::Result;
use crate::geodesic::chord_near;
use crate::geometry::{Point, Tensor, Vector, centroid};
use crate::metric::MetricField;
use crate::parallel::prelude::*;
use crate::planar::Location;
use crate::progress::Progress;
use crate::triangulation::{FaceId, HalfEdge, VertexId};

/// Constrained edges shorter than this (metric length) are not split for an encroaching seed: both halves stay unit
/// edges, and spikes do not cascade.
const SPLIT_FLOOR: f64 = std::f64::consts::SQRT_2;
/// New seeds keep at least this distance (metric length) from all others.
pub(super) const SPACING: f64 = 0.55;
/// A length that is so many times greater by the tensors at both ends is greater along the edge.
const CLEAR: f64 = 1.3;
/// Corners farther apart than this (metric length) say little of what lies between them.
const FAR: f64 = 2.5;

/// A circumcentre beyond so many faces is not looked for: a circle in the tensor of one face says nothing so far away. In metrics that
/// meshes resolve fewer than one in 10,000 lies beyond; in thin shocks ways to others took four fifths of the time, and meshes were no
/// better for it.
const REACH: usize = 128;

/// How many vertices refinement goes for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fill {
    /// This many, if need be by halving the longest edges where no circumcentre can be had.
    Exactly(usize),
    /// This many, or fewer where the metric leaves no room.
    AtMost(usize),
}

impl Fill {
    /// The number.
    pub(crate) fn count(self) -> usize {
        let (Fill::Exactly(count) | Fill::AtMost(count)) = self;
        count
    }
}

/// Passes over all edges to halve the longest, each up to an eighth of them; more means that rounding forbids most.
const MOST_PASSES: usize = 100;

/// Inserts seeds until the dual has as many vertices as asked for.
pub(crate) fn refine(dual: &mut Dual, fill: Fill, progress: &dyn Progress) -> Result<()> {
    refine_with(dual, fill, progress, &mut |dual, place, (centre, _)| insert_spaced(dual, place, centre))
}

/// Puts a seed at, or near, a circumcentre, which is in this place, given with the circumradius; says whether it did.
pub(super) type Steiner<'a> = &'a mut dyn FnMut(&mut Dual, Location, (Point, f64)) -> bool;

/// [`refine`], with the seeds for circumcentres put where `steiner` says.
pub(super) fn refine_with(dual: &mut Dual, fill: Fill, progress: &dyn Progress, steiner: Steiner) -> Result<()> {
    let count = fill.count();
    dual.take_touched();
    let faces: Vec<FaceId> = dual.topology().faces().collect();
    let entry = |&of: &FaceId| Entry { value: circumcircle(dual, of).1, of };
    let entries: Vec<Entry<FaceId>> = faces.par_iter().with_min_len(1024).map(entry).collect();
    let mut radii = vec![0.0; dual.topology().face_slots()];
    for &Entry { value, of } in &entries {
        radii[of.index()] = value;
    }
    let mut refiner = Refiner { queue: Queue::new(entries), radii, steiner, touched: Vec::new() };
    let (mut reported, mut passes) = (dual.vertex_count(), 0);
    while dual.vertex_count() < count {
        if !refiner.improve_worst(dual) {
            passes += 1;
            let goes_on = fill == Fill::Exactly(count) && passes <= MOST_PASSES;
            if !goes_on || !refiner.halve_longest(dual, count) {
                break;
            }
        }
        if dual.vertex_count() >= reported + 256 {
            progress.advance((dual.vertex_count() - reported) as u64)?;
            progress.sketch(&|| dual.sketch());
            reported = dual.vertex_count();
        }
    }
    Ok(())
}

struct Refiner<'a> {
    /// Faces by their metric circumradius; stale once a face has changed.
    queue: Queue,
    /// What it was last, of each face.
    radii: Vec<f64>,
    steiner: Steiner<'a>,
    /// Room for faces that have changed.
    touched: Vec<FaceId>,
}

impl Refiner<'_> {
    /// Puts the faces that have changed into the queue.
    fn enqueue(&mut self, dual: &mut Dual) {
        dual.take_touched_into(&mut self.touched);
        self.radii.resize(dual.topology().face_slots(), 0.0);
        // Flips around a seed touch its faces several times.
        self.touched.sort_unstable();
        self.touched.dedup();
        for &face in &self.touched {
            if dual.topology().is_face(face) {
                let value = circumcircle(dual, face).1;
                self.queue.push(Entry { value, of: face });
                self.radii[face.index()] = value;
            }
        }
    }

    /// Takes the worst face and inserts a seed for it, if one can be had. False when no face is left.
    fn improve_worst(&mut self, dual: &mut Dual) -> bool {
        while let Some(Entry { value: radius, of: face }) = self.queue.pop() {
            if !dual.topology().is_face(face) || self.radii[face.index()].to_bits() != radius.to_bits() {
                continue;
            }
            let (centre, _) = circumcircle(dual, face);
            let done = self.insert_for(dual, face, (centre, radius));
            self.enqueue(dual);
            if done {
                return true;
            }
        }
        false
    }

    /// A seed for a face: at its circumcentre, else (where the metric varies so much that the circle says little) at
    /// its centroid or in the middle of its longest edge. Each must keep its distance from the seeds around it.
    fn insert_for(&mut self, dual: &mut Dual, face: FaceId, circle: (Point, f64)) -> bool {
        if self.insert_at_circumcentre(dual, face, circle) {
            return true;
        }
        if !dual.topology().is_face(face) {
            // Places were tried, and left other faces, which are in the queue.
            return false;
        }
        if insert_spaced(dual, Location::Face(face), centroid(dual.planar().triangle(face))) {
            return true;
        }
        let longest = face.half_edges().into_iter().max_by(|&g, &h| chord_of(dual, g).total_cmp(&chord_of(dual, h)));
        longest.is_some_and(|h| {
            let [a, b] = dual.planar().ends(h);
            split_if_long(dual, h) || insert_spaced(dual, Location::Edge(h), a.midpoint(b))
        })
    }

    fn insert_at_circumcentre(&mut self, dual: &mut Dual, face: FaceId, (centre, radius): (Point, f64)) -> bool {
        let Some(place) = dual.planar().walk_within(face, centre, true, REACH) else { return false };
        let encroached = match place {
            Location::Face(f) => encroached_edge(dual, f, centre),
            Location::Edge(h) | Location::Behind(h) => Some(h).filter(|&h| dual.topology().is_fixed(h)),
            Location::Vertex(_) => None,
        };
        match encroached {
            Some(h) => split_if_long(dual, h),
            None => (self.steiner)(dual, place, (centre, radius)),
        }
    }

    /// Halves the longest edges of all, for when every face is as good as its circumcentre can make it and vertices
    /// are still wanted. False when nothing could be halved.
    fn halve_longest(&mut self, dual: &mut Dual, count: usize) -> bool {
        let mut edges: Vec<(f64, HalfEdge)> = dual.topology().edges().map(|h| (dual.edge_length(h), h)).collect();
        edges.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let wanted = (count - dual.vertex_count()).min(edges.len() / 8 + 1);
        let candidates: Vec<[VertexId; 2]> = edges.iter().map(|&(_, h)| dual.topology().ends(h)).collect();
        let mut done = 0;
        for [a, b] in candidates {
            if done == wanted {
                break;
            }
            let edge = dual.topology().edge_between(a, b);
            done += usize::from(edge.is_some_and(|h| halve(dual, h)));
        }
        self.enqueue(dual);
        done > 0
    }
}

/// Circumcentre and metric circumradius of a face, with one tensor for the whole face: the mean of its corners', or,
/// where they are so far away that they say little of the face, mostly that at its centroid.
fn circumcircle(dual: &Dual, face: FaceId) -> (Point, f64) {
    let corners = dual.topology().corners(face);
    let mean = dual.mean_tensor(corners);
    let [a, b, c] = corners.map(|v| dual.position(v));
    let (u, v) = (b - a, c - a);
    let tensor = if mean.length(u).max(mean.length(v)) > FAR {
        let mut near = dual.local(corners[0]).near;
        Tensor::log_mean([(mean, 0.25), (dual.field().at_near(centroid([a, b, c]), &mut near), 0.75)])
    } else {
        mean
    };
    let (uu, vv) = (tensor.dot(u, u), tensor.dot(v, v));
    // M x . u = uu / 2 and M x . v = vv / 2.
    let (mu, mv) = (tensor.apply(u), tensor.apply(v));
    let determinant = mu.cross(mv);
    let x = Vector::new(uu * mv.y - vv * mu.y, vv * mu.x - uu * mv.x) * (0.5 / determinant);
    let radius = tensor.length(x);
    if radius.is_finite() { (a + x, radius) } else { (a.lerp(b, 0.5), f64::MAX) }
}

/// A constrained edge of the face, or of a neighbour that the point would see, in whose diametral ball the point lies.
pub(super) fn encroached_edge(dual: &Dual, face: FaceId, p: Point) -> Option<HalfEdge> {
    let topology = dual.topology();
    let beyond = face.half_edges().into_iter().filter(|&h| !topology.is_fixed(h)).filter_map(|h| topology.twin(h));
    let seen = face.half_edges().into_iter().chain(beyond.flat_map(|t| [t.next(), t.prev()]));
    let encroached = |h: &HalfEdge| {
        let [a, b] = dual.planar().ends(*h);
        dual.mean_tensor(topology.ends(*h)).dot(a - p, b - p) < 0.0
    };
    seen.filter(|&h| topology.is_fixed(h))
        .filter(encroached)
        .max_by(|&g, &h| dual.edge_length(g).total_cmp(&dual.edge_length(h)))
}

/// Puts a free seed inside a face or on an unconstrained edge, unless it would come nearer than [`SPACING`] to another.
pub(crate) fn insert_spaced(dual: &mut Dual, place: Location, p: Point) -> bool {
    match place {
        Location::Face(f) => !is_crowded(dual, f, p) && dual.insert_in_face(f, p).is_some(),
        Location::Edge(h) if !dual.topology().is_fixed(h) => {
            !is_crowded(dual, h.face(), p) && dual.insert_on_edge(h, p).is_some()
        }
        _ => false,
    }
}

/// Whether a vertex is too near to a point of the face: one of the face's corners, or one that is reached from the
/// nearest of them by going from neighbour to nearer neighbour.
pub(super) fn is_crowded(dual: &Dual, face: FaceId, p: Point) -> bool {
    let topology = dual.topology();
    let corners = topology.corners(face);
    let mut near = dual.local(corners[0]).near;
    let tensor = dual.field().at_near(p, &mut near);
    let distance = |v: VertexId| tensor.length(p - dual.position(v));
    let too_near = |v: VertexId| {
        let lengths = [distance(v), dual.local(v).tensor.length(p - dual.position(v))];
        let is_clear = lengths.iter().all(|length| *length > CLEAR * SPACING);
        !is_clear && chord_near(dual.field(), p, dual.position(v), near) < SPACING
    };
    if corners.into_iter().any(too_near) {
        return true;
    }
    let nearer = |u: VertexId, v: VertexId| if distance(v) < distance(u) { v } else { u };
    let mut nearest = corners.into_iter().reduce(nearer).expect("a face has corners");
    loop {
        let next = topology.star(nearest).map(|h| topology.target(h)).fold(nearest, nearer);
        if next == nearest {
            return too_near(nearest);
        }
        nearest = next;
    }
}

/// Metric length along an edge.
fn chord_of(dual: &Dual, h: HalfEdge) -> f64 {
    let [a, b] = dual.planar().ends(h);
    chord_near(dual.field(), a, b, dual.local(dual.topology().origin(h)).near)
}

fn halve(dual: &mut Dual, h: HalfEdge) -> bool {
    if dual.topology().is_fixed(h) {
        return split_constrained(dual, h);
    }
    let [a, b] = dual.planar().ends(h);
    dual.insert_on_edge(h, a.midpoint(b)).is_some()
}

/// Splits a constrained edge if both halves will still be unit edges.
fn split_if_long(dual: &mut Dual, h: HalfEdge) -> bool {
    dual.topology().is_fixed(h) && chord_of(dual, h) > SPLIT_FLOOR && split_constrained(dual, h)
}

/// Splits a constrained edge at its middle, or, next to a sharp corner, on one of the concentric shells of radius
/// 2^k around it, so that the edges of both curves at the corner are split at the same distance (Ruppert 1995).
fn split_constrained(dual: &mut Dual, h: HalfEdge) -> bool {
    let [a, b] = dual.topology().ends(h);
    let length = dual.edge_length(h);
    let shell = (0.5 * length).binary_logarithm().round().power_of_two() / length;
    let t = match (is_sharp(dual, a), is_sharp(dual, b)) {
        (true, false) => shell,
        (false, true) => 1.0 - shell,
        _ => 0.5,
    };
    let p = dual.position(a).lerp(dual.position(b), t);
    dual.insert_on_edge(h, p).is_some()
}

/// Whether two constrained edges meet at a corner at less than 60 degrees in the metric.
fn is_sharp(dual: &Dual, v: VertexId) -> bool {
    if !matches!(dual.kind(v), Kind::Corner(_)) {
        return false;
    }
    let topology = dual.topology();
    let along = topology.along_fixed(v).map(|u| dual.position(u) - dual.position(v));
    let directions: Vec<Vector> = along.collect();
    let tensor = dual.local(v).tensor;
    let cosine = |u: Vector, w: Vector| tensor.dot(u, w) / (tensor.length(u) * tensor.length(w));
    (0..directions.len()).any(|i| {
        // Directions that are the same but for rounding are no corner, hence the bound below one.
        directions[..i].iter().any(|&u| (0.5..1.0 - 1e-12).contains(&cosine(u, directions[i])))
    })
}
