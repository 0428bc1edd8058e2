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
    hyperbolic_tangent: tanh() -> f64;
    hypotenuse: hypot(other) -> f64;
    logarithm: log() -> f64;
    raised_to: pow(exponent) -> f64;
    power_of_two: exp2() -> f64;
    sine: sin() -> f64;
    sine_and_cosine: sincos() -> (f64, f64);
    tangent: tan() -> f64;
}
