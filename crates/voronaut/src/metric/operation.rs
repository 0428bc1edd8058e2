//! What expressions are compiled to, and of what.

use super::number::{Binary, Unary};

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

/// Values an expression may keep waiting, such as the three 1 in `1 + (1 + (1 + x))`.
pub(super) const STACK: usize = 64;

/// One instruction; operands come from the stack, the result goes there.
#[derive(Clone, Copy, Debug)]
pub(super) enum Op {
    Constant(f64),
    X,
    Y,
    Z,
    Negate,
    Square,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Call1(&'static Unary),
    Call2(&'static Binary),
    Jump(u32),
    /// Takes the condition off the stack.
    JumpIfZero(u32),
}
