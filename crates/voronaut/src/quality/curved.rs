//! Curved triangles in the plane: lengths along their sides, their quality over the whole of them, and whether they are valid.

use super::tensors::{angle, tensor_near};
use crate::curved::{GAUSS, HALVINGS, Rule, bezier_points, bound, curve_at, exponents, seen_from_above, side};
use crate::error::Result;
use crate::geometry::{Point, Vector, to_frame};
use crate::mesh::{EdgeSide, Mesh};
use crate::metric::{MetricField, Near};
use crate::parallel::prelude::*;

/// Parts of a curve that are measured by themselves: a curve of unit length may turn once or twice.
const PARTS: u32 = 4;

/// The metric length along the side of a triangle.
///
/// # Errors
/// [`crate::Error::Metric`] where the tensor is not positive definite.
pub(super) fn side_length(mesh: &Mesh, edge: &EdgeSide, metric: &dyn MetricField) -> Result<f64> {
    let (points, order) = bezier_points(mesh, edge.triangle());
    let curve: Vec<Point> = side(order, edge.half_edge as usize % 3).map(|i| points[i]).collect();
    let mut near = Near::default();
    let mut sum = 0.0;
    for part in 0..PARTS {
        for (t, weight) in GAUSS {
            let (p, slope) = curve_at(&curve, (f64::from(part) + t) / f64::from(PARTS));
            sum += weight * tensor_near(metric, p, &mut near)?.length(slope) / f64::from(PARTS);
        }
    }
    Ok(sum)
}

/// The mean over the reference triangle of 2 sqrt(det C) / tr C, where C is the metric pulled back to the equilateral triangle, as
/// [`super::Quality`] is of a straight triangle in one metric; negative where the map turns. And the least of its angles at the corners, in radians.
///
/// # Errors
/// [`crate::Error::Metric`] where the tensor is not positive definite.
pub(super) fn shape(mesh: &Mesh, rule: &Rule, triangle: usize, metric: &dyn MetricField) -> Result<[f64; 2]> {
    let (points, order) = bezier_points(mesh, triangle);
    let points = &points[..exponents(order).len()];
    let (mut near, mut quality) = (Near::default(), 0.0);
    for place in &rule.places {
        let frame = tensor_near(metric, place.image(points), &mut near)?.cholesky();
        let [u, v] = place.derivative(points).map(|column| to_frame(frame, column));
        quality += place.weight * 2.0 * u.cross(v) / (u.dot(u) + v.dot(v));
    }
    let mut least = f64::INFINITY;
    for corner in 0..3 {
        let [before, along] =
            [(corner + 2) % 3, corner].map(|s| side(order, s).map(|i| points[i]).collect::<Vec<Point>>());
        let (leaving, arriving): (Vector, Vector) = (along[1] - along[0], before[order - 1] - before[order]);
        least = least.min(angle(tensor_near(metric, points[corner], &mut near)?, leaving, arriving));
    }
    Ok([quality, least])
}

/// What is known of the validity of curved triangles.
#[derive(Default)]
pub(super) struct Jacobians {
    /// Triangles whose Jacobian is not positive somewhere.
    pub(super) inverted: Vec<usize>,
    /// Triangles of which that is not known.
    pub(super) undecided: Vec<usize>,
    /// The least Jacobian is at least so much, in units of the mean in its triangle.
    pub(super) least: f64,
    /// Area of all.
    pub(super) area: f64,
}

impl Jacobians {
    /// Those of a planar mesh, or of triangles as each is seen along its normal.
    pub(super) fn of(mesh: &Mesh, is_planar: bool) -> Self {
        let of = |t: usize| {
            let (points, order) = if is_planar { bezier_points(mesh, t) } else { seen_from_above(mesh, t) };
            bound(&points[..exponents(order).len()], order, HALVINGS)
        };
        let all: Vec<_> = (0..mesh.triangles.len()).into_par_iter().map(of).collect();
        let which = |is_decided: bool| {
            let wrong = all.iter().enumerate().filter(move |(_, b)| !b.is_valid() && b.is_decided == is_decided);
            wrong.map(|(t, _)| t).collect()
        };
        Self {
            inverted: which(true),
            undecided: which(false),
            least: all.iter().map(|b| b.least).fold(f64::INFINITY, f64::min),
            area: all.iter().map(|b| b.area).sum(),
        }
    }
}
