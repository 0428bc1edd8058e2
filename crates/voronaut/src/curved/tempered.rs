//! A metric that is as fine as another one everywhere, and less anisotropic.

use crate::elementary::Elementary;
use crate::geometry::{Point, Tensor};
use crate::metric::{MetricField, Near};

/// Another metric with its anisotropy raised to a power from 0, isotropic, to 1, as it is; its determinant stays.
#[derive(Clone, Copy)]
pub(crate) struct Tempered<'a> {
    pub(crate) field: &'a dyn MetricField,
    pub(crate) power: f64,
}

impl Tempered<'_> {
    fn temper(&self, m: Tensor) -> Tensor {
        let mean = m.determinant().sqrt();
        if self.power >= 1.0 || mean.is_nan() || mean <= 0.0 {
            return m;
        }
        m.map_both_eigenvalues(|[greater, _]| {
            let ratio = (greater / mean).raised_to(self.power);
            [mean * ratio, mean / ratio]
        })
    }
}

impl MetricField for Tempered<'_> {
    fn at(&self, p: Point) -> Tensor {
        self.temper(self.field.at(p))
    }

    fn at_near(&self, p: Point, near: &mut Near) -> Tensor {
        self.temper(self.field.at_near(p, near))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vector;

    #[test]
    fn axes_and_determinant_stay() {
        let m = Tensor::from_axis(Vector::new(0.6, 0.8), 16.0, 1.0);
        let got = Tempered { field: &move |_: Point| m, power: 0.5 }.at(Point::new(0.0, 0.0)).eigen();
        assert!((got.large - 8.0).abs() < 1e-12 && (got.small - 2.0).abs() < 1e-12);
        assert!(got.axis.cross(Vector::new(0.6, 0.8)).abs() < 1e-12);
    }
}
