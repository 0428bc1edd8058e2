//! How far a function is from its interpolation on a mesh.

use super::{Position, Spot};
use crate::curved::{AREA, MOST, Place, bernstein, bezier_points, blend, exponents, points_of_nodes};
use crate::elementary::Elementary;
use crate::error::{Error, Result};
use crate::geometry::{Node, Point, Point3, radon_on_parts};
use crate::manifold::{self, Manifold};
use crate::mesh::Mesh;
use crate::metric::{Expression, Near, Norm, ScalarField};
use crate::parallel::prelude::*;
use std::cell::Cell;
use std::fmt;

/// Each triangle is cut into so many times so many parts, with a rule of degree 5 on each.
const PARTS: u32 = 4;

/// The error of interpolation of a function on a mesh.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct InterpolationError {
    /// Its L^p norm.
    pub norm: f64,
    /// The exponent p; with p infinite, `norm` is the greatest error.
    pub p: Exponent,
    /// The greatest error among the points looked at (112 in each triangle), and where it is.
    pub max: Spot,
}

/// An exponent as it is written: JSON has no infinity.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[serde(untagged)]
pub enum Exponent {
    /// A number.
    Finite(f64),
    /// `"inf"`.
    Infinite(&'static str),
}

impl fmt::Display for Exponent {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Exponent::Finite(p) => p.fmt(f),
            Exponent::Infinite(name) => f.write_str(name),
        }
    }
}

/// The error of interpolation of a function on a planar mesh, linear or by polynomials of the order of curved triangles, whose nodes are the mesh's; by 112
/// values in each triangle: exact for the squares of errors that are quadratic on straight ones. It does not see layers much thinner than a twelfth of a
/// triangle.
///
/// # Errors
/// [`Error::Metric`] where the function is not finite; [`Error::Mesh`] of a mesh without triangles.
pub fn interpolation_error(mesh: &Mesh, function: &dyn ScalarField, norm: Norm) -> Result<InterpolationError> {
    let value = |p: Point3| function.value(Point::new(p.x, p.y));
    if mesh.curved.is_none() {
        let within = |found: &Cell<Near>, p: Point3| {
            let mut near = found.get();
            let value = function.value_near(Point::new(p.x, p.y), &mut near);
            found.set(near);
            value
        };
        return error_of(mesh, &value, |_| Cell::default(), within, norm);
    }
    let places: Vec<Place> =
        radon_on_parts(PARTS).into_iter().map(|(at, weight)| Place::of(mesh, at, weight)).collect();
    let of = |t: usize| on_curved(mesh, t, function, norm, &places);
    summed(&(0..mesh.triangles.len()).into_par_iter().with_min_len(64).map(of).collect::<Vec<_>>(), true, norm)
}

/// The same on the mesh of a surface, of a function of x, y and z: each point of a triangle stands for the one of the surface that is
/// nearest to it, as seen from the one that is closest to the triangle's middle.
///
/// # Errors
/// As of [`interpolation_error`].
pub fn interpolation_error_on(
    mesh: &Mesh,
    manifold: &Manifold,
    function: &Expression,
    norm: Norm,
) -> Result<InterpolationError> {
    manifold.prepare();
    let value = |p: Point3| function.at(p.x, p.y, p.z);
    let beside = |triangle: [Point3; 3]| manifold.closest(Point3::weighted(triangle, [1.0 / 3.0; 3])).ok();
    let lifted = |near: &Option<manifold::Place>, p: Point3| {
        let place = near.as_ref().and_then(|near| manifold.lift(near, p));
        value(place.map_or(p, |place| place.position))
    };
    error_of(mesh, &value, beside, lifted, norm)
}

/// The error by the values at vertices and within triangles, of each of which something is known that helps to find values there.
fn error_of<K>(
    mesh: &Mesh,
    at_vertex: &(dyn Fn(Point3) -> f64 + Sync),
    known: impl Fn([Point3; 3]) -> K + Sync,
    within: impl Fn(&K, Point3) -> f64 + Sync,
    norm: Norm,
) -> Result<InterpolationError> {
    let values: Vec<f64> = (0..mesh.points.len() as u32).into_par_iter().map(|v| at_vertex(mesh.position(v))).collect();
    let nodes = radon_on_parts(PARTS);
    let of = |&t: &[u32; 3]| {
        let corners = mesh.positions_of(t);
        let known = known(corners);
        on_triangle(corners, t.map(|v| values[v as usize]), &|p| within(&known, p), norm, &nodes)
    };
    summed(&mesh.triangles.par_iter().with_min_len(64).map(of).collect::<Vec<_>>(), mesh.is_planar(), norm)
}

/// The whole from what triangles have: of each the integral of the p-th power of the error as a share of the greatest; the greatest, and where it is.
fn summed(found: &[(f64, f64, Point3)], is_planar: bool, norm: Norm) -> Result<InterpolationError> {
    let Some(&(_, max, place)) = found.iter().max_by(|a, b| a.1.total_cmp(&b.1)) else {
        return Err(Error::mesh("it has no triangles", "the whole mesh", "give a mesh with triangles"));
    };
    let at = if is_planar { Position::Plane([place.x, place.y]) } else { place.into() };
    if !max.is_finite() {
        let help = "give a function that is finite in the whole domain";
        return Err(Error::metric("the function is not finite", place.to_string(), help));
    }
    let p = norm.exponent();
    let max_spot = Spot { value: max, at };
    if p.is_infinite() {
        return Ok(InterpolationError { norm: max, p: Exponent::Infinite("inf"), max: max_spot });
    }
    // Powers of shares of the greatest: they neither overflow nor all vanish.
    let sum: f64 = found.iter().map(|&(sum, own, _)| if own > 0.0 { sum * norm.power(own / max) } else { 0.0 }).sum();
    let value = if max > 0.0 { max * sum.raised_to(1.0 / p) } else { 0.0 };
    Ok(InterpolationError { norm: value, p: Exponent::Finite(p), max: max_spot })
}

