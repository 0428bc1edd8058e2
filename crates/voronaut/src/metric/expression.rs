//! Expressions in x, y and z: compiled once to a flat program that runs without allocating.

use super::parser::Parser;
use super::program::{Op, Program};
use super::series::Series;
use super::sharing::shared;
use super::vocabulary::Variables;
use crate::error::Result;
use crate::geometry::{Jet, Jet3, Point, Point3, Vector3};
use std::ops::Range;

/// A compiled expression. From loosest to tightest:
///
/// | | |
/// |---|---|
/// | `or` (also <code>&#124;&#124;</code>), then `and` (`&&`) | 1 or 0; what is not zero counts as true |
/// | `<` `<=` `>` `>=` `==` `!=` | 1 or 0; they do not chain |
/// | `+` `-`, then `*` `/` | from the left |
/// | unary `-` `+` | `-x^2` is `-(x^2)` |
/// | `^` | from the right: `2^3^2` is `2^9` |
///
/// Functions: `sin cos tan asin acos atan atan2(y, x) sinh cosh tanh exp log` (natural) `sqrt abs`, `min` and `max` of
/// two or more, and `if(c, a, b)`, which evaluates only the branch it takes. Constants: `pi`, `e`. Arithmetic is IEEE
/// double precision: 1/0 is infinite, sqrt(-1) is NaN.
#[derive(Clone, Debug)]
pub struct Expression {
    program: Program,
    /// The value of t, in expressions of space that change.
    time: f64,
}

impl Expression {
    /// Compiles a text.
    ///
    /// # Errors
    /// [`Error::Parse`](crate::Error::Parse) with the column (from 1, in characters), the text and a caret below it.
    pub fn parse(text: &str, variables: Variables) -> Result<Self> {
        Self::named(text, variables, "expression")
    }

    /// Compiles a text that `name` names in messages.
    pub(crate) fn named(text: &str, variables: Variables, name: &str) -> Result<Self> {
        let program = Self::program(text, 0..text.len(), variables, name)?;
        Ok(Self { program: shared(&[program]), time: 0.0 })
    }

    /// The program of a part of a text; columns count from the start of the whole text, which `name` names in messages.
    pub(super) fn program(text: &str, range: Range<usize>, variables: Variables, name: &str) -> Result<Vec<Op>> {
        Parser::new(text, range, variables, name).parse()
    }

    /// The same at another time, of [`Variables::SpaceMotion`].
    #[must_use]
    pub(crate) fn at_time(&self, time: f64) -> Self {
        Self { time, ..self.clone() }
    }

    /// The value at a point; z is not used by expressions of the plane, and is the time of those with one.
    pub(crate) fn at(&self, x: f64, y: f64, z: f64) -> f64 {
        let [value] = self.program.run([x, y, z, self.time]);
        value
    }

    /// The value at a point with its first and second derivatives, exact but for rounding. Where an expression jumps or
    /// has a kink (comparisons, `if`, `abs`, `min`, `max`) they are those of one side.
    pub(crate) fn jet(&self, p: Point3) -> Jet3 {
        let [x, y, z] = Jet3::coordinates(p.x, p.y, p.z);
        let [value] = self.program.run([x, y, z, self.time.into()]);
        value
    }

    /// The same of an expression of the plane, or of x, y and t.
    pub(super) fn planar_jet(&self, p: Point, time: f64) -> Jet {
        let [x, y] = Jet::coordinates(p.x, p.y);
        let [value] = self.program.run([x, y, time.into(), self.time.into()]);
        value
    }

    /// The value at a point and along a line, with derivatives up to the fourth; of kinks as [`Expression::jet`] has it.
    pub(super) fn along(&self, p: Point3, v: Vector3) -> Series {
        let [x, y, z] = [(p.x, v.x), (p.y, v.y), (p.z, v.z)].map(|(from, step)| Series::line(from, step));
        let [value] = self.program.run([x, y, z, self.time.into()]);
        value
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "exact results are the point")]
mod tests {
    use super::*;
    use crate::test_cases::cases;
    use proptest::prelude::*;

