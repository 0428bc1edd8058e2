//! The names and operators of expressions, each declared once.

use super::program::{Binary, Op, Unary};

/// How many arguments a function takes, and what it does with them.
pub(super) enum Function {
    One(&'static Unary),
    Two(&'static Binary),
    /// Two or more arguments, folded from the left.
    Many(&'static Binary),
    If,
}

/// Functions, in the order of the help.
pub(super) const FUNCTIONS: [(&str, Function); 17] = [
    ("sin", Function::One(&Unary { value: f64::sin, derivatives: |x| [x.cos(), -x.sin()] })),
    ("cos", Function::One(&Unary { value: f64::cos, derivatives: |x| [-x.sin(), -x.cos()] })),
    ("tan", Function::One(&Unary { value: f64::tan, derivatives: of_tan })),
    ("asin", Function::One(&Unary { value: f64::asin, derivatives: of_asin })),
    ("acos", Function::One(&Unary { value: f64::acos, derivatives: |x| of_asin(x).map(|d| -d) })),
    ("atan", Function::One(&Unary { value: f64::atan, derivatives: of_atan })),
    ("atan2", Function::Two(&Binary { value: f64::atan2, first: of_atan2, second: second_of_atan2 })),
    ("sinh", Function::One(&Unary { value: f64::sinh, derivatives: |x| [x.cosh(), x.sinh()] })),
    ("cosh", Function::One(&Unary { value: f64::cosh, derivatives: |x| [x.sinh(), x.cosh()] })),
    ("tanh", Function::One(&Unary { value: f64::tanh, derivatives: of_tanh })),
    ("exp", Function::One(&Unary { value: f64::exp, derivatives: |x| [x.exp(), x.exp()] })),
    ("log", Function::One(&Unary { value: f64::ln, derivatives: |x| [1.0 / x, -1.0 / (x * x)] })),
    ("sqrt", Function::One(&Unary { value: f64::sqrt, derivatives: |x| [0.5 / x.sqrt(), -0.25 / (x * x.sqrt())] })),
    ("abs", Function::One(&Unary { value: f64::abs, derivatives: |x| [x.signum(), 0.0] })),
    ("min", Function::Many(&Binary { value: f64::min, first: |a, b| choice(a < b), second: |_, _| [0.0; 3] })),
    ("max", Function::Many(&Binary { value: f64::max, first: |a, b| choice(a > b), second: |_, _| [0.0; 3] })),
    ("if", Function::If),
];

pub(super) const CONSTANTS: [(&str, f64); 2] = [("pi", std::f64::consts::PI), ("e", std::f64::consts::E)];

/// Spelling, binding strength and instruction; of two that start alike, the longer comes first.
pub(super) const OPERATORS: [(&str, u8, Op); 15] = [
    ("||", 1, OR),
    ("or", 1, OR),
    ("&&", 2, AND),
    ("and", 2, AND),
    ("<=", COMPARISON, Op::Call2(&step(|a, b| truth(a <= b)))),
    ("<", COMPARISON, Op::Call2(&step(|a, b| truth(a < b)))),
    (">=", COMPARISON, Op::Call2(&step(|a, b| truth(a >= b)))),
    (">", COMPARISON, Op::Call2(&step(|a, b| truth(a > b)))),
    // Exact comparison is what the user asks for.
    ("==", COMPARISON, Op::Call2(&step(equal))),
    ("!=", COMPARISON, Op::Call2(&step(|a, b| 1.0 - equal(a, b)))),
    ("+", 4, Op::Add),
    ("-", 4, Op::Subtract),
    ("*", 5, Op::Multiply),
    ("/", 5, Op::Divide),
    ("^", POWER, Op::Power),
];

pub(super) const COMPARISON: u8 = 3;
pub(super) const SIGN: u8 = 6;
pub(super) const POWER: u8 = 7;

const OR: Op = Op::Call2(&step(|a, b| truth(a != 0.0 || b != 0.0)));
const AND: Op = Op::Call2(&step(|a, b| truth(a != 0.0 && b != 0.0)));

/// A function whose derivatives are zero but where it jumps.
const fn step(value: fn(f64, f64) -> f64) -> Binary {
    Binary { value, first: |_, _| [0.0; 2], second: |_, _| [0.0; 3] }
}

/// The derivatives of a choice between two values.
fn choice(first: bool) -> [f64; 2] {
    if first { [1.0, 0.0] } else { [0.0, 1.0] }
}

fn of_tan(x: f64) -> [f64; 2] {
    let slope = x.cos().powi(-2);
    [slope, 2.0 * x.tan() * slope]
}

fn of_asin(x: f64) -> [f64; 2] {
    let slope = 1.0 / (1.0 - x * x).sqrt();
    [slope, x * slope.powi(3)]
}

fn of_atan(x: f64) -> [f64; 2] {
    let slope = 1.0 / (1.0 + x * x);
    [slope, -2.0 * x * slope * slope]
}

fn of_tanh(x: f64) -> [f64; 2] {
    let slope = x.cosh().powi(-2);
    [slope, -2.0 * x.tanh() * slope]
}

fn of_atan2(y: f64, x: f64) -> [f64; 2] {
    let square = x * x + y * y;
    [x / square, -y / square]
}

fn second_of_atan2(y: f64, x: f64) -> [f64; 3] {
    let fourth = (x * x + y * y).powi(2);
    [-2.0 * x * y / fourth, (y * y - x * x) / fourth, 2.0 * x * y / fourth]
}

fn truth(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}

#[expect(clippy::float_cmp)]
fn equal(a: f64, b: f64) -> f64 {
    truth(a == b)
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
}
