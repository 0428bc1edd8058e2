//! Newton steps on the energy of a path: the sum of e = d' M(m) d over its segments d, the tensor taken at their middles m.

use crate::geometry::{Point, Tensor, Vector};
use crate::metric::{MetricField, nearby};

/// Derivatives are differences over this share of a segment.
const STEP: f64 = 0.1;

/// A segment's energy to second order in its ends.
struct Segment {
    /// Gradient by the first and by the second end.
    gradient: [Vector; 2],
    /// Second derivatives by each end.
    own: [Tensor; 2],
    /// Mixed second derivatives by columns: by the first end, and by x and y of the second.
    mixed: [Vector; 2],
    /// 2 M: the Hessian of a path with frozen tensors.
    frozen: Tensor,
}

impl Segment {
    fn of(field: impl Fn(Point) -> Tensor, p: Point, q: Point) -> Self {
        let (m, d) = (p.midpoint(q), q - p);
        let h = STEP * d.norm();
        let [ex, ey] = [Vector::new(h, 0.0), Vector::new(0.0, h)];
        let at = field(m);
        let [[xp, xm], [yp, ym], [both, neither]] = [ex, ey, ex + ey].map(|e| [field(m + e), field(m - e)]);
        let [dx, dy] = [xp - xm, yp - ym].map(|difference| difference * (0.5 / h));
        let second = |sum: Tensor| (sum + at * -2.0).dot(d, d) / (h * h);
        let (qxx, qyy) = (second(xp + xm), second(yp + ym));
        let qxy = 0.5 * (second(both + neither) - qxx - qyy);
        let quarter = Tensor::new(qxx, qxy, qyy) * 0.25;
        let [bx, by] = [dx.apply(d), dy.apply(d)];
        let twist = Tensor::new(2.0 * bx.x, bx.y + by.x, 2.0 * by.y);
        let (frozen, pull) = (at * 2.0, Vector::new(dx.dot(d, d), dy.dot(d, d)) * 0.5);
        let ahead = at.apply(d) * 2.0;
        // -2 M - B + B' + Q / 4, where B has the columns bx and by.
        let skew = by.x - bx.y;
        Self {
            gradient: [pull - ahead, pull + ahead],
            own: [frozen - twist + quarter, frozen + twist + quarter],
            mixed: [
                Vector::new(quarter.xx - frozen.xx, quarter.xy - frozen.xy + skew),
                Vector::new(quarter.xy - frozen.xy - skew, quarter.yy - frozen.yy),
            ],
            frozen,
        }
    }
}

/// How the energy of a path changes with its points, to second order.
pub(super) struct Expansion {
    segments: Vec<Segment>,
}

impl Expansion {
    pub(super) fn of(field: &dyn MetricField, path: &[Point]) -> Self {
        let field = nearby(field);
        Self { segments: path.windows(2).map(|w| Segment::of(&field, w[0], w[1])).collect() }
    }

    /// The Newton step of all points; ends and held points stay. `damping` times the Hessian of frozen tensors, which is
    /// positive definite, is added (Levenberg 1944). `None` where the sum is not positive definite.
    pub(super) fn step(&self, held: &[bool], damping: f64) -> Option<Vec<Vector>> {
        let n = self.segments.len();
        let mut eliminated: Vec<(Tensor, [Vector; 2], Vector)> = Vec::with_capacity(n);
        for i in 1..n {
            let (before, after) = (&self.segments[i - 1], &self.segments[i]);
            let mut block = before.own[1] + after.own[0] + (before.frozen + after.frozen) * damping;
            let mut right = -(before.gradient[1] + after.gradient[0]);
            let mut coupling: [Vector; 2] = [0, 1].map(|k| after.mixed[k] - column(after.frozen, k) * damping);
            if held[i] {
                (block, right) = (Tensor::IDENTITY, Vector::default());
            }
            if held[i] || held[i + 1] {
                coupling = [Vector::default(); 2];
            }
            if let Some((inverse, [u, v], earlier)) = eliminated.last() {
                let [iu, iv, ir] = [*u, *v, *earlier].map(|x| inverse.apply(x));
                block = block - Tensor::new(u.dot(iu), u.dot(iv), v.dot(iv));
                right = right - Vector::new(u.dot(ir), v.dot(ir));
            }
            if !block.is_positive_definite() {
                return None;
            }
            eliminated.push((block.inverse(), coupling, right));
        }
        let mut step = vec![Vector::default(); n + 1];
        for (i, (inverse, [u, v], right)) in eliminated.into_iter().enumerate().rev() {
            let next = step[i + 2];
            step[i + 1] = inverse.apply(right - (u * next.x + v * next.y));
        }
        step.iter().all(|s| s.x.is_finite() && s.y.is_finite()).then_some(step)
    }
}

fn column(tensor: Tensor, k: usize) -> Vector {
    if k == 0 { Vector::new(tensor.xx, tensor.xy) } else { Vector::new(tensor.xy, tensor.yy) }
}

/// The energy of a path; infinite where the metric is not positive definite.
pub(super) fn energy(field: &dyn MetricField, path: &[Point]) -> f64 {
    let at = nearby(field);
    let of_segment = |w: &[Point]| {
        let tensor = at(w[0].midpoint(w[1]));
        if tensor.is_positive_definite() { tensor.dot(w[1] - w[0], w[1] - w[0]) } else { f64::INFINITY }
    };
    path.windows(2).map(of_segment).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_solve_the_linearised_equations() {
        let field = |p: Point| Tensor::new(1.0 + p.x * p.x, 0.3 * p.y, 2.0 + (p.x + p.y).sin());
        let path: Vec<Point> = (0..6).map(|i| Point::new(0.2 * f64::from(i), 0.1 * f64::from(i * i % 5))).collect();
        let step = Expansion::of(&field, &path).step(&[false; 6], 0.0).unwrap();
        let gradient = |t: f64, i: usize, e: Vector| {
            let moved: Vec<Point> = path.iter().zip(&step).map(|(&p, &s)| p + s * t).collect();
            let with = |h: f64| {
                let mut path = moved.clone();
                path[i] = path[i] + e * h;
                energy(&field, &path)
            };
            (with(1e-5) - with(-1e-5)) / 2e-5
        };
        // Along the step the gradient falls to zero, up to second order.
        for i in 1..5 {
            for e in [Vector::new(1.0, 0.0), Vector::new(0.0, 1.0)] {
                let (at_start, slightly) = (gradient(0.0, i, e), gradient(0.01, i, e));
                assert!((slightly - 0.99 * at_start).abs() < 1e-3, "{i} {at_start} {slightly}");
            }
        }
        let held = Expansion::of(&field, &path).step(&[true, false, true, false, false, true], 0.0).unwrap();
        assert!(held[2] == Vector::default() && held[1] != Vector::default());
    }
}
