//! The norm in which an error of interpolation is to be least, and what it makes of a Hessian.

use crate::elementary::Elementary;
use crate::error::{Error, Result};
use crate::geometry::Tensor;
use std::fmt;
use std::str::FromStr;

/// The exponent p of an L^p norm, at least 1; it may be infinite. The default is 2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Norm(f64);

impl Default for Norm {
    fn default() -> Self {
        Self(2.0)
    }
}

impl Norm {
    /// The norm of an exponent.
    ///
    /// # Errors
    /// [`Error::Parse`] unless it is at least 1.
    pub fn new(p: f64) -> Result<Self> {
        if p >= 1.0 {
            return Ok(Self(p));
        }
        Err(Error::parse(format!("norm {p}"), "p is not at least 1", "choose 1, 2, 4 or inf"))
    }

    /// The exponent p.
    pub(crate) fn exponent(self) -> f64 {
        self.0
    }

    /// det(|H|)^(-1 / (2p + 2)) |H|, of the absolute value of a Hessian: up to a factor that is the same everywhere, the metric
    /// whose unit meshes have, of all with as many vertices, the least L^p error of linear interpolation (Loseille and
    /// Alauzet 2011, in two dimensions). With p infinite, |H| itself.
    #[must_use]
    pub(crate) fn weighted(self, absolute: Tensor) -> Tensor {
        absolute * self.weight(absolute, 1)
    }

    /// det(Q)^(-1 / ((k + 1) p + 2)), for polynomials of degree k, whose error over a unit of Q is the same everywhere.
    pub(crate) fn weight(self, bounding: Tensor, degree: usize) -> f64 {
        if self.0.is_infinite() {
            return 1.0;
        }
        let determinant = bounding.determinant();
        if degree == 1 && self.is_square() {
            // Roots cost less than a power.
            return 1.0 / determinant.sqrt().cube_root();
        }
        determinant.raised_to(-1.0 / ((degree as f64 + 1.0) * self.0 + 2.0))
    }

    /// |error|^p, for finite p.
    pub(crate) fn power(self, error: f64) -> f64 {
        if self.is_square() { error * error } else { error.abs().raised_to(self.0) }
    }

    /// Whether p is 2: the default, and the fast one.
    pub(crate) fn is_square(self) -> bool {
        self.0.total_cmp(&2.0).is_eq()
    }
}

impl fmt::Display for Norm {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl FromStr for Norm {
    type Err = Error;

    /// A number, or `inf`.
    ///
    /// # Errors
    /// [`Error::Parse`] of what is no number from 1 up.
    fn from_str(text: &str) -> Result<Self> {
        match text.trim().parse::<f64>() {
            Ok(p) => Self::new(p),
            Err(_) => Err(Error::parse(format!("norm {text}"), "p is not a number", "choose 1, 2, 4 or inf")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_take_the_size_of_a_hessian_away_but_not_all_of_it() {
        // sqrt(det) of the weighted tensor is det^(p / (2p + 2)).
        let h = Tensor::new(40.0, 3.0, 2.0);
        for (p, power) in [(1.0, 0.25), (2.0, 1.0 / 3.0), (4.0, 0.4), (f64::INFINITY, 0.5)] {
            let density = Norm::new(p).unwrap().weighted(h).determinant().sqrt();
            assert!((density / h.determinant().powf(power) - 1.0).abs() < 1e-12, "{p}");
        }
    }

    #[test]
    fn texts() {
        assert_eq!("inf".parse::<Norm>().unwrap(), Norm::new(f64::INFINITY).unwrap());
        assert_eq!(Norm::new(f64::INFINITY).unwrap().to_string(), "inf");
        assert_eq!(Norm::default().to_string(), "2");
        for text in ["0.5", "-inf", "nan", "two", ""] {
            assert!(text.parse::<Norm>().is_err(), "{text}");
        }
    }
}
