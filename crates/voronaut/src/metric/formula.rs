//! Fields from formulas: metrics from those of their entries, functions at one time.

use super::expression::Expression;
use super::parser::error_at;
use super::program::{Op, Program};
use super::sharing::shared;
use super::vocabulary::Variables;
use super::{MetricField, ScalarField};
use crate::error::{Error, Result};
use crate::geometry::{Jet, Point, Point3, Tensor, Tensor3, Vector, Vector3};

/// The field ((m11, m12), (m12, m22)) of three expressions in x and y; see [`Expression`] for what they may hold.
///
/// The values are those of the expressions, whatever they are: `check_tensor` says where they
/// make no metric.
#[derive(Clone, Debug)]
pub struct Formula {
    /// All entries.
    program: Program,
}

/// The field of space with entries m11, m12, m22, m13, m23, m33 of six expressions in x, y and z; the order is that of
/// Medit's `.sol` files. Values as for [`Formula`].
#[derive(Clone, Debug)]
pub struct SpaceFormula {
    /// All entries.
    program: Program,
}

impl Formula {
    /// Compiles `m11; m12; m22`.
    ///
    /// # Errors
    /// [`Error::Parse`] with the column and the place shown; [`Error::Unsupported`] of six entries, which are a
    /// surface's.
    pub fn planar(text: &str) -> Result<Self> {
        if text.matches(';').count() == 5 {
            return Err(Error::unsupported(
                "a formula of six entries: metrics of space",
                "in the plane write three entries: m11; m12; m22",
            ));
        }
        Ok(Self { program: entries(text, &["m11", "m12", "m22"], "three", Variables::Plane)? })
    }
}

impl SpaceFormula {
    /// Compiles `m11; m12; m22; m13; m23; m33`.
    ///
    /// # Errors
    /// [`Error::Parse`] with the column and the place shown.
    pub(crate) fn parse(text: &str) -> Result<Self> {
        let names = ["m11", "m12", "m22", "m13", "m23", "m33"];
        Ok(Self { program: entries(text, &names, "six", Variables::Space)? })
    }

    /// The tensor at a point.
    pub(crate) fn tensor(&self, p: Point3) -> Tensor3 {
        Tensor3::from_disk(self.program.run([p.x, p.y, p.z, 0.0]))
    }
}

/// The program of expressions between semicolons, as many as there are names; `count` is their number as a word.
fn entries(text: &str, names: &[&str], count: &str, variables: Variables) -> Result<Program> {
    let mut starts = vec![0];
    starts.extend(text.match_indices(';').map(|(at, _)| at + 1));
    if starts.len() != names.len() {
        let at = if starts.len() < names.len() { text.len() } else { starts[names.len()] - 1 };
        let what = format!("{count} entries were expected, not {}", starts.len());
        let coordinates = if variables == Variables::Plane { "x and y" } else { "x, y and z" };
        let help = format!("write {}, each in {coordinates}", names.join("; "));
        return Err(error_at(text, at, "formula", &what, &help));
    }
    let program = |(i, name): (usize, &&str)| {
        let range = starts[i]..starts.get(i + 1).map_or(text.len(), |next| next - 1);
        Expression::program(text, range, variables, &format!("formula {name}"))
    };
    let programs: Vec<Vec<Op>> = names.iter().enumerate().map(program).collect::<Result<_>>()?;
    Ok(shared(&programs))
}

impl MetricField for Formula {
    fn at(&self, p: Point) -> Tensor {
        let [m11, m12, m22] = self.program.run([p.x, p.y, 0.0, 0.0]);
        Tensor::new(m11, m12, m22)
    }
}

/// An expression in x, y and t at one time.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// The expression, of [`Variables::Motion`] or of the plane.
    pub expression: Expression,
    /// The value of t.
    pub time: f64,
}

