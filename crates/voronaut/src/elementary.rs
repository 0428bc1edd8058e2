//! Elementary functions, the same to the last bit on every machine and in browsers: those of the system are not, and a mesh of which
//! one bit is another may be another mesh.

/// Of numbers, by names of their own: methods of the standard library are the system's.
pub(crate) trait Elementary {
    fn arccosine(self) -> Self;
    fn arcsine(self) -> Self;
    fn arctangent(self) -> Self;
    /// The angle of the point whose x is `other`, and whose y is this.
    fn arctangent_over(self, other: Self) -> Self;
    fn area_cosine(self) -> Self;
    fn binary_logarithm(self) -> Self;
    fn cosine(self) -> Self;
    fn cube_root(self) -> Self;
    fn exponential(self) -> Self;
    fn exponential_less_one(self) -> Self;
    fn hyperbolic_cosine(self) -> Self;
    fn hyperbolic_sine(self) -> Self;
    fn hyperbolic_tangent(self) -> Self;
    /// And exp(-2 |x|).
    fn hyperbolic_tangent_and_decay(self) -> (Self, Self)
    where
        Self: Sized;
    fn hypotenuse(self, other: Self) -> Self;
    fn logarithm(self) -> Self;
    fn raised_to(self, exponent: Self) -> Self;
    fn power_of_two(self) -> Self;
    fn sine(self) -> Self;
    fn sine_and_cosine(self) -> (Self, Self)
    where
        Self: Sized;
    fn tangent(self) -> Self;
}

/// Methods by the functions of `libm` that they are.
macro_rules! of_libm {
    ($($name:ident: $function:ident($($other:ident),*) -> $result:ty;)*) => {
        impl Elementary for f64 {
            $(#[inline]
            fn $name(self $(, $other: f64)*) -> $result {
                libm::$function(self $(, $other)*)
            })*

            fn hyperbolic_tangent(self) -> f64 {
                if self.abs() < HALF { libm::tanh(self) } else { self.hyperbolic_tangent_and_decay().0 }
            }

            fn hyperbolic_tangent_and_decay(self) -> (f64, f64) {
                hyperbolic_tangent_and_decay(self)
            }
        }
    };
}

of_libm! {
    arccosine: acos() -> f64;
    arcsine: asin() -> f64;
    arctangent: atan() -> f64;
    arctangent_over: atan2(other) -> f64;
    area_cosine: acosh() -> f64;
    binary_logarithm: log2() -> f64;
    cosine: cos() -> f64;
    cube_root: cbrt() -> f64;
    exponential: exp() -> f64;
    exponential_less_one: expm1() -> f64;
    hyperbolic_cosine: cosh() -> f64;
    hyperbolic_sine: sinh() -> f64;
    hypotenuse: hypot(other) -> f64;
    logarithm: log() -> f64;
    raised_to: pow(exponent) -> f64;
    power_of_two: exp2() -> f64;
    sine: sin() -> f64;
    sine_and_cosine: sincos() -> (f64, f64);
    tangent: tan() -> f64;
}

/// tanh(0.55) is a half: beyond, the difference from one loses no digit.
const HALF: f64 = 0.55;

/// Away from zero by the exponential, which costs less than the function of `libm` that its own is made of.
fn hyperbolic_tangent_and_decay(x: f64) -> (f64, f64) {
    let decay = libm::exp(-2.0 * x.abs());
    let tangent = if x.abs() < HALF { libm::tanh(x) } else { (1.0 - 2.0 * decay / (1.0 + decay)).copysign(x) };
    (tangent, decay)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hyperbolic_tangent_is_that_of_libm() {
        let mut worst = 0.0_f64;
        for i in -40_000..40_000 {
            let x = f64::from(i) * 5.3e-4;
            let (found, truth) = (x.hyperbolic_tangent(), libm::tanh(x));
            worst = worst.max((found - truth).abs() / truth.abs().max(f64::MIN_POSITIVE));
        }
        assert!(worst < 3.0 * f64::EPSILON, "{worst}");
        assert!(f64::NAN.hyperbolic_tangent().is_nan());
        let ends = [-1e9, f64::INFINITY].map(|x| x.hyperbolic_tangent().to_bits());
        assert_eq!(ends, [-1.0, 1.0].map(f64::to_bits));
    }
}
