//! What expressions are compiled to, and how that runs: on plain numbers, and on numbers that carry their derivatives.

use super::series::{Number, Unary};
use crate::elementary::Elementary;
use crate::geometry::{Jet, Jet3};

impl Number for f64 {
    fn value(self) -> f64 {
        self
    }

    fn square(self) -> Self {
        self * self
    }

    fn plus(self, c: f64) -> Self {
        self + c
    }

    fn times(self, c: f64) -> Self {
        self * c
    }

    fn over(self, c: f64) -> Self {
        self / c
    }

    fn power(self, exponent: Self) -> Self {
        self.raised_to(exponent)
    }

    fn atan2(self, x: Self) -> Self {
        Elementary::arctangent_over(self, x)
    }

    fn call(self, function: &Unary) -> Self {
        (function.value)(self)
    }
}

/// The same for jets of the plane and of space.
macro_rules! numbers {
    ($($jet:ident),*) => {$(
        impl Number for $jet {
            fn value(self) -> f64 {
                self.value
            }

            fn square(self) -> Self {
                self.chain(self.value * self.value, [2.0 * self.value, 2.0])
            }

            fn plus(self, c: f64) -> Self {
                Self { value: self.value + c, ..self }
            }

            fn times(self, c: f64) -> Self {
                Self { value: self.value * c, gradient: self.gradient * c, hessian: self.hessian * c }
            }

            fn over(self, c: f64) -> Self {
                Self { value: self.value / c, ..self.times(1.0 / c) }
            }

            fn power(self, exponent: Self) -> Self {
                let (a, b) = (self.value, exponent.value);
                let power = a.raised_to(b);
                let by_base = [scaled_power(b, a, b - 1.0), scaled_power(b * (b - 1.0), a, b - 2.0)];
                if exponent.is_constant() {
                    // Bases below zero have no logarithm, but powers.
                    return self.chain(power, by_base);
                }
                let log = a.logarithm();
                let second = [by_base[1], a.raised_to(b - 1.0) * (1.0 + b * log), log * log * power];
                self.chain2(exponent, power, [by_base[0], log * power], second)
            }

            fn atan2(self, other: Self) -> Self {
                let (y, x) = (self.value, other.value);
                let square = x * x + y * y;
                let fourth = square.powi(2);
                let second = [-2.0 * x * y / fourth, (y * y - x * x) / fourth, 2.0 * x * y / fourth];
                self.chain2(other, y.arctangent_over(x), [x / square, -y / square], second)
            }

            fn call(self, function: &Unary) -> Self {
                let [value, first, second] = (function.jet)(self.value);
                self.chain(value, [first, second])
            }
        }
    )*};
}

numbers!(Jet, Jet3);

/// c a^b, zero where c is, even if a^b is infinite.
fn scaled_power(c: f64, a: f64, b: f64) -> f64 {
    if c == 0.0 { 0.0 } else { c * a.raised_to(b) }
}

/// Values an expression may keep waiting, such as the three 1 in `1 + (1 + (1 + x))`.
pub(super) const STACK: usize = 64;

/// One instruction; operands come from the stack, the result goes there.
#[derive(Clone, Copy, Debug)]
pub(super) enum Op {
    Constant(f64),
    /// The variable with this number.
    Variable(usize),
    Negate,
    Square,
    /// With a constant: most numbers of a formula are, and need no derivatives.
    Plus(f64),
    Times(f64),
    Over(f64),
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Atan2,
    Call(&'static Unary),
    /// 1 or 0, as it holds of two numbers.
    Test(fn(f64, f64) -> bool),
    /// One of two numbers.
    Choose(fn(f64, f64) -> f64),
    Jump(u32),
    /// Takes the condition off the stack.
    JumpIfZero(u32),
    /// Puts the last value in a place above the stack, too.
    Keep(u32),
    Recall(u32),
    /// Takes the last value off the stack: it is the result with this number.
    Result(u32),
}

impl Op {
    /// How many values it takes off the stack for the one that it puts there; `None` of jumps.
    pub(super) fn operands(self) -> Option<usize> {
        match self {
            Op::Constant(_) | Op::Variable(_) => Some(0),
            Op::Negate | Op::Square | Op::Plus(_) | Op::Times(_) | Op::Over(_) | Op::Call(_) => Some(1),
            Op::Jump(_) | Op::JumpIfZero(_) | Op::Keep(_) | Op::Recall(_) | Op::Result(_) => None,
            _ => Some(2),
        }
    }

