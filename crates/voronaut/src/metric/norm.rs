//! The norm in which an error of interpolation is to be least, and what it makes of a Hessian.

use crate::elementary::Elementary;
use crate::error::{Error, Result};
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
    /// The greatest error: p is infinite.
    pub(crate) const GREATEST: Self = Self(f64::INFINITY);

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

    /// det(Q)^(-1 / ((k + 1) p + 2)) by det(Q), for polynomials of degree k, whose error over a unit of Q is the same everywhere.
    pub(crate) fn weight(self, determinant: f64, degree: usize) -> f64 {
        if self.0.is_infinite() {
            return 1.0;
        }
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
    fn texts() {
        assert_eq!("inf".parse::<Norm>().unwrap(), Norm::new(f64::INFINITY).unwrap());
        assert_eq!(Norm::new(f64::INFINITY).unwrap().to_string(), "inf");
        assert_eq!(Norm::default().to_string(), "2");
        for text in ["0.5", "-inf", "nan", "two", ""] {
            assert!(text.parse::<Norm>().is_err(), "{text}");
        }
    }
}
