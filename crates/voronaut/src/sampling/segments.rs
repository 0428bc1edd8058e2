//! Segments of the boundary and of interfaces, sampled at unit metric length.

use crate::dual::Dual;
use crate::geodesic::chord;
use crate::geometry::Point;
use crate::metric::MetricField;
use crate::triangulation::{HalfEdge, VertexId};

/// Metric length along a straight segment, as a piecewise linear function of the parameter.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MetricArc {
    /// Breakpoints (parameter in 0..=1, metric length from the start), both increasing.
    breaks: Vec<(f64, f64)>,
}

/// Halves that differ by more than this share are cut again: within a piece length grows almost linearly.
const UNEVEN: f64 = 0.05;
/// Relative error allowed for a piece's length.
const TOLERANCE: f64 = 1e-3;
const MAX_DEPTH: u32 = 16;

impl MetricArc {
    /// Measures the segment a-b, with pieces as fine as the field needs.
    pub(crate) fn new(field: &dyn MetricField, a: Point, b: Point) -> Self {
        let mut arc = Self { breaks: vec![(0.0, 0.0)] };
        let whole = chord(field, a, b);
        arc.measure(&|t0, t1| chord(field, a.lerp(b, t0), a.lerp(b, t1)), (0.0, 1.0), whole, MAX_DEPTH);
        arc
    }

    /// Metric length of the whole segment.
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
pub(super) fn pieces(length: f64) -> usize {
    // Saturates: an absurd length is caught by the estimate of the work before anything is cut.
    (length.round() as usize).max(1)
}

/// Cuts every constrained edge of a fresh dual into edges of about unit metric length; `arcs` are the edges' lengths
/// under the unscaled field, in order, and `scale` the field's factor. Required segments stay whole.
///
/// A cut that rounding would make invalid is left out. Returns the number of new vertices.
pub(crate) fn sample_segments(dual: &mut Dual, edges: &[(HalfEdge, bool)], arcs: &[MetricArc], scale: f64) -> usize {
    let before = dual.vertex_count();
    let ends: Vec<_> = edges.iter().map(|&(h, _)| [dual.topology().origin(h), dual.topology().target(h)]).collect();
    for ((&(_, required), arc), [from, to]) in edges.iter().zip(arcs).zip(ends) {
        if required {
            continue;
        }
        let n = pieces(arc.length() * scale.sqrt());
        let (a, b) = (dual.position(from), dual.position(to));
        let cuts: Vec<Point> = (1..n).map(|k| a.lerp(b, arc.parameter(k as f64 / n as f64))).collect();
        cut(dual, from, to, &cuts);
    }
    dual.vertex_count() - before
}

/// Cuts an edge at points along it, the middle one first: one after the other, each would take over the whole fan of
/// the wall opposite, in quadratic time.
fn cut(dual: &mut Dual, from: VertexId, to: VertexId, points: &[Point]) {
    let mut pending = vec![(from, to, 0..points.len())];
    while let Some((from, to, range)) = pending.pop() {
        let Some(h) = dual.topology().find(from, to) else { continue };
        let middle = usize::midpoint(range.start, range.end);
        let candidates = (middle..range.end).chain((range.start..middle).rev());
        let done = candidates.into_iter().find_map(|k| dual.insert_on_edge(h, points[k]).map(|(v, _)| (k, v)));
        if let Some((k, v)) = done {
            pending.extend([(v, to, k + 1..range.end), (from, v, range.start..k)]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::Domain;
    use crate::geometry::Tensor;
    use crate::metric::Scaled;
    use crate::sampling::Plan;

    #[test]
    fn walls_face_to_face_are_cut_in_little_time() {
        let domain = Domain::shape("rect:0,0,1,1e-6").unwrap();
        let field = |_: Point| Tensor::isotropic(1e-4);
        let plan = Plan::new(&domain, &field, crate::sampling::Target::Metric).unwrap();
        let mut dual = Dual::new(&domain, Scaled { field: &field, factor: 1.0 }).unwrap();
        assert_eq!(sample_segments(&mut dual, &plan.edges, &plan.arcs, 1.0), 2 * 9_999);
        assert!(dual.counters().flips < 40 * 10_000, "{}", dual.counters().flips);
    }

    #[test]
    fn arc_length_of_the_half_plane_is_a_logarithm() {
        let field = |p: Point| Tensor::isotropic(p.y);
        let arc = MetricArc::new(&field, Point::new(0.0, 1e-3), Point::new(0.0, 1.0));
        let exact = 1e3_f64.ln();
        assert!((arc.length() / exact - 1.0).abs() < 1e-3, "{}", arc.length());
        for share in [0.1, 0.5, 0.9] {
            let y = 1e-3 + (1.0 - 1e-3) * arc.parameter(share);
            assert!(((y / 1e-3).ln() / exact - share).abs() < 5e-3);
        }
    }
}
