//! The metric around a point to second order: tensor, Christoffel symbols, logarithm and exponential map.

use crate::geometry::{Point, Tensor, Vector, from_frame};
use crate::metric::{MetricField, Near};
use std::f64::consts::FRAC_1_SQRT_2;

/// Finite differences are taken over this share of the metric unit length: at the scale of a cell, so that noise of
/// the field does not pass for curvature (DESIGN.md, "Rough metrics").
const DIFFERENCE_STEP: f64 = 0.25;
/// A field whose second differences over that step exceed this share of the tensor is rough there.
const ROUGH: f64 = 0.08;
/// What the metric is at points that have moved by less than this (metric) since it was measured follows from what was found.
pub(crate) const STILL: f64 = 0.05;
/// Directions and radius (metric units) of the samples over which a rough field is averaged.
const RING: usize = 8;
const RING_RADIUS: f64 = 0.5;
/// Half of the directions; the others are opposite.
const DIRECTIONS: [[f64; 2]; RING / 2] =
    [[1.0, 0.0], [FRAC_1_SQRT_2, FRAC_1_SQRT_2], [0.0, 1.0], [-FRAC_1_SQRT_2, FRAC_1_SQRT_2]];

/// The metric tensor at a point and its first derivatives.
///
/// Where the field is *rough* - kinked or jumping within a cell, as near the medial axis of a jagged coast - no
/// expansion at a point describes it. There the tensor is the mean over a ball about a unit wide, and the derivatives
/// are those of the best linear fit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct LocalMetric {
    /// The tensor M.
    pub tensor: Tensor,
    /// dM/dx and dM/dy.
    pub derivative: [Tensor; 2],
    /// Whether the field is rough here.
    pub is_rough: bool,
    /// Where the field found the point.
    pub near: Near,
    /// How far the point has moved since the field was evaluated.
    pub since: Vector,
}

impl LocalMetric {
    /// Evaluates the field at p and, for the derivatives, at four points a quarter of a metric unit away along the
    /// tensor's axes; at eight more where it is rough. Where the field is no metric at one of the points around p (a
    /// field may end with the domain) the derivative counts as zero.
    pub(crate) fn at(field: &dyn MetricField, p: Point) -> Self {
        Self::at_near(field, p, Near::default())
    }

    /// The same, where the field may be looked for at a place nearby.
    pub(crate) fn at_near(field: &dyn MetricField, p: Point, mut near: Near) -> Self {
        let tensor = field.at_near(p, &mut near);
        Self::around(field, p, tensor, near)
    }

    /// The same, where the tensor at the point is known.
    pub(crate) fn at_known(field: &dyn MetricField, p: Point, tensor: Tensor) -> Self {
        Self::around(field, p, tensor, Near::default())
    }

    fn around(field: &dyn MetricField, p: Point, tensor: Tensor, near: Near) -> Self {
        let (found, second) = Self::expanded(field, p, tensor, near);
        if second > ROUGH { Self::averaged(field, p, tensor, near) } else { found }
    }

    /// [`LocalMetric::at`] at a point that a seed has moved to: rough if the seed was so before. So understood it
    /// depends continuously on the point.
    #[must_use]
    pub(crate) fn moved(&self, field: &dyn MetricField, p: Point) -> Self {
        let mut near = self.near;
        let tensor = field.at_near(p, &mut near);
        Self { near, ..*self }.moved_to(field, p, tensor)
    }

    /// The same, where the tensor at the point is known.
    #[must_use]
    pub(crate) fn moved_to(&self, field: &dyn MetricField, p: Point, tensor: Tensor) -> Self {
        let near = self.near;
        if self.is_rough { Self::averaged(field, p, tensor, near) } else { Self::expanded(field, p, tensor, near).0 }
    }

    /// What derivatives say of a point beside this one, without evaluating the field.
    #[must_use]
    pub(crate) fn carried(&self, by: Vector) -> Self {
        Self { tensor: self.tensor + self.derivative_along(by), since: self.since + by, ..*self }
    }

    /// The same of the field times a factor near one: rough where it was.
    #[must_use]
    pub(crate) fn times(&self, factor: f64) -> Self {
        Self { tensor: self.tensor * factor, derivative: self.derivative.map(|along| along * factor), ..*self }
    }