    /// What it does with its operands, as numbers: of the same function the same.
    pub(super) fn identity(self) -> (u8, u64) {
        match self {
            Op::Constant(value) => (0, value.to_bits()),
            Op::Variable(i) => (1, i as u64),
            Op::Call(function) => (2, std::ptr::from_ref(function) as u64),
            Op::Test(holds) => (3, holds as usize as u64),
            Op::Choose(one_of) => (4, one_of as usize as u64),
            Op::Negate => (5, 0),
            Op::Square => (6, 0),
            Op::Add => (7, 0),
            Op::Subtract => (8, 0),
            Op::Multiply => (9, 0),
            Op::Divide => (10, 0),
            Op::Power => (11, 0),
            Op::Atan2 => (12, 0),
            Op::Plus(c) => (13, c.to_bits()),
            Op::Times(c) => (14, c.to_bits()),
            Op::Over(c) => (15, c.to_bits()),
            Op::Jump(i) | Op::JumpIfZero(i) | Op::Keep(i) | Op::Recall(i) | Op::Result(i) => (16, u64::from(i)),
        }
    }
}

/// Instructions, and how many values they have at once at most: those that wait, and those that are kept.
#[derive(Clone, Debug)]
pub(super) struct Program {
    pub(super) code: Box<[Op]>,
    pub(super) height: usize,
}

impl Program {
    /// What it makes of its variables: its results.
    pub(super) fn run<N: Number, const RESULTS: usize>(&self, variables: [N; 4]) -> [N; RESULTS] {
        // What is not there need not be set to zero. Values that are kept are at the stack's end, and there in any stack that is a part of the
        // whole.
        match self.height {
            0..=8 => run_on::<N, RESULTS, 8>(&self.code, variables),
            9..=16 => run_on::<N, RESULTS, 16>(&self.code, variables),
            _ => run_on::<N, RESULTS, STACK>(&self.code, variables),
        }
    }
}

/// What an instruction makes of constants.
pub(super) fn folded(constants: &[Op], op: Op) -> f64 {
    let [value] = run_on::<f64, 1, STACK>(&[constants, &[op, Op::Result(0)]].concat(), [0.0; 4]);
    value
}

fn run_on<N: Number, const RESULTS: usize, const SIZE: usize>(code: &[Op], variables: [N; 4]) -> [N; RESULTS] {
    let mut results = [N::from(0.0); RESULTS];
    // The last value is kept out of the stack: most operations then touch it once or not at all.
    let mut stack = [N::from(0.0); SIZE];
    let mut top = 0;
    let mut value = N::from(0.0);
    let mut next = 0;
    while let Some(&op) = code.get(next) {
        next += 1;
        match op {
            Op::Constant(c) => push(&mut stack, &mut top, &mut value, c.into()),
            Op::Variable(i) => push(&mut stack, &mut top, &mut value, variables[i]),
            Op::Negate => value = -value,
            Op::Square => value = value.square(),
            Op::Plus(c) => value = value.plus(c),
            Op::Times(c) => value = value.times(c),
            Op::Over(c) => value = value.over(c),
            Op::Add => value = value + pop(&stack, &mut top),
            Op::Subtract => value = pop(&stack, &mut top) - value,
            Op::Multiply => value = value * pop(&stack, &mut top),
            Op::Divide => value = pop(&stack, &mut top) / value,
            Op::Power => value = pop(&stack, &mut top).power(value),
            Op::Atan2 => value = pop(&stack, &mut top).atan2(value),
            Op::Call(f) => value = value.call(f),
            Op::Test(holds) => value = f64::from(u8::from(holds(pop(&stack, &mut top).value(), value.value()))).into(),
            Op::Choose(one_of) => {
                let first = pop(&stack, &mut top);
                let is_second = one_of(first.value(), value.value()).to_bits() == value.value().to_bits();
                value = if is_second { value } else { first };
            }
            Op::Jump(target) => next = target as usize,
            Op::JumpIfZero(target) => {
                if value.value() == 0.0 {
                    next = target as usize;
                }
                value = pop(&stack, &mut top);
            }
            Op::Keep(place) => stack[place as usize % SIZE] = value,
            Op::Recall(place) => {
                let kept = stack[place as usize % SIZE];
                push(&mut stack, &mut top, &mut value, kept);
            }
            Op::Result(number) => {
                results[number as usize] = value;
                value = pop(&stack, &mut top);
            }
        }
    }
    results
}

// The compiler in `parser` keeps the height below STACK; the remainder spares the bounds check.
fn push<N: Number, const SIZE: usize>(stack: &mut [N; SIZE], top: &mut usize, value: &mut N, new: N) {
    stack[*top % SIZE] = *value;
    *top += 1;
    *value = new;
}

fn pop<N: Number, const SIZE: usize>(stack: &[N; SIZE], top: &mut usize) -> N {
    *top = top.wrapping_sub(1);
    stack[*top % SIZE]
}

#[cfg(test)]
mod tests {
    use crate::geometry::{Jet3, Point3};
    use crate::metric::{Expression, Variables};

