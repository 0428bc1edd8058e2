//! How fine the metric must be for a mesh of so many vertices, and what that mesh will need; the boundary and interfaces are then
//! sampled at unit metric length.

use crate::canvas;
use crate::dual::{Dual, Moving};
use crate::error::{Error, Result};
use crate::geodesic::chord_by;
use crate::geometry::{Motion, Point};
use crate::lists::{distinct, in_order};
use crate::manifold::domain::{Domain, Pair};
use crate::mesh::Mesh;
use crate::metric::{MetricField, complexity, nearby, rough_complexity};
use crate::parallel::prelude::*;
use crate::triangulation::VertexId;
use std::collections::{BTreeSet, HashMap};

/// What the size of the mesh should follow from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Target {
    /// This many vertices; the metric is scaled to that.
    Vertices(usize),
    /// This integral of sqrt(det M); the metric is scaled to that.
    Complexity(f64),
    /// The metric as it is.
    Metric,
}

/// Metric area of the equilateral triangle with unit edges.
const UNIT_TRIANGLE: f64 = 0.433_012_701_892_219_3;
/// Bytes that a vertex of the mesh costs at the peak, with its two triangles: measured 0.5 to 0.7 kB, with a reserve.
const BYTES_PER_VERTEX: f64 = 1200.0;

/// A domain measured by a metric.
pub(crate) struct Plan {
    /// The domain.
    pub domain: Domain,
    /// The integral of sqrt(det M).
    pub complexity: f64,
    /// The constrained edges of the domain's triangulation; of two that are cut alike the first.
    pub edges: Vec<Stretch>,
    /// Their metric lengths.
    pub arcs: Vec<MetricArc>,
    /// The domain's periodic pairs.
    pub pairs: Vec<Pair>,
    corners: usize,
    copies: usize,
}

/// A constrained edge of the domain's triangulation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stretch {
    ends: [VertexId; 2],
    /// It stays whole.
    required: bool,
    /// The edge of a periodic pair that is cut where the motion brings its cuts.
    twin: Option<([VertexId; 2], Motion)>,
}

impl Stretch {
    /// Its length, or the longer one of both: the metric that asks for more.
    fn measured(&self, domain: &Domain, field: &dyn MetricField) -> MetricArc {
        let positions = |ends: [VertexId; 2]| ends.map(|v| domain.planar().position(v));
        match self.twin {
            None => MetricArc::of_chord(field, positions(self.ends)),
            Some((twin, _)) => MetricArc::of_longer(field, [self.ends, twin].map(positions)),
        }
    }

    /// How many edges there are of it for each.
    fn sides(&self) -> f64 {
        if self.twin.is_some() { 2.0 } else { 1.0 }
    }
}

impl Plan {
    /// Measures the domain, in parallel, as accurately as the target needs.
    ///
    /// # Errors
    /// The metric is not positive definite somewhere, or its complexity not finite.
    pub(crate) fn new(domain: Domain, pairs: Vec<Pair>, field: &dyn MetricField, target: Target) -> Result<Self> {
        // Elsewhere the integral is only where the search for scale or count starts.
        let integral = if matches!(target, Target::Complexity(_)) { complexity } else { rough_complexity };
        let complexity = integral(field, &domain.planar().triangles())?;
        Ok(Self::with(domain, pairs, field, complexity))
    }

    /// That of the same domain with its curves simplified.
    ///
    /// # Errors
    /// As [`Plan::new`].
    pub(crate) fn again(
        &self,
        domain: Domain,
        pairs: Vec<Pair>,
        field: &dyn MetricField,
        target: Target,
    ) -> Result<Self> {
        match target {
            Target::Complexity(_) => Self::new(domain, pairs, field, target),
            Target::Vertices(_) | Target::Metric => Ok(Self::with(domain, pairs, field, self.complexity)),
        }
    }

