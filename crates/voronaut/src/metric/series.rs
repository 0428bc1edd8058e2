//! What expressions do with numbers, and numbers that carry their power series along a line: derivatives up to the fourth.

use crate::elementary::Elementary;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A function of one number; with its first and second derivative; and the series of the first.
#[derive(Debug)]
pub(super) struct Unary {
    pub(super) value: fn(f64) -> f64,
    pub(super) jet: fn(f64) -> [f64; 3],
    pub(super) slope: fn(Series) -> Series,
}

/// Arithmetic of expressions.
pub(super) trait Number:
    Copy
    + From<f64>
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
{
    fn value(self) -> f64;
    fn square(self) -> Self;
    fn plus(self, c: f64) -> Self;
    fn times(self, c: f64) -> Self;
    fn over(self, c: f64) -> Self;
    fn power(self, exponent: Self) -> Self;
    /// The angle of the vector (`x`, self).
    fn atan2(self, x: Self) -> Self;
    fn call(self, function: &Unary) -> Self;
}

/// Terms of a series.
const TERMS: usize = 5;

/// What a function is along a line: c[0] + c[1] t + ... up to a power of t (Griewank and Walther 2008, chapter 13).
#[derive(Clone, Copy, Debug)]
pub(super) struct Series {
    terms: [f64; TERMS],
    /// How many terms are known; the others are zero.
    known: usize,
}

impl Series {
    /// A coordinate along a line.
    pub(super) fn line(from: f64, step: f64) -> Self {
        Self { terms: [from, step, 0.0, 0.0, 0.0], known: TERMS }
    }

    /// The derivative by t of an order, up to four.
    pub(super) fn derivative(&self, order: usize) -> f64 {
        [1.0, 1.0, 2.0, 6.0, 24.0][order] * self.terms[order]
    }

    fn is_constant(&self) -> bool {
        self.terms[1..].iter().all(|&term| term == 0.0)
    }

    /// All but the last of the known terms.
    fn shortened(mut self) -> Self {
        self.known -= 1;
        self.terms[self.known] = 0.0;
        self
    }

    /// The derivative.
    fn slope(self) -> Self {
        let terms =
            std::array::from_fn(|k| if k + 1 < self.known { (k as f64 + 1.0) * self.terms[k + 1] } else { 0.0 });
        Self { terms, known: self.known - 1 }
    }

    /// What has this derivative and, at zero, this value.
    fn integral(self, value: f64) -> Self {
        let terms = std::array::from_fn(|k| if k == 0 { value } else { self.terms[k - 1] / k as f64 });
        Self { terms, known: self.known + 1 }
    }

    /// c times a power with a constant exponent.
    fn raised(self, c: f64, exponent: f64) -> Self {
        if c == 0.0 {
            return Self { terms: [0.0; TERMS], known: self.known };
        }
        let value = c * self.terms[0].raised_to(exponent);
        if self.known == 1 {
            return Self { terms: [value, 0.0, 0.0, 0.0, 0.0], known: 1 };
        }
        (self.shortened().raised(c * exponent, exponent - 1.0) * self.slope()).integral(value)
    }
}

impl From<f64> for Series {
    fn from(value: f64) -> Self {
        Self { terms: [value, 0.0, 0.0, 0.0, 0.0], known: TERMS }
    }
}

impl Neg for Series {
    type Output = Self;
    fn neg(self) -> Self {
        Self { terms: self.terms.map(|term| -term), ..self }
    }
}

impl Add for Series {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let known = self.known.min(other.known);
        let sum = |k: usize| if k < known { self.terms[k] + other.terms[k] } else { 0.0 };
        Self { terms: std::array::from_fn(sum), known }
    }
}

impl Sub for Series {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Series {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let known = self.known.min(other.known);
        let product = |k: usize| (0..=k).map(|i| self.terms[i] * other.terms[k - i]).sum();
        Self { terms: std::array::from_fn(|k| if k < known { product(k) } else { 0.0 }), known }
    }
}

impl Div for Series {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let known = self.known.min(other.known);
        let mut terms = [0.0; TERMS];
        for k in 0..known {
            let taken: f64 = (0..k).map(|i| terms[i] * other.terms[k - i]).sum();
            terms[k] = (self.terms[k] - taken) / other.terms[0];
        }
        Self { terms, known }
    }
}