    fn jet(text: &str, p: Point3) -> Jet3 {
        Expression::parse(text, Variables::Space).unwrap().jet(p)
    }

    /// Values along each axis and diagonal, differenced: errors of about 1e-6 with this step.
    fn differences(f: &Expression, p: Point3) -> ([f64; 3], [f64; 6]) {
        const STEP: f64 = 1e-4;
        let at = |d: [f64; 3]| f.at(p.x + d[0] * STEP, p.y + d[1] * STEP, p.z + d[2] * STEP);
        let unit = |i: usize| std::array::from_fn(|j| f64::from(u8::from(i == j)));
        let sum = |a: [f64; 3], b: [f64; 3], s: f64| std::array::from_fn(|i| a[i] + s * b[i]);
        let first = std::array::from_fn(|i| (at(unit(i)) - at(unit(i).map(|x: f64| -x))) / (2.0 * STEP));
        let second = [(0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2)].map(|(i, j)| {
            let corners = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)]
                .map(|(s, t)| s * t * at(sum(sum([0.0; 3], unit(i), s), unit(j), t)));
            corners.iter().sum::<f64>() / (4.0 * STEP * STEP)
        });
        (first, second)
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let p = Point3::new(0.4, 0.7, -0.3);
        for text in [
            "x*y*z + 3",
            "x/y - z/(x+y)",
            "x^3*y^z + z^2 - (-x)^3",
            "2^(x*y)",
            "sin(x*y) + cos(y-z) + tan(x*z)",
            "asin(x*y) + acos(y*z) + atan(3*x*z)",
            "atan2(y*z, x) - atan2(x, y)",
            "sinh(x-y) * cosh(z) + tanh(2*x*y)",
            "exp(x*y)*log(x+y) - sqrt(x + y*y)",
            "abs(z)*min(x, y^2, 3)*max(x, y, z)",
            "if(x < y, x*x*y, z) + (x < y)*z^3 + (x and z)*y*z",
            "(x^2+y^2+z^2-0.95*25)^2 - 0.8*((z-5)^2-2*x^2)*((z+5)^2-2*y^2)",
        ] {
            let f = Expression::parse(text, Variables::Space).unwrap();
            let Jet3 { value, gradient, hessian } = jet(text, p);
            assert_eq!(value.to_bits(), f.at(p.x, p.y, p.z).to_bits(), "{text}");
            let (first, second) = differences(&f, p);
            let scale = 1.0 + value.abs() + hessian.to_disk().iter().map(|entry| entry.abs()).fold(0.0, f64::max);
            for (exact, rough) in [gradient.x, gradient.y, gradient.z].into_iter().zip(first) {
                assert!((exact - rough).abs() < 1e-6 * scale, "{text}: {gradient:?}, {first:?}");
            }
            for (exact, rough) in hessian.to_disk().into_iter().zip(second) {
                assert!((exact - rough).abs() < 1e-5 * scale, "{text}: {hessian:?}, {second:?}");
            }
        }
    }

    #[test]
    fn powers_have_derivatives_at_zero_and_below() {
        let p = Point3::new(0.0, -2.0, 0.0);
        assert_eq!(jet("x^1 + y^3", p).gradient, crate::geometry::Vector3::new(1.0, 12.0, 0.0));
        assert_eq!(jet("x^0 + x^2", p).hessian.to_disk().map(f64::to_bits)[0], 2.0_f64.to_bits());
        assert!(jet("sqrt(0) + x", p).gradient.x.is_finite(), "constants have no derivatives");
    }
}