impl Snapshot {
    /// The exact derivative of an order, up to the fourth, along a vector.
    pub(crate) fn derivative(&self, p: Point, v: Vector, order: usize) -> f64 {
        self.expression.along(Point3::new(p.x, p.y, self.time), Vector3::new(v.x, v.y, 0.0)).derivative(order)
    }

    /// Exact second derivatives by x and y.
    pub fn second_derivatives(&self, p: Point) -> Tensor {
        self.expression.planar_jet(p, self.time).hessian
    }
}

impl From<Expression> for Snapshot {
    fn from(expression: Expression) -> Self {
        Self { expression, time: 0.0 }
    }
}

impl ScalarField for Snapshot {
    fn value(&self, p: Point) -> f64 {
        self.expression.at(p.x, p.y, self.time)
    }

    fn jet(&self, p: Point) -> Option<Jet> {
        Some(self.expression.planar_jet(p, self.time))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metric::check_tensor;

    #[test]
    fn entries_are_in_the_order_of_the_text() {
        let field = Formula::planar("1 + x^2; x*y; if(y < 0, 4, 9)").unwrap();
        assert_eq!(field.at(Point::new(3.0, 0.5)), Tensor::new(10.0, 1.5, 9.0));
        assert_eq!(field.at(Point::new(0.0, -0.5)), Tensor::new(1.0, 0.0, 4.0));
    }

    #[test]
    fn errors_name_the_entry_and_the_column_of_the_whole_text() {
        let error = Formula::planar("1; 0; 1 + sni(x)").unwrap_err();
        assert_eq!(error.to_string(), "formula m22, column 11: unknown name `sni`\n  1; 0; 1 + sni(x)\n            ^");
        assert!(error.help().contains("functions: sin"));
        let error = Formula::planar("1; ; 1").unwrap_err();
        assert!(error.to_string().starts_with("formula m12, column 4: a value was expected, not the end"), "{error}");
        let error = Formula::planar("1; 0; z").unwrap_err();
        assert!(error.to_string().contains("z is not a variable in the plane"), "{error}");
    }

    #[test]
    fn the_number_of_entries_is_checked() {
        let error = Formula::planar("1; 0").unwrap_err();
        assert!(error.to_string().starts_with("formula, column 5: three entries were expected, not 2"), "{error}");
        assert_eq!(error.help(), "write m11; m12; m22, each in x and y");
        let error = Formula::planar("1; 0; 1; 0").unwrap_err();
        assert!(error.to_string().starts_with("formula, column 8: three entries were expected, not 4"), "{error}");
        assert!(matches!(Formula::planar("1;0;1;0;0;1"), Err(Error::Unsupported { .. })));
    }

    #[test]
    fn entries_of_space_are_in_the_order_of_solution_files() {
        let field = SpaceFormula::parse("1; x; 2+z; y; 0; 9").unwrap();
        let m = field.tensor(Point3::new(0.25, 0.5, 7.0));
        assert_eq!(m, Tensor3 { xx: 1.0, xy: 0.25, yy: 9.0, xz: 0.5, yz: 0.0, zz: 9.0 });
        let error = SpaceFormula::parse("1; 0; 1; 0; 0; q").unwrap_err();
        assert!(error.to_string().starts_with("formula m33, column 16: unknown name `q`"), "{error}");
        let error = SpaceFormula::parse("1; 0; 1").unwrap_err();
        assert!(error.to_string().starts_with("formula, column 8: six entries were expected, not 3"), "{error}");
        assert_eq!(error.help(), "write m11; m12; m22; m13; m23; m33, each in x, y and z");
    }

    #[test]
    fn values_are_validated_where_they_are_used() {
        let field = Formula::planar("x; 0; 1").unwrap();
        let p = Point::new(-1.0, 0.0);
        assert!(check_tensor(field.at(p), p).is_err());
        let field = Formula::planar("1/x; 0; 1").unwrap();
        let error = check_tensor(field.at(Point::default()), Point::default()).unwrap_err();
        assert!(error.to_string().contains("m11 = inf"), "{error}");
    }
}
