//! A metric field from the formulas of its entries.

use super::MetricField;
use super::expression::{Expression, Variables};
use super::parser::error_at;
use crate::error::{Error, Result};
use crate::geometry::{Point, Tensor};

/// The field ((m11, m12), (m12, m22)) of three expressions in x and y; see [`Expression`] for what they may hold.
///
/// The values are those of the expressions, whatever they are: [`check_tensor`](super::check_tensor) says where they
/// make no metric.
#[derive(Clone, Debug)]
pub struct Formula {
    entries: [Expression; 3],
}

impl Formula {
    /// Compiles `m11; m12; m22`.
    ///
    /// # Errors
    /// [`Error::Parse`] with the column and the place shown; [`Error::Unsupported`] of six entries, which are a
    /// surface's.
    pub fn planar(text: &str) -> Result<Self> {
        let mut starts = vec![0];
        starts.extend(text.match_indices(';').map(|(at, _)| at + 1));
        let range = |i: usize| starts[i]..starts.get(i + 1).map_or(text.len(), |next| next - 1);
        match starts.len() {
            3 => {}
            6 => {
                return Err(Error::Unsupported {
                    what: "a formula of six entries: metrics of space".into(),
                    help: "in the plane write three entries: m11; m12; m22".into(),
                });
            }
            count => {
                let at = if count < 3 { text.len() } else { starts[3] - 1 };
                let what = format!("three entries were expected, not {count}");
                return Err(error_at(text, at, "formula", &what, "write m11; m12; m22, each in x and y"));
            }
        }
        let entry = |i, name: &str| Expression::parse_range(text, range(i), Variables::Plane, name);
        Ok(Self { entries: [entry(0, "formula m11")?, entry(1, "formula m12")?, entry(2, "formula m22")?] })
    }
}

impl MetricField for Formula {
    fn at(&self, p: Point) -> Tensor {
        let [m11, m12, m22] = &self.entries;
        Tensor::new(m11.at(p.x, p.y, 0.0), m12.at(p.x, p.y, 0.0), m22.at(p.x, p.y, 0.0))
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
    fn values_are_validated_where_they_are_used() {
        let field = Formula::planar("x; 0; 1").unwrap();
        let p = Point::new(-1.0, 0.0);
        assert!(check_tensor(field.at(p), p).is_err());
        let field = Formula::planar("1/x; 0; 1").unwrap();
        let error = check_tensor(field.at(Point::default()), Point::default()).unwrap_err();
        assert!(error.to_string().contains("m11 = inf"), "{error}");
    }
}