    /// That of a domain whose complexity is known.
    pub(crate) fn with(domain: Domain, pairs: Vec<Pair>, field: &dyn MetricField, complexity: f64) -> Self {
        let edges = stretches(&domain, &pairs);
        let arcs = edges.par_iter().map(|edge| edge.measured(&domain, field)).collect();
        let (corners, copies) = (domain.planar().topology.vertex_count(), copies(&domain));
        Self { domain, complexity, edges, arcs, pairs, corners, copies }
    }

    /// The mesh of the domain that a dual is.
    pub(crate) fn mesh(&self, dual: &Dual) -> Mesh {
        self.domain.mesh_of(dual.planar(), |v| dual.corner(v))
    }

    /// The number there of each of its vertices by id; `u32::MAX` of those that are none.
    pub(crate) fn numbering(&self, dual: &Dual) -> Vec<u32> {
        self.domain.numbering(dual.planar(), |v| dual.corner(v))
    }

    /// Vertices of the domain itself, with copies: no mesh has fewer.
    pub(crate) fn corners(&self) -> usize {
        self.corners
    }

    /// Vertices that are there twice while meshing, and joined in the mesh: where the domain touches itself in a point.
    pub(crate) fn copies(&self) -> usize {
        self.copies
    }

    /// Vertices on the boundary and interfaces when the metric is multiplied by `scale`.
    pub(crate) fn boundary_vertices(&self, scale: f64) -> f64 {
        let cuts = |(arc, edge): (&MetricArc, &Stretch)| {
            if edge.required { 0.0 } else { edge.sides() * (pieces(arc.length() * scale.sqrt()) as f64 - 1.0) }
        };
        self.corners as f64 + self.arcs.iter().zip(&self.edges).map(cuts).sum::<f64>()
    }

    /// Expected vertices of the unit mesh of the metric times `scale`: half its triangles plus half its boundary
    /// (Euler), with all triangles equilateral.
    pub(crate) fn expected_vertices(&self, scale: f64) -> f64 {
        let boundary = self.boundary_vertices(scale);
        boundary.max(0.5 * scale * self.complexity / UNIT_TRIANGLE + 0.5 * boundary)
    }

    /// The largest scale for which no more than `count` vertices are expected; where the corners alone are more, the
    /// scale at which the metric asks for no vertex beside them.
    pub(crate) fn scale_for(&self, count: f64) -> f64 {
        let mut low = count * UNIT_TRIANGLE / self.complexity;
        while self.expected_vertices(low) > count {
            if self.expected_vertices(low) <= self.corners as f64 {
                return low;
            }
            low *= 0.5;
        }
        let mut high = low.max(f64::MIN_POSITIVE);
        while self.expected_vertices(high) <= count {
            high *= 2.0;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.expected_vertices(middle) <= count { low = middle } else { high = middle }
        }
        low
    }

    /// Vertex count (with copies) and metric factor to start from.
    ///
    /// # Errors
    /// [`Error::Limit`] where the mesh is estimated to need more memory than `memory_limit` bytes, or more vertices
    /// than ids can number.
    pub(crate) fn start(&self, target: Target, memory_limit: u64) -> Result<(usize, f64)> {
        let (count, scale) = match target {
            Target::Vertices(n) => ((n + self.copies) as f64, self.scale_for((n + self.copies) as f64)),
            Target::Complexity(c) => (self.expected_vertices(c / self.complexity), c / self.complexity),
            Target::Metric => (self.expected_vertices(1.0), 1.0),
        };
        demand_memory(count, 0.0, memory_limit)?;
        Ok((count.round().max(3.0) as usize, scale))
    }
}

