//! The names and operators of expressions, each declared once.

use super::program::Op;
use super::series::{Number, Series, Unary};
use crate::elementary::Elementary;

/// How many arguments a function takes, and what it does with them.
pub(super) enum Function {
    One(&'static Unary),
    Two(Op),
    /// Two or more arguments, folded from the left.
    Many(Op),
    If,
}

/// Functions, in the order of the help.
pub(super) const FUNCTIONS: [(&str, Function); 17] = [
    ("sin", Function::One(&SIN)),
    ("cos", Function::One(&COS)),
    ("tan", Function::One(&TAN)),
    ("asin", Function::One(&ASIN)),
    ("acos", Function::One(&ACOS)),
    ("atan", Function::One(&ATAN)),
    ("atan2", Function::Two(Op::Atan2)),
    ("sinh", Function::One(&SINH)),
    ("cosh", Function::One(&COSH)),
    ("tanh", Function::One(&TANH)),
    ("exp", Function::One(&EXP)),
    ("log", Function::One(&LOG)),
    ("sqrt", Function::One(&SQRT)),
    ("abs", Function::One(&ABS)),
    ("min", Function::Many(Op::Choose(f64::min))),
    ("max", Function::Many(Op::Choose(f64::max))),
    ("if", Function::If),
];

const SIN: Unary = Unary {
    value: Elementary::sine,
    jet: |x| {
        let (sine, cosine) = x.sine_and_cosine();
        [sine, cosine, -sine]
    },
    slope: |u| u.call(&COS),
};
const COS: Unary = Unary {
    value: Elementary::cosine,
    jet: |x| {
        let (sine, cosine) = x.sine_and_cosine();
        [cosine, -sine, -cosine]
    },
    slope: |u| -u.call(&SIN),
};
const TAN: Unary = Unary { value: Elementary::tangent, jet: of_tan, slope: |u| one() + u.call(&TAN).square() };
const ASIN: Unary =
    Unary { value: Elementary::arcsine, jet: of_asin, slope: |u| one() / (one() - u.square()).call(&SQRT) };
const ACOS: Unary = Unary {
    value: Elementary::arccosine,
    jet: |x| {
        let [first, second] = slopes_of_asin(x);
        [x.arccosine(), -first, -second]
    },
    slope: |u| -(one() / (one() - u.square()).call(&SQRT)),
};
const ATAN: Unary = Unary { value: Elementary::arctangent, jet: of_atan, slope: |u| one() / (one() + u.square()) };
const SINH: Unary = Unary {
    value: Elementary::hyperbolic_sine,
    jet: |x| {
        let sine = x.hyperbolic_sine();
        [sine, x.hyperbolic_cosine(), sine]
    },
    slope: |u| u.call(&COSH),
};
const COSH: Unary = Unary {
    value: Elementary::hyperbolic_cosine,
    jet: |x| {
        let cosine = x.hyperbolic_cosine();
        [cosine, x.hyperbolic_sine(), cosine]
    },
    slope: |u| u.call(&SINH),
};
const TANH: Unary =
    Unary { value: Elementary::hyperbolic_tangent, jet: of_tanh, slope: |u| one() - u.call(&TANH).square() };
const EXP: Unary = Unary { value: Elementary::exponential, jet: |x| [x.exponential(); 3], slope: |u| u.call(&EXP) };
const LOG: Unary =
    Unary { value: Elementary::logarithm, jet: |x| [x.logarithm(), 1.0 / x, -1.0 / (x * x)], slope: |u| one() / u };
const SQRT: Unary = Unary {
    value: f64::sqrt,
    jet: |x| {
        let root = x.sqrt();
        [root, 0.5 / root, -0.25 / (x * root)]
    },
    slope: |u| Series::from(0.5) / u.call(&SQRT),
};
const ABS: Unary = Unary { value: f64::abs, jet: |x| [x.abs(), x.signum(), 0.0], slope: |u| u.value().signum().into() };

fn one() -> Series {
    1.0.into()
}

pub(super) const CONSTANTS: [(&str, f64); 2] = [("pi", std::f64::consts::PI), ("e", std::f64::consts::E)];

/// Spelling, binding strength and instruction; of two that start alike, the longer comes first.
pub(super) const OPERATORS: [(&str, u8, Op); 15] = [
    ("||", 1, OR),
    ("or", 1, OR),
    ("&&", 2, AND),
    ("and", 2, AND),
    ("<=", COMPARISON, Op::Test(|a, b| a <= b)),
    ("<", COMPARISON, Op::Test(|a, b| a < b)),
    (">=", COMPARISON, Op::Test(|a, b| a >= b)),
    (">", COMPARISON, Op::Test(|a, b| a > b)),
    ("==", COMPARISON, Op::Test(are_equal)),
    ("!=", COMPARISON, Op::Test(|a, b| !are_equal(a, b))),
    ("+", 4, Op::Add),
    ("-", 4, Op::Subtract),
    ("*", 5, Op::Multiply),
    ("/", 5, Op::Divide),
    ("^", POWER, Op::Power),
];

pub(super) const COMPARISON: u8 = 3;
pub(super) const SIGN: u8 = 6;
pub(super) const POWER: u8 = 7;

const OR: Op = Op::Test(|a, b| a != 0.0 || b != 0.0);
const AND: Op = Op::Test(|a, b| a != 0.0 && b != 0.0);

fn of_tan(x: f64) -> [f64; 3] {
    let (tangent, slope) = (x.tangent(), x.cosine().powi(-2));
    [tangent, slope, 2.0 * tangent * slope]
}

fn of_asin(x: f64) -> [f64; 3] {
    let [first, second] = slopes_of_asin(x);
    [x.arcsine(), first, second]
}

fn slopes_of_asin(x: f64) -> [f64; 2] {
    let slope = 1.0 / (1.0 - x * x).sqrt();
    [slope, x * slope.powi(3)]
}

fn of_atan(x: f64) -> [f64; 3] {
    let slope = 1.0 / (1.0 + x * x);
    [x.arctangent(), slope, -2.0 * x * slope * slope]
}

fn of_tanh(x: f64) -> [f64; 3] {
    let (tangent, decay) = x.hyperbolic_tangent_and_decay();
    // 1 / cosh^2, which keeps its digits where 1 - tanh^2 has lost them.
    let slope = 4.0 * decay / ((1.0 + decay) * (1.0 + decay));
    [tangent, slope, -2.0 * tangent * slope]
}

#[expect(clippy::float_cmp, reason = "that is what the user asks for")]
fn are_equal(a: f64, b: f64) -> bool {
    a == b
}

/// Which variables an expression may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variables {
    /// x and y.
    Plane,
    /// x, y and z.
    Space,
    /// x, y and the time t, which takes the place of z.
    Motion,
    /// x, y, z and the time t.
    SpaceMotion,
}
