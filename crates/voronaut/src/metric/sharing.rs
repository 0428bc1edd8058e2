//! Several programs as one, in which what occurs more than once is computed once: the entries of a metric have most in common.

use super::program::{Op, Program, STACK};
use std::collections::HashMap;

/// The programs one after the other, each with its result; values are the same to the bit. What occurs in one branch of an `if` alone is
/// computed there.
pub(super) fn shared(programs: &[Vec<Op>]) -> Program {
    let mut values = Values::default();
    let mut steps = Vec::new();
    let height = programs.iter().enumerate().map(|(i, code)| values.read(code, i, &mut steps)).max().unwrap_or(0);
    let kept = vec![None; values.uses.len()];
    let room = STACK.saturating_sub(height + 1);
    let mut writer = Writer { uses: values.uses, room, kept, ..Writer::default() };
    for step in steps {
        writer.write(step);
    }
    Program { code: writer.code.into(), height: height + writer.most }
}

/// A program without places to jump to.
#[derive(Clone, Copy)]
enum Step {
    /// An operation, and the value that it makes.
    Do(Op, u32),
    /// What follows is done where the last value is not zero,
    Then,
    /// what follows where it is,
    Else,
    /// and this is the value of either.
    Join(u32),
    Result(usize),
}

/// Values by what makes them, operands included.
#[derive(Default)]
struct Values {
    known: HashMap<(u8, u64, Vec<u32>), u32>,
    /// By how many others each is used.
    uses: Vec<u32>,
}

impl Values {
    /// The steps of a program with its number; and how many values wait at most, conditions and branches that are done included.
    fn read(&mut self, code: &[Op], number: usize, steps: &mut Vec<Step>) -> usize {
        let (mut waiting, mut ends, mut height) = (Vec::new(), Vec::new(), 0);
        for (at, op) in code.iter().map(Some).chain([None]).enumerate() {
            while ends.pop_if(|end| *end == at).is_some() {
                let operands = waiting.split_off(waiting.len() - 3);
                waiting.push(self.value((u8::MAX, 0), operands));
                steps.extend(waiting.last().map(|&value| Step::Join(value)));
            }
            match op {
                Some(Op::JumpIfZero(_)) => steps.push(Step::Then),
                Some(&Op::Jump(end)) => {
                    ends.push(end as usize);
                    steps.push(Step::Else);
                }
                Some(&op) => {
                    let operands = waiting.split_off(waiting.len() - op.operands().unwrap_or(0));
                    let value = self.value(op.identity(), operands);
                    waiting.push(value);
                    steps.push(Step::Do(op, value));
                }
                None => {}
            }
            height = height.max(waiting.len());
        }
        for value in waiting {
            self.uses[value as usize] += 1;
        }
        steps.push(Step::Result(number));
        height
    }

    fn value(&mut self, (kind, what): (u8, u64), operands: Vec<u32>) -> u32 {
        let new = self.uses.len() as u32;
        let value = *self.known.entry((kind, what, operands.clone())).or_insert(new);
        if value == new {
            self.uses.push(0);
            for operand in operands {
                self.uses[operand as usize] += 1;
            }
        }
        value
    }
}

#[derive(Default)]
struct Writer {
    code: Vec<Op>,
    uses: Vec<u32>,
    /// Where the code of each value begins that waits on the stack.
    starts: Vec<usize>,
    /// Where a value is kept, as far as that was done on every way here; in the order of `log`.
    kept: Vec<Option<u32>>,
    log: Vec<u32>,
    /// How many can be kept, and how many are at most.
    room: usize,
    most: usize,
    /// Of open branches: the jump that does not know its target, and how long the log was.
    branches: Vec<(usize, usize)>,
}

