//! The metric of a function's second derivatives, known at every point.

use super::complexity::start;
use super::nodal::absolute;
use super::recovered::FLOOR;
use super::{MetricField, Norm, Snapshot};
use crate::error::{Error, Result};
use crate::geometry::{Point, Tensor};

/// The metric in which a unit mesh has the least L^p error of linear interpolation of a function (Loseille and Alauzet 2011): its
/// Hessian's absolute value (`Norm::weighted`), from exact derivatives. It is defined up to a factor: scale it to a number of
/// vertices or a complexity.
#[derive(Clone, Debug)]
pub struct Hessian {
    function: Snapshot,
    norm: Norm,
    floor: f64,
}

impl Hessian {
    /// Of a function on a domain that these triangles cover.
    ///
    /// # Errors
    /// [`Error::Metric`] where a second derivative is not finite, or where all are zero; [`Error::Domain`] of triangles that are
    /// not finite.
    pub(crate) fn new(function: Snapshot, norm: Norm, domain: &[[Point; 3]]) -> Result<Self> {
        let (mut sum, mut total) = (0.0, 0.0);
        for ([a, b, c], _) in start(domain)? {
            let middle = Point::new((a.x + b.x + c.x) / 3.0, (a.y + b.y + c.y) / 3.0);
            let e = function.second_derivatives(middle).eigen();
            let greatest = e.large.abs().max(e.small.abs());
            if !greatest.is_finite() {
                let what = "the function's second derivatives are not finite";
                let help = "give a function with two derivatives in the whole domain";
                return Err(Error::metric(what, middle.to_string(), help));
            }
            let area = (b - a).cross(c - a).abs();
            (sum, total) = (sum + area * greatest, total + area);
        }
        let floor = FLOOR * sum / total;
        if floor > 0.0 {
            return Ok(Self { function, norm, floor });
        }
        let help = "what is linear needs no mesh, and kinks and jumps have no second derivatives: use another metric, or give values at \
                    the vertices of a fine mesh (hessian:FILE.sol)";
        Err(Error::metric("the function's second derivatives vanish everywhere", "all points looked at", help))
    }
}

impl MetricField for Hessian {
    fn at(&self, p: Point) -> Tensor {
        self.norm.weighted(absolute(self.function.second_derivatives(p), self.floor))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metric::{Expression, Variables};

    fn hessian(text: &str, norm: Norm) -> Result<Hessian> {
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| Point::new(x, y));
        let halves = [[square[0], square[1], square[2]], [square[0], square[2], square[3]]];
        Hessian::new(Expression::parse(text, Variables::Plane)?.into(), norm, &halves)
    }

    fn assert_close(a: Tensor, b: Tensor) {
        let d = a + b * -1.0;
        assert!(d.xx.abs() + d.xy.abs() + d.yy.abs() < 1e-12 * (b.xx + b.yy), "{a:?} {b:?}");
    }

    #[test]
    fn of_quadratics_it_is_constant_and_has_no_sign() {
        // Second derivatives 8, -2 along and across (0.6, 0.8).
        let text = "4*(0.6*x + 0.8*y)^2 - (0.8*x - 0.6*y)^2";
        let truth = Tensor::from_axis(crate::geometry::Vector::new(0.6, 0.8), 8.0, 2.0);
        for p in [Point::new(0.1, 0.9), Point::new(0.5, 0.5)] {
            assert_close(hessian(text, Norm::new(f64::INFINITY).unwrap()).unwrap().at(p), truth);
            assert_close(hessian(text, Norm::default()).unwrap().at(p), truth * 16.0_f64.powf(-1.0 / 6.0));
        }
    }

    #[test]
    fn what_says_nothing_gets_the_floor() {
        let field = hessian("x^2 / 2", Norm::new(f64::INFINITY).unwrap()).unwrap();
        assert_close(field.at(Point::new(0.3, 0.3)), Tensor::new(1.0, 0.0, FLOOR));
    }

    #[test]
    fn what_has_no_second_derivatives_is_refused() {
        let message = |text| hessian(text, Norm::default()).unwrap_err().to_string();
        assert!(message("3*x - y + 1").contains("vanish everywhere"));
        assert!(message("sqrt(x - 0.5)").contains("second derivatives are not finite at ("));
        assert!(message("x +").contains("expression, column"));
    }
}