    fn value(text: &str) -> f64 {
        Expression::parse(text, Variables::Space).unwrap().at(0.5, -2.0, 7.0)
    }

    #[test]
    fn precedence_and_associativity() {
        for (text, truth) in [
            ("1 + 2 * 3", 7.0),
            ("1 - 2 - 3", -4.0),
            ("24 / 4 / 2", 3.0),
            ("2 ^ 3 ^ 2", 512.0),
            ("-2 ^ 2", -4.0),
            ("2 ^ -1", 0.5),
            ("2 ^ -1 * 4", 2.0),
            ("(-2) ^ 2", 4.0),
            ("--3", 3.0),
            ("2 * -3", -6.0),
            ("-2 * 3 + +1", -5.0),
            ("1 + 1 < 3 and 2 > 1", 1.0),
            ("0 and 0 or 1", 1.0),
            ("1 || 1 && 0", 1.0),
            ("x*x + y^2 + z", 11.25),
            ("-y^2", -4.0),
            ("-x*-y", -1.0),
            ("1e3 + .5 + 2.", 1002.5),
            ("2E-1*10", 2.0),
        ] {
            assert!((value(text) - truth).abs() < 1e-15, "{text} = {}, not {truth}", value(text));
        }
    }

    #[test]
    fn functions_are_the_ones_their_names_say() {
        for (text, truth) in [
            ("sin(x)^2 + cos(x)^2", 1.0),
            ("tan(x) - sin(x)/cos(x)", 0.0),
            ("asin(sin(x)) + acos(cos(x)) + atan(tan(x))", 1.5),
            ("atan2(1, -1)", 0.75 * std::f64::consts::PI),
            ("cosh(x)^2 - sinh(x)^2", 1.0),
            ("tanh(x) - sinh(x)/cosh(x)", 0.0),
            ("log(exp(y))", -2.0),
            ("e - exp(1)", 0.0),
            ("sin(pi/6)", 0.5),
            ("sqrt(abs(y)*2)", 2.0),
            ("min(3, x, z) + max(x, z)", 7.5),
            ("(1<1) + 10*(1<=1) + 100*(2>1) + 1000*(1>=2) + 10000*(1==1) + 100000*(1!=1)", 10110.0),
        ] {
            assert!((value(text) - truth).abs() < 1e-14, "{text} = {}, not {truth}", value(text));
        }
    }

    #[test]
    fn if_takes_one_branch() {
        assert_eq!(value("if(x < 1, 2, 3) + 10"), 12.0);
        assert_eq!(value("if(x > 1, 2, 3) + 10"), 13.0);
        assert_eq!(value("if(0, 1, 2) * if(1, 3, 4) ^ 2"), 18.0);
        assert_eq!(value("if(y < 0, if(x < 0, 1, 2), 3)"), 2.0);
        assert_eq!(value("if(1, x, sqrt(-1)/0)"), 0.5);
    }

    #[test]
    fn long_sums_and_deep_ifs_are_fine() {
        let sum = vec!["x"; 100_000].join("+");
        assert_eq!(value(&sum), 50_000.0);
        let ifs = format!("{}1{}", "if(x>1,y,".repeat(150), ")".repeat(150));
        assert_eq!(value(&ifs), 1.0);
    }

