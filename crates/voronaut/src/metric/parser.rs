//! From the text of an expression to its program: one pass, precedence climbing, constants folded.

use super::program::{Op, STACK, folded};
use super::vocabulary::{COMPARISON, CONSTANTS, FUNCTIONS, Function, OPERATORS, POWER, SIGN, Variables};
use crate::error::{Error, Result};
use std::ops::Range;

/// A parser and the program it has written so far.
pub(super) struct Parser<'a> {
    text: &'a str,
    /// The next byte to read, and the end of the part to be read.
    at: usize,
    end: usize,
    variables: Variables,
    /// What the text is called in messages.
    name: &'a str,
    code: Vec<Op>,
    /// Values on the stack after `code`.
    height: usize,
    /// Instructions before this one are jumped over or to: constants there must not be folded.
    barrier: usize,
    nesting: usize,
}

/// How deep parentheses, calls, signs and powers may nest: the parser recurses.
const MAX_NESTING: usize = 200;

impl<'a> Parser<'a> {
    pub(super) fn new(text: &'a str, range: Range<usize>, variables: Variables, name: &'a str) -> Self {
        let Range { start: at, end } = range;
        Self { text, at, end, variables, name, code: Vec::new(), height: 0, barrier: 0, nesting: 0 }
    }

    /// The program of the whole range.
    pub(super) fn parse(mut self) -> Result<Vec<Op>> {
        self.expression(0)?;
        match self.rest().chars().next() {
            None => Ok(self.code),
            Some(')') => Err(self.error("`)` without its `(`", "remove it, or open it before")),
            Some('=') => Err(self.error("`=` is not an operator", "write == to compare")),
            Some(c) => Err(self.error(
                &format!("an operator was expected, not `{c}`"),
                "operators are + - * / ^ < <= > >= == != and or; products need their *: 2*x",
            )),
        }
    }

    /// An operand and every operator after it that binds at least as tightly as `least`.
    fn expression(&mut self, least: u8) -> Result<()> {
        self.nesting += 1;
        if self.nesting > MAX_NESTING {
            let what = format!("more than {MAX_NESTING} levels of parentheses, functions, signs or powers");
            return Err(self.error(&what, "use fewer levels"));
        }
        let start = self.code.len();
        self.operand()?;
        let mut compared = false;
        while let Some((spelling, binding, op)) = self.operator().filter(|o| o.1 >= least) {
            if binding == COMPARISON && compared {
                return Err(self.error("comparisons do not chain", "write 0 < x and x < 1"));
            }
            compared = binding == COMPARISON;
            self.at += spelling.len();
            // Everything but a power groups from the left: its right operand binds more tightly.
            let right = self.code.len();
            self.expression(if binding == POWER { POWER } else { binding + 1 })?;
            self.combine(op, start, right)?;
        }
        self.nesting -= 1;
        Ok(())
    }

    /// Appends the operation of two operands whose code begins at these places. A left one that is a constant becomes a part of it, as a right one
    /// does in `fold`: sums and products are the same to the bit when they are turned around.
    fn combine(&mut self, op: Op, left: usize, right: usize) -> Result<()> {
        let (&[Op::Constant(c)], false) = (&self.code[left..right], matches!(self.code[right..], [Op::Constant(_)]))
        else {
            return self.emit(op);
        };
        let with_constant = match op {
            Op::Add | Op::Subtract => Op::Plus(c),
            Op::Multiply => Op::Times(c),
            _ => return self.emit(op),
        };
        self.code.remove(left);
        self.height -= 1;
        self.barrier -= usize::from(self.barrier > left);
        for op in &mut self.code[left..] {
            if let Op::Jump(target) | Op::JumpIfZero(target) = op {
                *target -= 1;
            }
        }
        if let Op::Subtract = op {
            self.emit(Op::Negate)?;
        }
        self.emit(with_constant)
    }