/// The constrained edges of a domain's triangulation, those of pairs as one.
fn stretches(domain: &Domain, pairs: &[Pair]) -> Vec<Stretch> {
    let (topology, sources) = (&domain.planar().topology, domain.sources());
    let required = |h| topology.constraint(h).is_some_and(|c| domain.pslg().segments[c.0 as usize].required);
    let constrained = topology.edges().filter(|&h| topology.constraint(h).is_some());
    let all = constrained.map(|h| Stretch { ends: topology.ends(h), required: required(h), twin: None });
    if pairs.is_empty() {
        return all.collect();
    }
    let points =
        |ends: [VertexId; 2]| ends.map(|v| sources[v.index()].expect("an end of a segment is a point of the graph"));
    let turned_as = |edge: &Stretch, from: u32| {
        let [a, b] = edge.ends;
        if points(edge.ends)[0] == from { [a, b] } else { [b, a] }
    };
    let all: Vec<Stretch> = all.collect();
    let by_points: HashMap<[u32; 2], usize> = (0..all.len()).map(|i| (in_order(points(all[i].ends)), i)).collect();
    let (mut joined, mut second) = (all.clone(), BTreeSet::new());
    for Pair { runs, motion, .. } in pairs {
        for (from, to) in runs[0].windows(2).zip(runs[1].windows(2)) {
            let [first, twin] = [from, to].map(|ends| by_points[&in_order([ends[0], ends[1]])]);
            joined[first].ends = turned_as(&all[first], from[0]);
            joined[first].twin = Some((turned_as(&all[twin], to[0]), *motion));
            joined[first].required |= all[twin].required;
            second.insert(twin);
        }
    }
    joined.into_iter().enumerate().filter(|(i, _)| !second.contains(i)).map(|(_, edge)| edge).collect()
}

fn copies(domain: &Domain) -> usize {
    let sources = domain.sources().iter().flatten();
    sources.clone().count() - distinct(sources).len()
}

/// Demands that a mesh of so many vertices, made with a canvas of so many (0: none), fits into `limit` bytes.
///
/// # Errors
/// [`Error::Limit`] where it is estimated not to, or where ids could not number all vertices.
pub fn demand_memory(vertices: f64, canvas: f64, limit: u64) -> Result<()> {
    let needed = vertices * BYTES_PER_VERTEX + canvas * canvas::BYTES_PER_VERTEX;
    let ids = f64::from(u32::MAX) / 8.0;
    if needed <= limit as f64 && vertices.max(canvas) < ids {
        return Ok(());
    }
    let mib = |bytes: f64| format!("{:.0} MiB", bytes / f64::from(1 << 20));
    let (needed, limit) = (mib(needed), mib(limit as f64));
    let (and_canvas, coarser) = if canvas > 0.0 {
        (format!(" and {canvas:.3e} of a canvas"), ", fewer canvas vertices per seed (`canvas_size`)")
    } else {
        (String::new(), "")
    };
    let work = format!("about {vertices:.3e} vertices{and_canvas}");
    let what = format!("{work} are estimated to need {needed} of memory; the limit is {limit}");
    let help =
        format!("ask for fewer vertices (`vertices`){coarser}, a coarser metric (`h_min`), or raise `memory_limit`");
    Err(Error::limit(what, help))
}

/// Metric length along a chain of edges, as a piecewise linear function of the parameter, which an edge adds one to.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MetricArc {
    /// Breakpoints (parameter, metric length from the start), both increasing.
    breaks: Vec<(f64, f64)>,
}

/// Halves that differ by more than this share are cut again: within a piece length grows almost linearly.
const UNEVEN: f64 = 0.05;
/// Relative error allowed for a piece's length.
const TOLERANCE: f64 = 1e-3;
const MAX_DEPTH: u32 = 16;

impl MetricArc {
    /// Measures so many edges, in pieces as fine as need be, of which `length` tells the lengths between parameters of one edge.
    pub(crate) fn new(edges: usize, length: impl Fn(f64, f64) -> f64) -> Self {
        let mut arc = Self { breaks: vec![(0.0, 0.0)] };
        for edge in 0..edges {
            let (from, to) = (edge as f64, (edge + 1) as f64);
            arc.measure(&length, (from, to), length(from, to), MAX_DEPTH);
        }
        arc
    }

    /// Of a straight edge in a field.
    pub(crate) fn of_chord(field: &dyn MetricField, [a, b]: [Point; 2]) -> Self {
        let at = nearby(field);
        Self::new(1, |s, t| chord_by(&at, a.lerp(b, s), a.lerp(b, t)))
    }