    /// A tree with its own evaluator and printer, to hold the compiled program against.
    #[derive(Clone, Debug)]
    enum Tree {
        Number(f64),
        Name(&'static str),
        Negative(Box<Tree>),
        Binary(&'static str, Box<Tree>, Box<Tree>),
        Call(&'static str, Vec<Tree>),
    }

    impl Tree {
        fn value(&self) -> f64 {
            match self {
                Tree::Number(v) => *v,
                Tree::Name(name) => [("x", 0.5), ("y", -2.0), ("z", 7.0)].iter().find(|(n, _)| n == name).unwrap().1,
                Tree::Negative(a) => -a.value(),
                Tree::Binary(op, a, b) => {
                    let (a, b) = (a.value(), b.value());
                    match *op {
                        "+" => a + b,
                        "-" => a - b,
                        "*" => a * b,
                        "/" => a / b,
                        "^" => a.powf(b),
                        "<" => f64::from(u8::from(a < b)),
                        _ => f64::from(u8::from(a != 0.0 && b != 0.0)),
                    }
                }
                Tree::Call(name, arguments) => {
                    let v: Vec<f64> = arguments.iter().map(Tree::value).collect();
                    match *name {
                        "sin" => v[0].sin(),
                        "max" => v[0].max(v[1]),
                        _ => {
                            if v[0] == 0.0 {
                                v[2]
                            } else {
                                v[1]
                            }
                        }
                    }
                }
            }
        }

        /// How tightly the outermost operation binds.
        fn binding(&self) -> u8 {
            match self {
                Tree::Binary("and", ..) => 1,
                Tree::Binary("<", ..) => 2,
                Tree::Binary("+" | "-", ..) => 3,
                Tree::Binary("*" | "/", ..) => 4,
                Tree::Negative(_) => 5,
                Tree::Binary(..) => 6,
                Tree::Number(_) | Tree::Name(_) | Tree::Call(..) => 7,
            }
        }

        /// Text with parentheses only where they are needed.
        fn print(&self) -> String {
            let wrap = |tree: &Tree, needed: u8| {
                if tree.binding() < needed { format!("({})", tree.print()) } else { tree.print() }
            };
            match self {
                Tree::Number(v) => format!("{v}"),
                Tree::Name(name) => (*name).into(),
                Tree::Negative(a) => format!("-{}", wrap(a, 5)),
                Tree::Binary("^", a, b) => format!("{}^{}", wrap(a, 7), wrap(b, 5)),
                Tree::Binary(op, a, b) => {
                    let own = self.binding();
                    format!("{} {op} {}", wrap(a, own + u8::from(*op == "<")), wrap(b, own + 1))
                }
                Tree::Call(name, arguments) => {
                    let list: Vec<String> = arguments.iter().map(Tree::print).collect();
                    format!("{name}({})", list.join(", "))
                }
            }
        }
    }

    fn trees() -> impl Strategy<Value = Tree> {
        let leaf = prop_oneof![
            (0.0..4.0).prop_map(Tree::Number),
            (0..4u8).prop_map(|i| Tree::Number(f64::from(i))),
            prop::sample::select(vec!["x", "y", "z"]).prop_map(Tree::Name),
        ];
        leaf.prop_recursive(5, 40, 3, |inner| {
            let op = prop::sample::select(vec!["+", "-", "*", "/", "^", "<", "and"]);
            prop_oneof![
                inner.clone().prop_map(|a| Tree::Negative(a.into())),
                (op, inner.clone(), inner.clone()).prop_map(|(op, a, b)| Tree::Binary(op, a.into(), b.into())),
                inner.clone().prop_map(|a| Tree::Call("sin", vec![a])),
                [inner.clone(), inner.clone()].prop_map(|a| Tree::Call("max", a.into())),
                [inner.clone(), inner.clone(), inner].prop_map(|a| Tree::Call("if", a.into())),
            ]
        })
    }

    proptest! {
        #![proptest_config(cases(2000))]
        #[test]
        fn what_is_printed_is_what_is_computed(tree in trees()) {
            let (text, truth) = (tree.print(), tree.value());
            let computed = value(&text);
            let same = computed == truth || computed.is_nan() && truth.is_nan();
            prop_assert!(same || (computed - truth).abs() < 1e-12 * truth.abs(), "{}: {} {}", text, computed, truth);
        }

        #[test]
        fn no_text_panics(text in "[-+*/^(),.;<>=!&|0-9a-z \u{e9}]{0,60}") {
            if let Ok(expression) = Expression::parse(&text, Variables::Plane) {
                expression.at(1.0, 2.0, 0.0);
            }
        }
    }
}
