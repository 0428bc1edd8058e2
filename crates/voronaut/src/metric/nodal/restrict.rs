//! Limits on sizes and anisotropy that may differ from vertex to vertex.

use crate::error::{Error, Result};
use crate::geometry::Tensor;
use crate::metric::Bounds;

/// A limit: one number, or one for each vertex.
#[derive(Clone, Debug, PartialEq)]
pub enum Limit {
    /// The same everywhere.
    Number(f64),
    /// One for each vertex.
    Field(Vec<f64>),
}

impl Limit {
    fn at(&self, v: usize) -> f64 {
        match self {
            Limit::Number(value) => *value,
            Limit::Field(values) => values[v],
        }
    }
}

/// Limits on a metric at vertices, each a [`Limit`] or none: [`Bounds`] that may vary.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Limits {
    /// No (Euclidean) size is smaller.
    pub h_min: Option<Limit>,
    /// No size is larger.
    pub h_max: Option<Limit>,
    /// The longer size is at most so many times the shorter one; at least 1.
    pub a_max: Option<Limit>,
}

impl From<Bounds> for Limits {
    fn from(bounds: Bounds) -> Self {
        let number = |value: Option<f64>| value.map(Limit::Number);
        Self { h_min: number(bounds.h_min), h_max: number(bounds.h_max), a_max: number(bounds.a_max) }
    }
}

impl Limits {
    /// Whether the limits make sense at each of so many vertices.
    ///
    /// # Errors
    /// [`Error::Parse`] that names the parameter, and the vertex of a field.
    pub(crate) fn check(&self, vertices: usize) -> Result<()> {
        for (name, limit) in [("h_min", &self.h_min), ("h_max", &self.h_max), ("a_max", &self.a_max)] {
            let Some(Limit::Field(values)) = limit else { continue };
            if values.len() != vertices {
                let what = format!("{name} has {} values for {vertices} vertices", values.len());
                let help = "give one value for each vertex of the mesh, in the same order";
                return Err(Error::parse("metric bounds", what, help));
            }
        }
        let has_field = [&self.h_min, &self.h_max, &self.a_max].into_iter().any(|l| matches!(l, Some(Limit::Field(_))));
        if !has_field {
            return self.at(0).check();
        }
        (0..vertices).try_for_each(|v| {
            self.at(v).check().map_err(|error| {
                Error::parse(format!("metric bounds at vertex {}", v + 1), fault(&error), error.help().to_owned())
            })
        })
    }

    /// The limits at a vertex.
    pub(crate) fn at(&self, v: usize) -> Bounds {
        let number = |limit: &Option<Limit>| limit.as_ref().map(|limit| limit.at(v));
        Bounds { h_min: number(&self.h_min), h_max: number(&self.h_max), a_max: number(&self.a_max) }
    }
}

/// What an error says of the limits, without its place.
fn fault(error: &Error) -> String {
    match error {
        Error::Parse { what, .. } => what.clone(),
        other => other.to_string(),
    }
}

/// Metrics within limits, by `Bounds::clamp` at each vertex: sizes first, then the longer one by the anisotropy.
///
/// # Errors
/// [`Error::Parse`] of limits that contradict each other, or are no sizes.
pub(crate) fn restrict(tensors: &[Tensor], limits: &Limits) -> Result<Vec<Tensor>> {
    limits.check(tensors.len())?;
    Ok(tensors.iter().enumerate().map(|(v, &tensor)| limits.at(v).clamp(tensor)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tensors() -> [Tensor; 3] {
        [1e-3, 1.0, 1e3].map(|h| Tensor::new(1.0 / (h * h), 0.0, 1e-2 / (h * h)))
    }

    #[test]
    fn numbers_are_bounds_and_fields_are_bounds_at_each_vertex() {
        let bounds = Bounds { h_min: Some(0.5), h_max: Some(20.0), a_max: Some(3.0) };
        assert_eq!(restrict(&tensors(), &bounds.into()).unwrap(), tensors().map(|m| bounds.clamp(m)));
        let limits =
            Limits { h_min: Some(Limit::Field(vec![0.1, 2.0, 1.0])), a_max: Some(Limit::Number(5.0)), h_max: None };
        for (v, m) in restrict(&tensors(), &limits).unwrap().into_iter().enumerate() {
            let bounds = Bounds { h_min: Some([0.1, 2.0, 1.0][v]), h_max: None, a_max: Some(5.0) };
            assert_eq!(m, bounds.clamp(tensors()[v]));
        }
    }

    #[test]
    fn what_makes_no_sense_is_named_with_its_vertex() {
        let says = |limits: Limits, words: &str| {
            let error = restrict(&tensors(), &limits).unwrap_err();
            assert!(error.to_string().contains(words), "{error}");
        };
        let field = |values: &[f64]| Some(Limit::Field(values.to_vec()));
        says(Limits { h_min: field(&[1.0, 2.0]), ..Limits::default() }, "h_min has 2 values for 3 vertices");
        says(Limits { a_max: field(&[1.0, 0.5, 2.0]), ..Limits::default() }, "metric bounds at vertex 2: a_max = 0.5");
        let crossing = Limits { h_min: Some(Limit::Number(1.0)), h_max: field(&[2.0, 1.0, 0.9]), a_max: None };
        says(crossing, "metric bounds at vertex 3: h_min = 1 is larger than h_max = 0.9");
        says(Limits { h_max: Some(Limit::Number(-1.0)), ..Limits::default() }, "metric bounds: h_max = -1");
    }
}