    /// Whether that is so far from where the field was evaluated that it has to be evaluated again.
    pub(crate) fn is_due(&self) -> bool {
        self.since != Vector::default()
            && !(self.tensor.length(self.since) < STILL && self.tensor.is_positive_definite())
    }

    /// By differences along the axes, and the size of the second ones relative to the tensor.
    fn expanded(field: &dyn MetricField, p: Point, tensor: Tensor, near: Near) -> (Self, f64) {
        let beside = |p: Point| field.at_near(p, &mut near.clone());
        let eigen = tensor.eigen();
        let axes = [eigen.axis, eigen.axis.perpendicular()];
        let steps = [eigen.large, eigen.small].map(|eigenvalue| DIFFERENCE_STEP / eigenvalue.sqrt());
        let mut along = [Tensor::default(); 2];
        let mut second = 0.0_f64;
        for i in 0..2 {
            let offset = axes[i] * steps[i];
            let (ahead, behind) = (beside(p + offset), beside(p - offset));
            if ahead.is_positive_definite() && behind.is_positive_definite() {
                along[i] = (ahead - behind) * (0.5 / steps[i]);
                second = second.max(relative_size((ahead + behind) * 0.5 - tensor, axes, steps));
            }
        }
        let [u, v] = axes;
        let derivative = [along[0] * u.x + along[1] * v.x, along[0] * u.y + along[1] * v.y];
        (Self { tensor, derivative, is_rough: false, near, since: Vector::default() }, second)
    }

    /// The mean over the centre and a ring, and the derivatives of the linear function that fits the ring best; the
    /// ring is the circle of half a unit in the tensor at the centre.
    fn averaged(field: &dyn MetricField, p: Point, centre: Tensor, near: Near) -> Self {
        let beside = |p: Point| field.at_near(p, &mut near.clone());
        let [a, b, c] = centre.cholesky();
        let (mut sum, mut number, mut slopes) = (centre, 1.0, [Tensor::default(); 2]);
        for [cos, sin] in DIRECTIONS {
            let offset = from_frame([a, b, c], Vector::new(cos, sin)) * RING_RADIUS;
            let (ahead, behind) = (beside(p + offset), beside(p - offset));
            if ahead.is_positive_definite() && behind.is_positive_definite() {
                (sum, number) = (sum + ahead + behind, number + 2.0);
                let difference = ahead - behind;
                slopes = [slopes[0] + difference * cos, slopes[1] + difference * sin];
            }
        }
        // Along the two axes of the frame F v = (a x + b y, c y), then back: d/dx = a d/du, d/dy = b d/du + c d/dv.
        let scale = 2.0 / (RING as f64 * RING_RADIUS);
        let [du, dv] = slopes.map(|slope| slope * scale);
        Self {
            tensor: sum * (1.0 / number),
            derivative: [du * a, du * b + dv * c],
            is_rough: true,
            near,
            since: Vector::default(),
        }
    }

    /// The derivative of the tensor along a vector.
    pub(crate) fn derivative_along(&self, v: Vector) -> Tensor {
        self.derivative[0] * v.x + self.derivative[1] * v.y
    }

    /// Gamma(v, v), the Christoffel symbols of the second kind applied twice to a vector: a geodesic that leaves with
    /// velocity v has the coordinate acceleration -Gamma(v, v).
    pub(crate) fn christoffel(&self, v: Vector) -> Vector {
        self.tensor.solve(self.bend(v))
    }

    /// M Gamma(v, v), the Christoffel symbols of the first kind: (v . grad) M v less half the gradient of v' M v, term by term.
    pub(crate) fn bend(&self, v: Vector) -> Vector {
        let [dx, dy] = self.derivative;
        let (xx, xy, yy) = (v.x * v.x, v.x * v.y, v.y * v.y);
        Vector::new(
            0.5 * dx.xx * xx + dy.xx * xy + (dy.xy - 0.5 * dx.yy) * yy,
            (dx.xy - 0.5 * dy.xx) * xx + dx.yy * xy + 0.5 * dy.yy * yy,
        )
    }