/// The integral of the p-th power of the error as a share of the greatest; the greatest, and where it is.
fn on_triangle(
    corners: [Point3; 3],
    values: [f64; 3],
    function: &dyn Fn(Point3) -> f64,
    norm: Norm,
    nodes: &[Node],
) -> (f64, f64, Point3) {
    let error = |&(at, weight): &Node| {
        let p = Point3::weighted(corners, at);
        let linear: f64 = at.iter().zip(values).map(|(share, value)| share * value).sum();
        ((function(p) - linear).abs(), p, weight)
    };
    let (sum, most, at) = of_errors(&nodes.iter().map(error).collect::<Vec<_>>(), norm);
    let [a, b, c] = corners;
    (0.5 * (b - a).cross(c - a).norm() * sum, most, at)
}

/// The same of a curved triangle.
fn on_curved(
    mesh: &Mesh,
    triangle: usize,
    function: &dyn ScalarField,
    norm: Norm,
    places: &[Place],
) -> (f64, f64, Point3) {
    let (points, order) = bezier_points(mesh, triangle);
    let points = &points[..exponents(order).len()];
    let mut values = [Point::default(); MOST];
    for (value, e) in values.iter_mut().zip(exponents(order)) {
        let node = blend(points, &bernstein(order, e.map(|i| f64::from(i) / order as f64)));
        *value = Point::new(function.value(node), 0.0);
    }
    let ordinates = points_of_nodes(&values, order);
    let error = |place: &Place| {
        let ([a, b], p) = (place.derivative(points), place.image(points));
        let error = function.value(p) - place.image(&ordinates[..points.len()]).x;
        (error.abs(), Point3::new(p.x, p.y, 0.0), AREA * place.weight * a.cross(b))
    };
    of_errors(&places.iter().map(error).collect::<Vec<_>>(), norm)
}

/// The sum of the p-th powers of errors, as shares of the greatest, times weights; the greatest, and where it is.
fn of_errors(errors: &[(f64, Point3, f64)], norm: Norm) -> (f64, f64, Point3) {
    let greater = |most: (f64, Point3), next: &(f64, Point3, f64)| {
        if next.0 > most.0 || next.0.is_nan() { (next.0, next.1) } else { most }
    };
    let (most, at) = errors.iter().fold((0.0, errors[0].1), greater);
    let power = |error: f64| if most > 0.0 { norm.power(error / most) } else { 0.0 };
    (errors.iter().map(|&(error, _, weight)| weight * power(error)).sum(), most, at)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle() -> Mesh {
        Mesh {
            points: vec![[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            triangles: vec![[0, 1, 2]],
            ..Mesh::default()
        }
    }

    fn of(function: impl Fn(Point) -> f64 + Sync, p: f64) -> InterpolationError {
        interpolation_error(&triangle(), &function, Norm::new(p).unwrap()).unwrap()
    }

    #[test]
    fn norms_of_a_quadratic_are_the_exact_ones() {
        // x^2 = 4 v^2 in barycentric coordinates; it is 4 v (1 - v) below its interpolation.
        let square = |p: Point| p.x * p.x;
        // The integral of (4 v (1 - v))^2 over a triangle of area 1: 16 (2 / 12 - 4 / 20 + 2 / 30).
        let truth: f64 = 16.0 * (2.0 / 12.0 - 4.0 / 20.0 + 2.0 / 30.0);
        assert!((of(square, 2.0).norm - truth.sqrt()).abs() < 1e-14);
        // Of the first power: 4 (2 / 6 - 2 / 12).
        assert!((of(square, 1.0).norm - 4.0 * (2.0 / 6.0 - 2.0 / 12.0)).abs() < 1e-14);
        let greatest = of(square, f64::INFINITY);
        assert!(greatest.norm > 0.99 && greatest.norm <= 1.0 && (greatest.max.at.coordinates()[0] - 1.0).abs() < 0.1);
    }

    #[test]
    fn units_go_along_and_linear_functions_have_no_error() {
        let [tiny, plain] = [1e-200, 1.0].map(|unit| of(move |p: Point| unit * p.x * p.y, 4.0).norm / unit);
        assert!((tiny / plain - 1.0).abs() < 1e-12);
        assert!(of(|p: Point| 3.0 * p.x - p.y, 2.0).norm < 1e-15);
    }

    #[test]
    fn what_is_not_finite_is_an_error_with_the_place() {
        let pole = |p: Point| if p.x > 1.0 { f64::NAN } else { 0.0 };
        let error = interpolation_error(&triangle(), &pole, Norm::default()).unwrap_err().to_string();
        assert!(error.contains("the function is not finite at (1."), "{error}");
    }
}
