//! A surface from a text that names a shape or an equation.

use super::shapes::{CHAIR, chair, sphere, torus};
use super::{Input, Surface, mesh_implicit};
use crate::domain::read_numbers;
use crate::error::{Error, Result};
use crate::geometry::{Aabb3, Point3};
use crate::metric::{Expression, Variables};

/// How surfaces that need no file are written, for messages.
pub(crate) const SHAPES: &str = "sphere:r, torus:R,r, chair or implicit:EXPR;x0,y0,z0,x1,y1,z1";
/// Edges of shapes are this part of their diagonal, unless told otherwise.
const DEFAULT_EDGE: f64 = 1.0 / 64.0;

impl Input {
    /// The shape that a text names: `sphere:r`, `torus:R,r`, `chair` or `implicit:EXPR;x0,y0,z0,x1,y1,z1`, with edges about as
    /// long as `edge`.
    ///
    /// # Errors
    /// As of [`shape`]; [`Error::Parse`] of a text that names none.
    pub fn shape(text: &str, edge: Option<f64>) -> Result<Self> {
        let unknown = || Error::parse(text, "no such shape", format!("give {SHAPES}"));
        shape(text, edge).ok_or_else(unknown)?
    }
}

/// The shape that a text names; `None` if it names none.
///
/// # Errors
/// [`Error::Parse`] of numbers and equations that are none; [`Error::Domain`] of what makes no surface; [`Error::Limit`] of too
/// many triangles.
pub fn shape(text: &str, edge: Option<f64>) -> Option<Result<Input>> {
    let (name, rest) = text.split_once(':').map_or((text, None), |(name, rest)| (name, Some(rest)));
    match (name.trim(), rest) {
        ("sphere", Some(numbers)) => Some(read_sphere(text, numbers, edge)),
        ("torus", Some(numbers)) => Some(read_torus(text, numbers, edge)),
        ("chair", None) => Some(chair(edge).and_then(|surface| with_equation(surface, CHAIR))),
        ("implicit", Some(rest)) => Some(read_implicit(text, rest, edge)),
        _ => None,
    }
}

fn read_sphere(text: &str, numbers: &str, edge: Option<f64>) -> Result<Input> {
    let [r] = read_numbers(text, numbers, "sphere:r")?;
    let surface = sphere(r, edge.unwrap_or(12.0_f64.sqrt() * r * DEFAULT_EDGE))?;
    with_equation(surface, &format!("x^2+y^2+z^2-{r:e}^2"))
}

fn read_torus(text: &str, numbers: &str, edge: Option<f64>) -> Result<Input> {
    let [ring, tube] = read_numbers(text, numbers, "torus:R,r")?;
    let size = (ring + tube).hypot(ring + tube).hypot(tube) * 2.0;
    let surface = torus(ring, tube, edge.unwrap_or(size * DEFAULT_EDGE))?;
    with_equation(surface, &format!("(sqrt(x^2+y^2)-{ring:e})^2+z^2-{tube:e}^2"))
}

fn with_equation(surface: Surface, equation: &str) -> Result<Input> {
    Ok(Input::new(surface, Some(Expression::parse(equation, Variables::Space)?)))
}

fn read_implicit(spec: &str, rest: &str, edge: Option<f64>) -> Result<Input> {
    const USAGE: &str = "implicit:EXPR;x0,y0,z0,x1,y1,z1";
    let Some((equation, numbers)) = rest.rsplit_once(';') else {
        return Err(Error::parse(spec, "an equation without its box", format!("write {USAGE}")));
    };
    let f = Expression::parse(equation, Variables::Space)?;
    let [x0, y0, z0, x1, y1, z1] = read_numbers(spec, numbers, USAGE)?;
    let bounds = Aabb3 { min: Point3::new(x0, y0, z0), max: Point3::new(x1, y1, z1) };
    Ok(Input::new(mesh_implicit(&f, bounds, edge)?, Some(f)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::Implicit;

    #[test]
    fn shapes_lie_on_their_equations() {
        for (spec, genus) in [("sphere:2", 0), ("torus: 2, 0.5", 1), ("implicit:x^2+y^2+2*z^2-1;-2,-2,-2,2,2,2", 0)] {
            let Input { surface, implicit, .. } = Input::shape(spec, None).unwrap();
            let f = implicit.unwrap();
            let components = surface.components();
            assert_eq!((components.len(), components[0].genus()), (1, genus), "{spec}");
            let size = surface.bounds().diagonal();
            for &p in surface.positions() {
                let jet = Implicit::jet(&f, p);
                assert!(jet.value.abs() < 1e-11 * size * jet.gradient.norm(), "{spec}: {p}");
            }
            let edges: Vec<_> = surface.topology().edges().collect();
            assert!((1_000..100_000).contains(&edges.len()), "{spec}: {}", edges.len());
        }
    }

    #[test]
    fn mistakes_are_named() {
        for (text, expected) in [
            ("sphere:1,2", "sphere:1,2: 2 numbers where 1 are expected"),
            ("sphere:x", "sphere:x: 'x' is not a number"),
            ("sphere:-1", "invalid domain: a sphere whose radii"),
            ("torus:1,2", "invalid domain: a torus whose tube meets itself"),
            ("sphere", "sphere: no such shape"),
            ("chair:1", "chair:1: no such shape"),
            ("implicit:x", "implicit:x: an equation without its box"),
            ("implicit:x+;0,0,0,1,1,1", "expression, column 3: a value was expected"),
            ("implicit:x;0,0,0,1,1", "implicit:x;0,0,0,1,1: 5 numbers where 6 are expected"),
            ("implicit:x;0,0,0,0,1,1", "invalid domain: an empty box at (0, 0, 0) - (0, 1, 1)"),
        ] {
            let error = Input::shape(text, None).unwrap_err();
            assert!(error.to_string().starts_with(expected), "{error}");
            assert!(!error.help().is_empty());
        }
    }
}