    /// Of two straight edges at once, by what is longer of them: the metric along both is the intersection of both.
    fn of_longer(field: &dyn MetricField, edges: [[Point; 2]; 2]) -> Self {
        let at = nearby(field);
        let length = |[a, b]: [Point; 2], s, t| chord_by(&at, a.lerp(b, s), a.lerp(b, t));
        Self::new(1, |s, t| length(edges[0], s, t).max(length(edges[1], s, t)))
    }

    /// Metric length of all edges.
    pub(crate) fn length(&self) -> f64 {
        self.breaks[self.breaks.len() - 1].1
    }

    /// The parameter at which a share (0..=1) of the metric length is behind.
    pub(crate) fn parameter(&self, share: f64) -> f64 {
        let target = share * self.length();
        let i = self.breaks.partition_point(|&(_, l)| l < target).clamp(1, self.breaks.len() - 1);
        let ((t0, l0), (t1, l1)) = (self.breaks[i - 1], self.breaks[i]);
        if l1 > l0 { t0 + (t1 - t0) * (target - l0) / (l1 - l0) } else { t1 }
    }

    fn measure(&mut self, length: &impl Fn(f64, f64) -> f64, (t0, t1): (f64, f64), whole: f64, depth: u32) {
        let middle = 0.5 * (t0 + t1);
        let (first, second) = (length(t0, middle), length(middle, t1));
        let sum = first + second;
        let settled = (sum - whole).abs() <= TOLERANCE * sum && (first - second).abs() <= UNEVEN * sum;
        if settled || depth == 0 || sum.is_nan() {
            let behind = self.length();
            self.breaks.extend([(middle, behind + first), (t1, behind + sum)]);
        } else {
            self.measure(length, (t0, middle), first, depth - 1);
            self.measure(length, (middle, t1), second, depth - 1);
        }
    }
}

/// How many edges a segment of this metric length is cut into: the nearest whole number, at least one.
pub(crate) fn pieces(length: f64) -> usize {
    // Saturates: an absurd length is caught by the estimate of the work before anything is cut.
    (length.round() as usize).max(1)
}

/// How much longer or shorter edges may be that come of halving than they should be.
const BY_HALVING: f64 = 1.15;

/// How many edges a segment of this metric length is cut into, if they are halved up to so many times later.
fn pieces_to_halve(length: f64, halvings: u32) -> usize {
    let tried = (1..=halvings).rev().map(|times| {
        let n = pieces(length / f64::from(1 << times));
        (n, length / (n << times) as f64)
    });
    let fits = |&(_, each): &(usize, f64)| (BY_HALVING.recip()..=BY_HALVING).contains(&each);
    tried.into_iter().find(fits).map_or_else(|| pieces(length), |(n, _)| n)
}

/// Cuts every constrained edge of a fresh dual into edges of about unit metric length, once they are halved so many times; `arcs` are the edges' lengths
/// under the unscaled field, in order, and `scale` the field's factor. Required segments stay whole. What is cut like its twin stays as it
/// is from then on.
///
/// A cut that rounding would make invalid is left out. Returns the number of new vertices.
pub(crate) fn sample_segments(
    dual: &mut Dual,
    edges: &[Stretch],
    arcs: &[MetricArc],
    scale: f64,
    halvings: u32,
) -> usize {
    let before = dual.vertex_count();
    for (&Stretch { ends, required, twin }, arc) in edges.iter().zip(arcs) {
        if required {
            continue;
        }
        let n = pieces_to_halve(arc.length() * scale.sqrt(), halvings);
        let [a, b] = ends.map(|v| dual.position(v));
        let cuts: Vec<Point> = (1..n).map(|k| a.lerp(b, arc.parameter(k as f64 / n as f64))).collect();
        let sides =
            [Some((ends, cuts.clone())), twin.map(|(ends, by)| (ends, cuts.iter().map(|&p| by.image(p)).collect()))];
        for (ends, cuts) in sides.into_iter().flatten() {
            let segment = dual.topology().edge_between(ends[0], ends[1]).and_then(|h| dual.topology().constraint(h));
            let new = cut(dual, ends, &cuts);
            if let Some(segment) = segment.filter(|_| twin.is_some()) {
                dual.hold(segment, &new);
            }
        }
    }
    dual.vertex_count() - before
}