    fn operand(&mut self) -> Result<()> {
        let rest = self.rest();
        match rest.chars().next() {
            Some('-') => {
                self.at += 1;
                self.expression(SIGN)?;
                self.emit(Op::Negate)
            }
            Some('+') => {
                self.at += 1;
                self.expression(SIGN)
            }
            Some('(') => {
                self.at += 1;
                self.expression(0)?;
                self.expect(")")
            }
            Some('0'..='9' | '.') => self.number(),
            Some(c) if c.is_ascii_alphabetic() || c == '_' => self.name(),
            found => {
                let found = found.map_or("the end".into(), |c| format!("`{c}`"));
                let help = "write a number, a name or a parenthesis there; ^ is the power";
                Err(self.error(&format!("a value was expected, not {found}"), help))
            }
        }
    }

    fn number(&mut self) -> Result<()> {
        let rest = self.rest();
        let digits = |from: usize| rest[from..].bytes().take_while(u8::is_ascii_digit).count();
        let mut length = digits(0);
        if rest[length..].starts_with('.') {
            length += 1 + digits(length + 1);
        }
        if rest[length..].starts_with(['e', 'E']) {
            let sign = usize::from(rest[length + 1..].starts_with(['+', '-']));
            match digits(length + 1 + sign) {
                0 => {}
                exponent => length += 1 + sign + exponent,
            }
        }
        match rest[..length].parse::<f64>() {
            Ok(value) if value.is_finite() => {
                self.at += length;
                self.emit(Op::Constant(value))
            }
            _ => Err(self.error(&format!("`{}` is not a finite number", &rest[..length]), "write it as 1.5 or 2e-3")),
        }
    }

    fn name(&mut self) -> Result<()> {
        let name = word(self.rest());
        if let Some((_, function)) = FUNCTIONS.iter().find(|(f, _)| *f == name) {
            return self.call(name, function);
        }
        let op = match (name, self.variables) {
            ("x", _) => Op::Variable(0),
            ("y", _) => Op::Variable(1),
            ("z", Variables::Space | Variables::SpaceMotion) | ("t", Variables::Motion) => Op::Variable(2),
            ("t", Variables::SpaceMotion) => Op::Variable(3),
            ("z", _) => {
                let help = if self.variables == Variables::Motion { "use x, y and t" } else { "use x and y" };
                return Err(self.error("z is not a variable in the plane", help));
            }
            _ => match CONSTANTS.iter().find(|(c, _)| *c == name) {
                Some(&(_, value)) => Op::Constant(value),
                None => return Err(self.unknown(name)),
            },
        };
        self.at += name.len();
        self.emit(op)
    }

    fn unknown(&self, name: &str) -> Error {
        let variables = match self.variables {
            Variables::Plane => "x y",
            Variables::Space => "x y z",
            Variables::Motion => "x y t",
            Variables::SpaceMotion => "x y z t",
        };
        let functions: Vec<&str> = FUNCTIONS.iter().map(|(f, _)| *f).collect();
        let help = format!("variables: {variables}; constants: pi e; functions: {}", functions.join(" "));
        self.error(&format!("unknown name `{name}`"), &help)
    }

    fn call(&mut self, name: &str, function: &Function) -> Result<()> {
        let start = self.at;
        self.at += name.len();
        if !self.rest().starts_with('(') {
            return Err(self.error("a `(` was expected", &format!("{name} is a function: write {name}(...)")));
        }
        self.at += 1;
        if let Function::If = function {
            return self.branches();
        }
        let mut count = 0;
        loop {
            self.expression(0)?;
            count += 1;
            if let (Function::Many(op), 2..) = (function, count) {
                self.emit(*op)?;
            }
            if !self.rest().starts_with(',') {
                break;
            }
            self.at += 1;
        }
        self.expect(")")?;
        let needed = match (function, count) {
            (Function::One(f), 1) => return self.emit(Op::Call(f)),
            (Function::Two(op), 2) => return self.emit(*op),
            (Function::Many(_), 2..) => return Ok(()),
            (Function::One(_), _) => "1 argument",
            (Function::Many(_), _) => "2 or more arguments",
            _ => "2 arguments",
        };
        self.at = start;
        Err(self.error(&format!("{name} takes {needed}, not {count}"), "arguments are separated by commas"))
    }

