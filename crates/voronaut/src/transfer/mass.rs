//! The mass matrix of linear elements, what is integrated with it, and values brought back into bounds with the same integral.

use crate::geometry::Point3;
use crate::lists::Rows;
use crate::mesh::Mesh;
use crate::parallel::prelude::*;
use crate::sparse::{conjugate_gradients, dot};

/// Areas of all triangles, of either orientation.
pub(super) fn areas(mesh: &Mesh) -> Vec<f64> {
    let double = |corners: [Point3; 3]| (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
    mesh.triangles.iter().map(|&triangle| 0.5 * double(mesh.positions_of(triangle))).collect()
}

/// The matrix of integrals of products of hat functions: |T| / 12 for each triangle of two vertices, |T| / 6 on the diagonal.
pub(super) struct MassMatrix<'a> {
    triangles: &'a [[u32; 3]],
    /// Of the triangles.
    pub(super) areas: &'a [f64],
    /// Triangles and corners at each vertex.
    fans: Rows<(u32, u8)>,
    /// The integral of each hat function: the sum of its row.
    pub(super) lumped: Vec<f64>,
}

/// With Jacobi's preconditioner the eigenvalues are between 1/2 and 2, whatever the mesh (Wathen 1987): each step of conjugate
/// gradients takes the error to a third, forty of them to rounding.
const STEPS: usize = 60;

impl<'a> MassMatrix<'a> {
    pub(super) fn new(mesh: &'a Mesh, areas: &'a [f64]) -> Self {
        let corners =
            (0..).zip(&mesh.triangles).flat_map(|(t, triangle)| (0..).zip(triangle).map(move |(k, &v)| (v, (t, k))));
        let fans = Rows::new(mesh.points.len(), corners);
        let mut matrix = Self { triangles: &mesh.triangles, areas, fans, lumped: Vec::new() };
        matrix.lumped = matrix.assemble(|t, _| areas[t] / 3.0);
        matrix
    }

    /// The triangles at a vertex, and which of their corners it is.
    pub(super) fn fan(&self, vertex: usize) -> impl Iterator<Item = (usize, usize)> {
        self.fans.row(vertex).iter().map(|&(t, corner)| (t as usize, usize::from(corner)))
    }

    /// Sums over the triangles at each vertex of what triangle and corner bring.
    pub(super) fn assemble(&self, bring: impl Fn(usize, usize) -> f64 + Sync) -> Vec<f64> {
        let vertices = self.fans.count();
        (0..vertices).into_par_iter().map(|v| self.fan(v).map(|(t, corner)| bring(t, corner)).sum()).collect()
    }

    /// The matrix times a vector.
    pub(super) fn times(&self, values: &[f64]) -> Vec<f64> {
        self.assemble(|t, corner| {
            let [a, b, c] = self.triangles[t].map(|v| values[v as usize]);
            self.areas[t] / 12.0 * ([a, b, c][corner] + a + b + c)
        })
    }

    /// Solves for the values with these loads, from a first guess, which stays at vertices without area.
    pub(super) fn solve(&self, loads: &[f64], guess: Vec<f64>) -> Vec<f64> {
        let diagonal: Vec<f64> = self.lumped.iter().map(|m| 0.5 * m).collect();
        conjugate_gradients(|values| self.times(values), &diagonal, loads, guess, STEPS)
    }
}

/// The share of their magnitude by which values have to change so that their weighted sum is `target`.
pub(super) fn share_missing(values: &[f64], weights: &[f64], target: f64) -> f64 {
    let size: f64 = values.iter().zip(weights).map(|(u, m)| u.abs() * m).sum();
    if size > 0.0 { (target - dot(values, weights)) / size } else { 0.0 }
}

/// Changes all values by one share of their magnitude, or, where all are zero, by one number, so that their weighted sum is
/// `target`.
pub(super) fn balance(values: &mut [f64], weights: &[f64], target: f64) {
    let share = share_missing(values, weights, target);
    let rest = if share == 0.0 { target - dot(values, weights) } else { 0.0 };
    let shift = rest / weights.iter().sum::<f64>();
    for u in values {
        *u += share * u.abs() + shift;
    }
}

/// Sweeps that spread what is out of bounds to the neighbours, before the little that is left goes everywhere.
const SWEEPS: usize = 50;
/// The share of all mass that is little.
const LITTLE: f64 = 1e-12;

/// Values within bounds with the same integral: what is beyond goes to the neighbours, as the mass matrix spreads it (Farrell et
/// al. 2009), until there is room; what is left in the end goes where there is room, in proportion to that. Values within their bounds
/// from the start stay as they are.
///
/// There must be values within the bounds with that integral.
pub(super) fn bounded(matrix: &MassMatrix<'_>, mut values: Vec<f64>, bounds: &[(f64, f64)]) -> Vec<f64> {
    let masses = &matrix.lumped;
    let target = dot(&values, masses);
    let little = LITTLE * values.iter().zip(masses).map(|(u, m)| u.abs() * m).sum::<f64>();
    for _ in 0..SWEEPS {
        let excess: Vec<f64> = values.iter().zip(bounds).map(|(&u, &bounds)| u - within(u, bounds)).collect();
        if excess.iter().zip(masses).map(|(e, m)| e.abs() * m).sum::<f64>() <= little {
            break;
        }
        let spread = matrix.times(&excess);
        for (i, value) in values.iter_mut().enumerate().filter(|(i, _)| masses[*i] > 0.0) {
            *value += spread[i] / masses[i] - excess[i];
        }
    }
    values.iter_mut().zip(bounds).for_each(|(u, &bounds)| *u = within(*u, bounds));
    close(&mut values, masses, bounds, target);
    values
}

/// Brings the weighted sum to `target`, every value by the same share of the room it has.
fn close(values: &mut [f64], masses: &[f64], bounds: &[(f64, f64)], target: f64) {
    let missing = target - dot(values, masses);
    let room = |u: f64, (low, high): (f64, f64)| if missing > 0.0 { high - u } else { u - low };
    let total: f64 = values.iter().zip(bounds).zip(masses).map(|((&u, &bounds), m)| room(u, bounds) * m).sum();
    if total > 0.0 {
        let share = (missing / total).clamp(-1.0, 1.0);
        values.iter_mut().zip(bounds).for_each(|(u, &bounds)| *u = within(*u + share * room(*u, bounds), bounds));
    }
}

/// Bounds may be those of no value at all.
fn within(value: f64, (low, high): (f64, f64)) -> f64 {
    value.max(low).min(high)
}
