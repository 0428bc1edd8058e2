//! The metric around a point to second order: tensor, Christoffel symbols, logarithm and exponential map.

use crate::geometry::{Point, Tensor, Vector};
use crate::metric::MetricField;

/// Finite differences are taken over this share of the metric unit length: at the scale of a cell, so that a kink or
/// the noise of a sampled field does not pass for curvature (DESIGN.md, "Christoffel symbols").
const DIFFERENCE_STEP: f64 = 0.25;

/// The metric tensor at a point and its first derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LocalMetric {
    /// The tensor M.
    pub tensor: Tensor,
    /// dM/dx and dM/dy.
    pub derivative: [Tensor; 2],
}

impl LocalMetric {
    /// Evaluates the field at p and, for the derivatives, at four points a quarter of a metric unit away along the
    /// tensor's axes. Where one of those is no metric (a field may end with the domain) the derivative counts as zero.
    pub fn at(field: &dyn MetricField, p: Point) -> Self {
        let tensor = field.at(p);
        let eigen = tensor.eigen();
        let [u, v] = [eigen.axis, eigen.axis.perpendicular()];
        let along = |axis: Vector, eigenvalue: f64| {
            let step = DIFFERENCE_STEP / eigenvalue.sqrt();
            let (ahead, behind) = (field.at(p + axis * step), field.at(p - axis * step));
            let valid = ahead.is_positive_definite() && behind.is_positive_definite();
            if valid { (ahead + behind * -1.0) * (0.5 / step) } else { Tensor::default() }
        };
        let (du, dv) = (along(u, eigen.large), along(v, eigen.small));
        Self { tensor, derivative: [du * u.x + dv * v.x, du * u.y + dv * v.y] }
    }

    /// The derivative of the tensor along a vector.
    pub fn derivative_along(&self, v: Vector) -> Tensor {
        self.derivative[0] * v.x + self.derivative[1] * v.y
    }

    /// Gamma(v, v), the Christoffel symbols of the second kind applied twice to a vector: a geodesic that leaves with
    /// velocity v has the coordinate acceleration -Gamma(v, v).
    pub fn christoffel(&self, v: Vector) -> Vector {
        let along = self.derivative_along(v).apply(v);
        let gradient = Vector::new(self.derivative[0].dot(v, v), self.derivative[1].dot(v, v));
        self.tensor.inverse().apply(along - gradient * 0.5)
    }

    /// The logarithm map to second order: the initial velocity of the geodesic that reaches p + d at time one,
    /// d + Gamma(d, d) / 2. Where the correction is large (kinks, edges far too long) it is cut to a third of d.
    pub fn log(&self, d: Vector) -> Vector {
        d + self.bounded_correction(d)
    }

    /// The exponential map to second order: v - Gamma(v, v) / 2, cut like [`LocalMetric::log`].
    pub fn exp(&self, v: Vector) -> Vector {
        v - self.bounded_correction(v)
    }

    fn bounded_correction(&self, v: Vector) -> Vector {
        let correction = self.christoffel(v) * 0.5;
        let (size, limit) = (self.tensor.length(correction), self.tensor.length(v) / 3.0);
        if size <= limit {
            correction
        } else if size.is_finite() {
            correction * (limit / size)
        } else {
            Vector::default()
        }
    }
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
