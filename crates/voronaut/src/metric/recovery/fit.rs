//! Second derivatives by quadratic polynomials fitted around every vertex.

use super::super::neighbours::Neighbours;
use super::stencil::{Frame, Rings, least_squares};
use crate::geometry::Tensor;
use crate::mesh::Mesh;
use crate::parallel::prelude::*;

/// The Hessian of the quadratic through the value at a vertex that fits the values around it best: exact for quadratics.
pub(super) fn fit(mesh: &Mesh, values: &[f64]) -> Vec<Tensor> {
    let around = Neighbours::of(mesh);
    (0..values.len()).into_par_iter().map(|v| at_vertex(mesh, values, &around, v)).collect()
}

/// A quadratic through a value has five coefficients more; one neighbour is to spare.
const NEIGHBOURS: usize = 6;
/// Stencils whose columns depend on each other more are made larger.
const INDEPENDENT: f64 = 0.2;
/// Rings at most.
const RINGS: usize = 4;

fn at_vertex(mesh: &Mesh, values: &[f64], around: &Neighbours, v: usize) -> Tensor {
    let mut rings = Rings::new(around, v);
    let mut best = (-1.0, Tensor::default());
    for _ in 0..RINGS {
        if !rings.grow() {
            break;
        }
        let Some((independence, hessian)) = through(mesh, values, v, rings.vertices()) else { continue };
        if independence >= INDEPENDENT && rings.vertices().len() >= NEIGHBOURS {
            return hessian;
        }
        if independence > best.0 {
            best = (independence, hessian);
        }
    }
    best.1
}

/// The Hessian by a stencil, and how independent its columns are.
fn through(mesh: &Mesh, values: &[f64], v: usize, stencil: &[u32]) -> Option<(f64, Tensor)> {
    let frame = Frame::of(mesh, mesh.point(v as u32), stencil)?;
    let (mut rows, mut differences) = (Vec::with_capacity(stencil.len()), Vec::with_capacity(stencil.len()));
    for &w in stencil {
        let d = frame.place(mesh.point(w));
        // Each row over its distance: nearer vertices count for more, and coinciding ones for nothing.
        let distance = d.norm();
        let weight = if distance > 0.0 { 1.0 / distance } else { 0.0 };
        rows.push([d.x, d.y, 0.5 * d.x * d.x, d.x * d.y, 0.5 * d.y * d.y].map(|entry| weight * entry));
        differences.push(weight * (values[w as usize] - values[v]));
    }
    let found = least_squares(&mut rows, &mut differences);
    let [_, _, xx, xy, yy] = found.coefficients;
    Some((found.independence, frame.back(Tensor::new(xx, xy, yy))))
}
