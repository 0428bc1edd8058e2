//! The names and operators of expressions, each declared once.

use super::expression::Op;

/// How many arguments a function takes, and what it does with them.
pub(super) enum Function {
    One(fn(f64) -> f64),
    Two(fn(f64, f64) -> f64),
    /// Two or more arguments, folded from the left.
    Many(fn(f64, f64) -> f64),
    If,
}

/// Functions, in the order of the help.
pub(super) const FUNCTIONS: [(&str, Function); 17] = [
    ("sin", Function::One(f64::sin)),
    ("cos", Function::One(f64::cos)),
    ("tan", Function::One(f64::tan)),
    ("asin", Function::One(f64::asin)),
    ("acos", Function::One(f64::acos)),
    ("atan", Function::One(f64::atan)),
    ("atan2", Function::Two(f64::atan2)),
    ("sinh", Function::One(f64::sinh)),
    ("cosh", Function::One(f64::cosh)),
    ("tanh", Function::One(f64::tanh)),
    ("exp", Function::One(f64::exp)),
    ("log", Function::One(f64::ln)),
    ("sqrt", Function::One(f64::sqrt)),
    ("abs", Function::One(f64::abs)),
    ("min", Function::Many(f64::min)),
    ("max", Function::Many(f64::max)),
    ("if", Function::If),
];

pub(super) const CONSTANTS: [(&str, f64); 2] = [("pi", std::f64::consts::PI), ("e", std::f64::consts::E)];

/// Spelling, binding strength and instruction; of two that start alike, the longer comes first.
pub(super) const OPERATORS: [(&str, u8, Op); 15] = [
    ("||", 1, Op::Call2(|a, b| truth(a != 0.0 || b != 0.0))),
    ("or", 1, Op::Call2(|a, b| truth(a != 0.0 || b != 0.0))),
    ("&&", 2, Op::Call2(|a, b| truth(a != 0.0 && b != 0.0))),
    ("and", 2, Op::Call2(|a, b| truth(a != 0.0 && b != 0.0))),
    ("<=", COMPARISON, Op::Call2(|a, b| truth(a <= b))),
    ("<", COMPARISON, Op::Call2(|a, b| truth(a < b))),
    (">=", COMPARISON, Op::Call2(|a, b| truth(a >= b))),
    (">", COMPARISON, Op::Call2(|a, b| truth(a > b))),
    // Exact comparison is what the user asks for.
    ("==", COMPARISON, Op::Call2(equal)),
    ("!=", COMPARISON, Op::Call2(|a, b| 1.0 - equal(a, b))),
    ("+", 4, Op::Add),
    ("-", 4, Op::Subtract),
    ("*", 5, Op::Multiply),
    ("/", 5, Op::Divide),
    ("^", POWER, Op::Power),
];

pub(super) const COMPARISON: u8 = 3;
pub(super) const SIGN: u8 = 6;
pub(super) const POWER: u8 = 7;

fn truth(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}

#[expect(clippy::float_cmp)]
fn equal(a: f64, b: f64) -> f64 {
    truth(a == b)
}