impl Writer {
    fn write(&mut self, step: Step) {
        match step {
            Step::Do(op, value) => {
                self.code.push(op);
                self.finish(value, op.operands().unwrap_or(0));
            }
            Step::Then => {
                self.branches.push((self.code.len(), self.log.len()));
                self.code.push(Op::JumpIfZero(0));
            }
            Step::Else => {
                self.code.push(Op::Jump(0));
                let logged = self.end_branch(Op::JumpIfZero);
                self.branches.push((self.code.len() - 1, logged));
            }
            Step::Join(value) => {
                self.end_branch(Op::Jump);
                self.finish(value, 3);
            }
            Step::Result(number) => {
                self.starts.clear();
                self.code.push(Op::Result(number as u32));
            }
        }
    }

    /// Lets the last open jump lead here, and forgets what was kept since; how much was kept before.
    fn end_branch(&mut self, jump: fn(u32) -> Op) -> usize {
        let (at, logged) = self.branches.pop().expect("a branch is open");
        self.code[at] = jump(self.code.len() as u32);
        self.log.drain(logged..).for_each(|value| self.kept[value as usize] = None);
        logged
    }

    /// The code of a value, whose operands were the last values, has been written: of one that is kept it is not needed.
    fn finish(&mut self, value: u32, operands: usize) {
        let first = self.starts.len() - operands;
        let start = self.starts.get(first).copied().unwrap_or(self.code.len() - 1);
        self.starts.truncate(first);
        self.starts.push(start);
        if let Some(place) = self.kept[value as usize] {
            self.code.truncate(start);
            self.code.push(Op::Recall(place));
        } else if operands > 0 && self.uses[value as usize] > 1 && self.log.len() < self.room {
            let place = (STACK - 1 - self.log.len()) as u32;
            self.code.push(Op::Keep(place));
            self.kept[value as usize] = Some(place);
            self.log.push(value);
            self.most = self.most.max(self.log.len());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metric::{Expression, Variables};

    fn code(texts: &[&str]) -> Vec<Op> {
        let parse = |text: &&str| Expression::program(text, 0..text.len(), Variables::Plane, "expression").unwrap();
        shared(&texts.iter().map(parse).collect::<Vec<_>>()).code.into_vec()
    }

    fn calls(texts: &[&str]) -> usize {
        code(texts).iter().filter(|op| matches!(op, Op::Call(_))).count()
    }

    #[test]
    fn what_occurs_twice_is_computed_once() {
        assert_eq!(calls(&["sin(x)*sin(x) + sin(y)"]), 2);
        assert_eq!(calls(&["1 + exp(-x)^2", "exp(-x)*sin(y)", "exp(-x) + sin(y)"]), 2);
        assert_eq!(calls(&["sin(x + 1) + sin(1 + x)"]), 1);
        assert_eq!(calls(&["sin(x + y) + sin(y + x)"]), 2, "only constants go to one side");
    }

    #[test]
    fn branches_share_what_was_before_them() {
        assert_eq!(calls(&["sin(x) + if(x < y, sin(x), sin(x) + cos(y))"]), 2);
        assert_eq!(calls(&["if(x < y, sin(x), 1) + sin(x)"]), 2, "the branch may not have been taken");
        assert_eq!(calls(&["if(x < y, sin(x), 1) + if(x < y, sin(x), 1)"]), 1);
        assert_eq!(calls(&["if(if(x, y, 1), if(y, sin(x)*sin(x), 2), if(x, 1, if(y, 2, sin(x))))"]), 2);
    }

    #[test]
    fn more_than_there_is_room_for_is_computed_again() {
        let terms: Vec<String> = (0..100).map(|i| format!("sin(x + {i})*sin(x + {i})")).collect();
        let text = terms.join(" + ");
        assert!((100..200).contains(&calls(&[&text])));
        let expression = Expression::parse(&text, Variables::Plane).unwrap();
        let truth = (0..100).fold(0.0, |sum, i| sum + (0.5 + f64::from(i)).sin().powi(2));
        assert!((expression.at(0.5, 0.0, 0.0) - truth).abs() < 1e-12 * truth);
    }
}