    /// The arguments of `if(c, a, b)`: c, over a if zero, a, over b, b.
    fn branches(&mut self) -> Result<()> {
        self.expression(0)?;
        self.expect(",")?;
        let over_first = self.jump(Op::JumpIfZero);
        self.height -= 1;
        self.expression(0)?;
        self.expect(",")?;
        let over_second = self.jump(Op::Jump);
        self.height -= 1;
        self.code[over_first] = Op::JumpIfZero(self.code.len() as u32);
        self.expression(0)?;
        self.expect(")")?;
        self.code[over_second] = Op::Jump(self.code.len() as u32);
        self.barrier = self.code.len();
        Ok(())
    }

    /// Writes a jump whose target is not known yet; its place.
    fn jump(&mut self, op: fn(u32) -> Op) -> usize {
        self.code.push(op(0));
        self.barrier = self.code.len();
        self.code.len() - 1
    }

    /// Appends an instruction, or does it now where its operands are constants.
    fn emit(&mut self, op: Op) -> Result<()> {
        let operands = op.operands().expect("jumps are written by `jump`");
        let (replaced, op_now) = fold(op, operands, &self.code[self.barrier..]).unwrap_or((0, op));
        self.code.truncate(self.code.len() - replaced);
        self.code.push(op_now);
        self.height = self.height + 1 - operands;
        if self.height >= STACK {
            let what = format!("more than {} unfinished operations", STACK - 1);
            return Err(self.error(&what, "write 1 + x + y rather than 1 + (x + (y)), or use fewer levels"));
        }
        Ok(())
    }

    /// The operator that comes next.
    fn operator(&mut self) -> Option<(&'static str, u8, Op)> {
        let rest = self.rest();
        let matches = |spelling: &str| {
            rest.starts_with(spelling) && (!spelling.starts_with(char::is_alphabetic) || word(rest) == spelling)
        };
        OPERATORS.into_iter().find(|(spelling, ..)| matches(spelling))
    }

    fn expect(&mut self, what: &str) -> Result<()> {
        let found = match self.rest().chars().next() {
            Some(c) if what.starts_with(c) => {
                self.at += what.len();
                return Ok(());
            }
            Some(c) => format!("`{c}`"),
            None => "the end".into(),
        };
        let help = if what == "," { "if takes 3 arguments: if(condition, then, otherwise)" } else { "close it" };
        Err(self.error(&format!("a `{what}` was expected, not {found}"), help))
    }

    /// What is left to read, without leading white space.
    fn rest(&mut self) -> &'a str {
        let rest = &self.text[self.at..self.end];
        let trimmed = rest.trim_start();
        self.at += rest.len() - trimmed.len();
        trimmed
    }

    /// An error at the next byte.
    fn error(&self, what: &str, help: &str) -> Error {
        error_at(self.text, self.at, self.name, what, help)
    }
}

/// What `op` after `code` comes down to: how many instructions at the end of `code` one other replaces.
fn fold(op: Op, operands: usize, code: &[Op]) -> Option<(usize, Op)> {
    let taken = &code[code.len().checked_sub(operands)?..];
    if operands > 0 && taken.iter().all(|op| matches!(op, Op::Constant(_))) {
        return Some((operands, Op::Constant(folded(taken, op))));
    }
    let [.., Op::Constant(c)] = *code else { return None };
    let with_constant = match op {
        Op::Add => Op::Plus(c),
        Op::Subtract => Op::Plus(-c),
        Op::Multiply => Op::Times(c),
        Op::Divide => Op::Over(c),
        Op::Power if c.total_cmp(&2.0).is_eq() => Op::Square,
        _ => return None,
    };
    Some((1, with_constant))
}