/// Cuts an edge at points along it, the middle one first: one after the other, each would take over the whole fan of
/// the wall opposite, in quadratic time. Returns the new vertices.
fn cut(dual: &mut Dual, [from, to]: [VertexId; 2], points: &[Point]) -> Vec<VertexId> {
    let (mut pending, mut new) = (vec![(from, to, 0..points.len())], Vec::new());
    while let Some((from, to, range)) = pending.pop() {
        let Some(h) = dual.topology().edge_between(from, to) else { continue };
        let middle = usize::midpoint(range.start, range.end);
        let candidates = (middle..range.end).chain((range.start..middle).rev());
        let done = candidates.into_iter().find_map(|k| Some((k, dual.insert_on_edge(h, points[k])?)));
        if let Some((k, v)) = done {
            new.push(v);
            pending.extend([(v, to, k + 1..range.end), (from, v, range.start..k)]);
        }
    }
    new
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Tensor, Vector};
    use crate::manifold::domain::Domain;
    use crate::metric::Scaled;
    use crate::sampling::Plan;

    /// The first flips of the dual number half-edges anew.
    #[test]
    fn every_side_is_cut_by_its_own_metric() {
        let domain = Domain::shape("rect:0,0,1,1").unwrap();
        // Thin across one diagonal or the other, so that one of them is flipped; fine on one side.
        for across in [Vector::new(1.0, 1.0), Vector::new(1.0, -1.0)] {
            let field = |p: Point| {
                Tensor::IDENTITY * 16.0
                    + Tensor::square(across) * 64.0
                    + Tensor::new(0.0, 0.0, 4e4 * (-20.0 * p.x).exp())
            };
            let plan = Plan::new(domain.clone(), Vec::new(), &field, crate::sampling::Target::Metric).unwrap();
            let mut dual = Dual::new(domain.corners(), Scaled { field: &field, factor: 1.0 }).unwrap();
            sample_segments(&mut dual, &plan.edges, &plan.arcs, 1.0, 0);
            let edges = dual.topology().edges().filter(|&h| dual.topology().constraint(h).is_some());
            let lengths: Vec<f64> = edges.map(|h| dual.edge_length(h)).collect();
            assert!(lengths.iter().all(|length| (0.7..1.4).contains(length)), "{lengths:?}");
        }
    }

    #[test]
    fn walls_face_to_face_are_cut_in_little_time() {
        let domain = Domain::shape("rect:0,0,1,1e-6").unwrap();
        let field = |_: Point| Tensor::isotropic(1e-4);
        let plan = Plan::new(domain.clone(), Vec::new(), &field, crate::sampling::Target::Metric).unwrap();
        let mut dual = Dual::new(domain.corners(), Scaled { field: &field, factor: 1.0 }).unwrap();
        assert_eq!(sample_segments(&mut dual, &plan.edges, &plan.arcs, 1.0, 0), 2 * 9_999);
        assert!(dual.counters().flips < 40 * 10_000, "{}", dual.counters().flips);
    }

    #[test]
    fn arc_length_of_the_half_plane_is_a_logarithm() {
        let field = |p: Point| Tensor::isotropic(p.y);
        let arc = MetricArc::of_chord(&field, [Point::new(0.0, 1e-3), Point::new(0.0, 1.0)]);
        let exact = 1e3_f64.ln();
        assert!((arc.length() / exact - 1.0).abs() < 1e-3, "{}", arc.length());
        for share in [0.1, 0.5, 0.9] {
            let y = 1e-3 + (1.0 - 1e-3) * arc.parameter(share);
            assert!(((y / 1e-3).ln() / exact - share).abs() < 5e-3);
        }
    }
}
