//! Another field times a factor: the same everywhere, as a mesh is given its number of vertices, or more where the field turns, as
//! star sets come to agree.

use super::{MetricField, Near};
use crate::elementary::Elementary;
use crate::geometry::{Aabb, Point, Tensor};

/// The field `factor` M: metric lengths grow by sqrt(factor), the complexity (see [`complexity`](super::complexity()))
/// by `factor`. The factor is positive and finite; any other gives tensors that
/// `check_tensor` rejects.
#[derive(Clone, Copy)]
pub struct Scaled<'a> {
    /// The field M.
    pub field: &'a dyn MetricField,
    /// What its tensors are multiplied by.
    pub factor: f64,
}

impl MetricField for Scaled<'_> {
    fn at(&self, p: Point) -> Tensor {
        self.field.at(p) * self.factor
    }

    fn at_near(&self, p: Point, near: &mut Near) -> Tensor {
        self.field.at_near(p, near) * self.factor
    }

    fn integral(&self, area: f64, bounds: Aabb, share: f64) -> Option<f64> {
        Some(self.field.integral(area, bounds, share)? * self.factor)
    }
}

/// The step over which a field is seen to turn, in its units.
const STEP: f64 = 0.05;

/// Another field times a factor at each place, such that its shape turns by about [`Steadied::most`] over a unit of the
/// product, no more. Where it turns less the factor is close to one.
///
/// A factor leaves the shape of a tensor as it is, and Delaunay triangles in it. The turn from M to N is half the
/// logarithm of the ratio of the eigenvalues of M^-1 N: that of Boissonnat et al.'s distortion, without change of size.
#[derive(Clone, Copy)]
pub(crate) struct Steadied<'a> {
    /// The field, in units of the wanted edge length.
    pub field: &'a dyn MetricField,
    /// How much it may turn; positive.
    pub most: f64,
}

impl MetricField for Steadied<'_> {
    fn at(&self, p: Point) -> Tensor {
        let tensor = self.field.at(p);
        if !tensor.is_positive_definite() {
            return tensor;
        }
        let excess = self.turn(p, tensor) / self.most;
        tensor * (1.0 + excess.powi(4)).sqrt()
    }
}

impl Steadied<'_> {
    /// How much the field turns for each unit, along both axes of a frame.
    fn turn(&self, p: Point, tensor: Tensor) -> f64 {
        let [_, axes] = tensor.frames();
        let [x, y] = axes.map(|axis| {
            let away = axis * (0.5 * STEP);
            turn(self.field.at(p + away), self.field.at(p - away)) / STEP
        });
        x.hypotenuse(y)
    }
}

/// The turn from one tensor to another; 0 where one is none.
fn turn(m: Tensor, n: Tensor) -> f64 {
    let square = m.determinant() * n.determinant();
    // Half the trace of M^-1 N over the root of its determinant: the hyperbolic cosine of the turn.
    let cosine = 0.5 * (m.yy * n.xx - 2.0 * m.xy * n.xy + m.xx * n.yy) / square.sqrt();
    if cosine.is_finite() { cosine.max(1.0).area_cosine() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vector;
    use crate::metric::Uniform;

    #[test]
    fn scales_the_tensor() {
        let field = Uniform(Tensor::new(2.0, 0.5, 1.0));
        let scaled = Scaled { field: &field, factor: 4.0 };
        assert_eq!(scaled.at(Point::new(3.0, 1.0)), Tensor::new(8.0, 2.0, 4.0));
    }

    /// Cells that are three times as long as wide, along a direction that turns by `rate` radians for each unit of x.
    fn turning(rate: f64) -> impl Fn(Point) -> Tensor + Sync {
        move |p: Point| Tensor::from_axis(Vector::new((rate * p.x).cos(), (rate * p.x).sin()), 1.0, 9.0)
    }

    #[test]
    fn what_does_not_turn_stays() {
        let grows = |p: Point| Tensor::new(30.0, 5.0, 1.0) * (1.0 + p.x * p.x);
        let uniform = Uniform(Tensor::new(30.0, 5.0, 1.0));
        for field in [&grows as &dyn MetricField, &uniform] {
            let p = Point::new(0.3, 0.7);
            let got = Steadied { field, most: 0.5 }.at(p);
            assert!((got.xx / field.at(p).xx - 1.0).abs() < 1e-12 && (got.xy / field.at(p).xy - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_product_turns_by_what_it_may() {
        let field = turning(2.0);
        let steadied = Steadied { field: &field, most: 0.1 };
        let p = Point::new(0.0, 0.0);
        let (before, after) = (field(p), steadied.at(p));
        let unit = 1.0 / after.xx.sqrt();
        let turned = turn(field(Point::new(0.5 * unit, 0.0)), field(Point::new(-0.5 * unit, 0.0)));
        assert!((turned - 0.1).abs() < 0.01 && after.xx > 10.0 * before.xx, "{turned} {after:?}");
    }
}