impl Number for Series {
    fn value(self) -> f64 {
        self.terms[0]
    }

    fn square(self) -> Self {
        self * self
    }

    fn plus(mut self, c: f64) -> Self {
        self.terms[0] += c;
        self
    }

    fn times(self, c: f64) -> Self {
        Self { terms: self.terms.map(|term| term * c), ..self }
    }

    fn over(self, c: f64) -> Self {
        Self { terms: self.terms.map(|term| term / c), ..self }
    }

    fn power(self, exponent: Self) -> Self {
        if exponent.is_constant() {
            // Bases below zero have no logarithm, but powers.
            return self.raised(1.0, exponent.terms[0]);
        }
        let short = [self, exponent].map(Self::shortened);
        let value = self.terms[0].raised_to(exponent.terms[0]);
        if self.known == 1 {
            return Self { terms: [value, 0.0, 0.0, 0.0, 0.0], known: 1 };
        }
        let log = (self.slope() / short[0]).integral(self.terms[0].logarithm());
        (short[0].power(short[1]) * (log * exponent).slope()).integral(value)
    }

    fn atan2(self, x: Self) -> Self {
        let value = Elementary::arctangent_over(self.terms[0], x.terms[0]);
        let [y, x, by_y, by_x] = [self.shortened(), x.shortened(), self.slope(), x.slope()];
        ((x * by_y - y * by_x) / (x * x + y * y)).integral(value)
    }

    fn call(self, function: &Unary) -> Self {
        let value = (function.value)(self.terms[0]);
        if self.known == 1 || self.is_constant() {
            // Also where there is no derivative, as of sqrt at zero.
            return Self { terms: [value, 0.0, 0.0, 0.0, 0.0], known: self.known };
        }
        ((function.slope)(self.shortened()) * self.slope()).integral(value)
    }
}

#[cfg(test)]
mod tests {
    use crate::geometry::{Point3, Vector3};
    use crate::metric::{Expression, Variables};

    /// Second derivatives are known exactly: their differences are compared.
    #[test]
    fn derivatives_agree_with_differences_of_exact_ones() {
        let (p, v) = (Point3::new(0.4, 0.7, 0.3), Vector3::new(0.6, -0.8, 0.0));
        for text in [
            "x*y*z + 3 - x^3*y + x^4/7",
            "x/y - z/(x+y)",
            "x^3*y^1.5 + z^2 - (-x)^3",
            "2^(x*y) + x^y",
            "sin(x*y) + cos(y-z) + tan(x*z)",
            "asin(x*y) + acos(y*x*x) + atan(3*x*y)",
            "atan2(y*y, x) - atan2(x, y)",
            "sinh(x-y) * cosh(x) + tanh(2*x*y)",
            "exp(x*y)*log(x+y) - sqrt(x + y*y)",
            "abs(x-1)*min(x^5, y^2, 3)*max(x, y)",
            "if(x < y, x*x*y^3, z) + sqrt(0) + abs(0)",
        ] {
            let f = Expression::parse(text, Variables::Space).unwrap();
            let found = f.along(p, v);
            let second = |t: f64| {
                let hessian = f.jet(p + v * t).hessian;
                v.dot(hessian.apply(v))
            };
            let h = 1e-4;
            let [after, here, before] = [h, 0.0, -h].map(second);
            let truths = [here, (after - before) / (2.0 * h), (after + before - 2.0 * here) / (h * h)];
            for (order, truth) in (2..).zip(truths) {
                let derivative = found.derivative(order);
                assert!(
                    (derivative - truth).abs() < 1e-4 * (1.0 + truth.abs()),
                    "{text} {order}: {derivative} {truth}"
                );
            }
        }
    }

    #[test]
    fn powers_have_derivatives_at_zero() {
        let f = Expression::parse("x^4 + x^3 + x^0", Variables::Space).unwrap();
        let found = f.along(Point3::default(), Vector3::new(1.0, 0.0, 0.0));
        for (order, truth) in [1.0, 0.0, 0.0, 6.0, 24.0].into_iter().enumerate() {
            assert_eq!(found.derivative(order).to_bits(), f64::to_bits(truth), "{order}");
        }
    }
}