/// A parse error with its column and the text around it, a caret below the place.
pub(super) fn error_at(text: &str, at: usize, name: &str, what: &str, help: &str) -> Error {
    /// Characters shown on each side of the place.
    const AROUND: usize = 30;
    let before = text[..at].chars().count();
    let hidden = before.saturating_sub(AROUND);
    let shown = text.chars().skip(hidden).take(2 * AROUND).map(|c| if c.is_control() { ' ' } else { c });
    let lead = if hidden > 0 { "..." } else { "" };
    let tail = if text.chars().nth(hidden + 2 * AROUND).is_some() { "..." } else { "" };
    let excerpt: String = shown.collect();
    let space = " ".repeat(lead.len() + before - hidden);
    let what = format!("{what}\n  {lead}{excerpt}{tail}\n  {space}^");
    Error::parse(format!("{name}, column {}", before + 1), what, help)
}

fn word(text: &str) -> &str {
    let end = text.find(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    &text[..end.unwrap_or(text.len())]
}

#[cfg(test)]
mod tests {
    use crate::metric::{Expression, Variables};

    fn failure(text: &str) -> (String, String) {
        let error = Expression::parse(text, Variables::Plane).unwrap_err();
        (error.to_string(), error.help().to_string())
    }

    #[test]
    fn each_mistake_is_named_with_its_column() {
        for (text, column, message, help) in [
            ("", 1, "a value was expected, not the end", "number"),
            ("1 +", 4, "a value was expected, not the end", "number"),
            ("1 ** 2", 4, "a value was expected, not `*`", "^ is the power"),
            ("2x", 2, "an operator was expected, not `x`", "2*x"),
            ("2 e", 3, "an operator was expected, not `e`", "2*x"),
            ("x = 1", 3, "`=` is not an operator", "=="),
            ("x)", 2, "`)` without its `(`", "remove"),
            ("(x", 3, "a `)` was expected, not the end", "close"),
            ("foo(x)", 1, "unknown name `foo`", "functions: sin cos tan asin"),
            ("x + Sin(x)", 5, "unknown name `Sin`", "variables: x y; constants: pi e"),
            ("z", 1, "z is not a variable in the plane", "x and y"),
            ("sin x", 5, "a `(` was expected", "write sin(...)"),
            ("1 + sin(x, y)", 5, "sin takes 1 argument, not 2", "commas"),
            ("atan2(x)", 1, "atan2 takes 2 arguments, not 1", "commas"),
            ("min(x)", 1, "min takes 2 or more arguments, not 1", "commas"),
            ("if(x, y)", 8, "a `,` was expected, not `)`", "if(condition, then, otherwise)"),
            ("sin()", 5, "a value was expected, not `)`", "number"),
            ("0 < x < 1", 7, "comparisons do not chain", "0 < x and x < 1"),
            ("1e999", 1, "`1e999` is not a finite number", "2e-3"),
            (".", 1, "`.` is not a finite number", "1.5"),
            ("é + x", 1, "a value was expected, not `é`", "number"),
            ("x & y", 3, "an operator was expected, not `&`", "and"),
        ] {
            let (error, hint) = failure(text);
            assert!(error.starts_with(&format!("expression, column {column}: {message}")), "{text}: {error}");
            assert!(hint.contains(help), "{text}: {hint}");
        }
    }

    #[test]
    fn a_caret_points_at_the_place() {
        let (error, _) = failure("1 + foo(x)");
        assert_eq!(error, "expression, column 5: unknown name `foo`\n  1 + foo(x)\n      ^");
        let long = format!("{}foo{}", "x + ".repeat(50), " + y".repeat(50));
        let (error, _) = failure(&long);
        let lines: Vec<&str> = error.lines().collect();
        assert!(lines[0].contains("column 201"));
        assert!(lines[1].starts_with("  ...") && lines[1].ends_with("..."));
        assert_eq!(&lines[1][lines[2].len() - 1..][..3], "foo");
    }

    #[test]
    fn hostile_depth_is_an_error() {
        for text in ["(".repeat(1_000_000), "-".repeat(1_000_000), "sin(".repeat(100_000)] {
            assert!(failure(&text).0.contains("more than 200 levels"), "{}", failure(&text).0);
        }
        assert!(failure(&"2^".repeat(100_000)).0.contains("more than 63 unfinished operations"));
        let waiting = format!("{}x{}", "x+(".repeat(100), ")".repeat(100));
        assert!(failure(&waiting).0.contains("more than 63 unfinished operations"));
    }
}
