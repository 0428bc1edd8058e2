//! A metric field in affine coordinates, with its first two derivatives, and the Gauss curvature from them.

use crate::geometry::{Point, Tensor, Vector};
use crate::metric::{MetricField, nearby};

/// Step of the differences, in the frame's units: small enough for their truncation, large enough for rounding.
const STEP: f64 = 1.0 / 512.0;

/// Affine coordinates (u, v) of the plane. All that is computed in a frame is free of the user's scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    origin: Point,
    u: Vector,
    v: Vector,
}

impl Frame {
    /// The frame with p at (0, 0) and q at (1, 0), its axes orthogonal and of equal length in the tensor halfway;
    /// `None` where there is no such frame.
    pub(super) fn along(at: &dyn Fn(Point) -> Tensor, p: Point, q: Point) -> Option<Self> {
        let u = q - p;
        let tensor = at(p.midpoint(q));
        if !tensor.is_positive_definite() {
            return None;
        }
        let conjugate = tensor.apply(u).perpendicular();
        let v = conjugate * (tensor.length(u) / tensor.length(conjugate));
        (v.x.is_finite() && v.y.is_finite() && u.cross(v).abs() > 0.0).then_some(Self { origin: p, u, v })
    }

    /// The frame at p whose axes are those of the tensor, `size` units long.
    pub(super) fn at(p: Point, tensor: Tensor, size: f64) -> Self {
        let eigen = tensor.eigen();
        let [u, v] = [(eigen.axis, eigen.large), (eigen.axis.perpendicular(), eigen.small)]
            .map(|(axis, eigenvalue)| axis * (size / eigenvalue.sqrt()));
        Self { origin: p, u, v }
    }

    /// The place of the coordinates (u, v).
    pub(super) fn place(&self, x: Vector) -> Point {
        self.origin + (self.u * x.x + self.v * x.y)
    }

    /// A vector of the plane in the frame's coordinates.
    pub(super) fn vector(&self, d: Vector) -> Vector {
        Vector::new(d.cross(self.v), self.u.cross(d)) * (1.0 / self.u.cross(self.v))
    }

    /// The field at (u, v), in the frame's coordinates.
    pub(super) fn tensor(&self, at: &dyn Fn(Point) -> Tensor, x: Vector) -> Tensor {
        at(self.place(x)).along([self.u, self.v])
    }

    /// A covector of the frame as one of the plane: the inverse transpose of the axes.
    pub(super) fn covector(&self, g: Vector) -> Vector {
        let determinant = self.u.cross(self.v);
        Vector::new(self.v.y * g.x - self.u.y * g.y, self.u.x * g.y - self.v.x * g.x) * (1.0 / determinant)
    }
}

/// A field's value and derivatives at a point of a frame.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Jet {
    pub(super) tensor: Tensor,
    /// By u and by v.
    pub(super) first: [Tensor; 2],
    /// By u u, u v and v v.
    pub(super) second: [Tensor; 3],
}

impl Jet {
    /// The jet of a field whose value at `x` is known, by central differences: six evaluations. Derivatives count as
    /// zero where the field is no metric in one of the places around (it may end with the domain).
    pub(super) fn of(at: &dyn Fn(Point) -> Tensor, frame: &Frame, x: Vector, tensor: Tensor) -> Self {
        let [u, v] = [Vector::new(STEP, 0.0), Vector::new(0.0, STEP)];
        let around = [x + u, x - u, x + v, x - v, x + u + v, x - u - v].map(|x| frame.tensor(at, x));
        if !around.iter().all(|t| t.is_positive_definite()) {
            return Self { tensor, ..Self::default() };
        }
        let [east, west, north, south, both, neither] = around;
        let [ew, ns] = [east + west, north + south];
        let twice = tensor * 2.0;
        Self {
            tensor,
            first: [(east - west) * (0.5 / STEP), (north - south) * (0.5 / STEP)],
            second: [
                (ew - twice) * (1.0 / (STEP * STEP)),
                (both + neither + twice - (ew + ns)) * (0.5 / (STEP * STEP)),
                (ns - twice) * (1.0 / (STEP * STEP)),
            ],
        }
    }

    /// The Gauss curvature, one over the square of a metric length (Brioschi's formula).
    pub(super) fn curvature(&self) -> f64 {
        let Tensor { xx: e, xy: f, yy: g } = self.tensor;
        let [du, dv] = self.first;
        let [uu, uv, vv] = self.second;
        let corner = uv.xy - 0.5 * (vv.xx + uu.yy);
        let rows =
            determinant([[corner, 0.5 * du.xx, du.xy - 0.5 * dv.xx], [dv.xy - 0.5 * du.yy, e, f], [0.5 * dv.yy, f, g]]);
        let rest = determinant([[0.0, 0.5 * dv.xx, 0.5 * du.yy], [0.5 * dv.xx, e, f], [0.5 * du.yy, f, g]]);
        let area = self.tensor.determinant();
        (rows - rest) / (area * area)
    }
}

fn determinant([a, b, c]: [[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// The Gauss curvature of a field at p, in whose units of length the differences are taken over a few hundredths.
/// Ten places around must be in the field's range; where it is no metric the result may be NaN.
pub(crate) fn gauss_curvature(field: &dyn MetricField, p: Point) -> f64 {
    // Steps of a sixteenth of a unit.
    let at = nearby(field);
    let frame = Frame::at(p, at(p), 0.0625 / STEP);
    let x = Vector::default();
    Jet::of(&at, &frame, x, frame.tensor(&at, x)).curvature()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curvature_of_models() {
        let fine = 1e4;
        let half_plane = |p: Point| Tensor::isotropic(p.y) * fine;
        let sphere = |p: Point| Tensor::isotropic(0.5 * (1.0 + p.x * p.x + p.y * p.y)) * fine;
        let flat = |p: Point| {
            let a = 0.4 * p.y;
            Tensor::new(1.0, a, 1.0 + a * a) * fine
        };
        for (x, y) in [(0.3, 0.8), (-1.0, 2.0)] {
            let p = Point::new(x, y);
            assert!((gauss_curvature(&half_plane, p) * fine + 1.0).abs() < 1e-4);
            assert!((gauss_curvature(&sphere, p) * fine - 1.0).abs() < 1e-4);
            assert!((gauss_curvature(&flat, p) * fine).abs() < 1e-4);
        }
    }
}