    /// The logarithm map to second order: the initial velocity of the geodesic that reaches p + d at time one,
    /// d + Gamma(d, d) / 2. Where the correction is large (kinks, edges far too long) it is cut to a third of d.
    pub(crate) fn log(&self, d: Vector) -> Vector {
        d + self.bounded_correction(d)
    }

    /// The exponential map to second order: v - Gamma(v, v) / 2, cut like [`LocalMetric::log`].
    pub(crate) fn exp(&self, v: Vector) -> Vector {
        v - self.bounded_correction(v)
    }

    fn bounded_correction(&self, v: Vector) -> Vector {
        let correction = self.christoffel(v) * 0.5;
        let (square, limit) = (self.tensor.dot(correction, correction), self.tensor.dot(v, v) / 9.0);
        if square <= limit {
            correction
        } else if square.is_finite() {
            correction * (limit.max(0.0) / square).sqrt()
        } else {
            Vector::default()
        }
    }
}

/// The size of a difference of tensors relative to the tensor with these axes, whose metric lengths over `steps` are
/// [`DIFFERENCE_STEP`].
fn relative_size(difference: Tensor, axes: [Vector; 2], steps: [f64; 2]) -> f64 {
    let [u, v] = [axes[0] * steps[0], axes[1] * steps[1]];
    let entries = [difference.dot(u, u), difference.dot(u, v), difference.dot(v, v)];
    entries.iter().fold(0.0_f64, |size, entry| size.max(entry.abs())) / (DIFFERENCE_STEP * DIFFERENCE_STEP)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Flat space seen through phi(x, y) = (x + y^2 / 5, y): geodesics are straight in phi.
    fn pulled_back(p: Point) -> Tensor {
        let a = 0.4 * p.y;
        Tensor::new(1.0, a, 1.0 + a * a)
    }

    fn phi(p: Point) -> Vector {
        Vector::new(p.x + 0.2 * p.y * p.y, p.y)
    }

    #[test]
    fn logarithm_is_second_order_on_a_pull_back_of_flat_space() {
        let p = Point::new(0.3, 0.7);
        let local = LocalMetric::at(&pulled_back, p);
        let error = |h: f64| {
            let d = Vector::new(0.6, -0.8) * h;
            let image = phi(p + d) - phi(p);
            // dphi = ((1, 0.4 y), (0, 1)) maps velocities to the flat plane.
            let v = local.log(d);
            (Vector::new(v.x + 0.4 * p.y * v.y, v.y) - image).norm()
        };
        // This phi is quadratic, so that the second-order map is exact.
        assert!(error(0.1) < 1e-12 && error(0.2) < 1e-12);
        let v = Vector::new(0.05, 0.02);
        assert!((local.log(local.exp(v)) - v).norm() < 2.0 * v.norm().powi(3));
    }

    #[test]
    fn derivatives_tell_of_points_nearby_and_say_when_they_do_not() {
        let linear = |p: Point| Tensor::new(4.0 + p.x, 0.5 * p.y, 3.0 - p.x);
        let (p, by) = (Point::new(0.1, 0.2), Vector::new(0.01, -0.015));
        let (carried, there) = (LocalMetric::at(&linear, p).carried(by), linear(p + by));
        let off = carried.tensor - there;
        assert!(off.xx.abs() + off.xy.abs() + off.yy.abs() < 1e-14 && !carried.is_due());
        // Two steps are one as long, and beyond a twentieth of a unit the field has to be asked.
        assert!(carried.carried(by).is_due() && !LocalMetric::at(&linear, p).is_due());
        assert!(!carried.moved(&linear, p + by).is_due());
    }

    #[test]
    fn half_plane_christoffel_symbols() {
        let half_plane = |p: Point| Tensor::isotropic(p.y);
        // Differences over a quarter unit see 1 / y^2 through a wide window; a fine metric takes a narrow one.
        let fine = |p: Point| half_plane(p) * 1e6;
        let local = LocalMetric::at(&fine, Point::new(0.0, 2.0));
        let g = local.christoffel(Vector::new(1.0, 0.0));
        assert!(g.x.abs() < 1e-6 && (g.y - 0.5).abs() < 1e-6, "{g:?}");
        let g = local.christoffel(Vector::new(1.0, 1.0));
        assert!((g.x + 1.0).abs() < 1e-6 && g.y.abs() < 1e-6, "{g:?}");
    }
}
