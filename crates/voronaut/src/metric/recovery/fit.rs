//! Second derivatives by quadratic polynomials fitted around every vertex.

use super::super::neighbours::Neighbours;
use super::stencil::{Frame, Rings, least_squares};
use crate::geometry::{Tensor, Vector};
use crate::mesh::Mesh;
use crate::parallel::prelude::*;

/// The Hessian of the quadratic through the value at a vertex that fits the values around it best: exact for quadratics.
pub(super) fn fit(mesh: &Mesh, values: &[f64]) -> Vec<Tensor> {
    let around = Neighbours::of(mesh);
    let at_vertex = |v: u32| {
        let offset = |w: u32| Some(mesh.point(w) - mesh.point(v));
        hessian_around(&around, values, v, offset).unwrap_or_default()
    };
    (0..values.len() as u32).into_par_iter().map(at_vertex).collect()
}

/// A quadratic through a value has five coefficients more; one neighbour is to spare.
const NEIGHBOURS: usize = 6;
/// Stencils whose columns depend on each other more are made larger.
const INDEPENDENT: f64 = 0.2;
/// Rings at most.
const RINGS: usize = 4;

/// The same at one vertex, from where its neighbours are seen from there in a plane; those that are not seen do not count. `None`
/// where they do not determine it at all.
pub(crate) fn hessian_around(
    around: &Neighbours,
    values: &[f64],
    v: u32,
    offset: impl Fn(u32) -> Option<Vector>,
) -> Option<Tensor> {
    let mut rings = Rings::new(around, v as usize);
    let mut best: Option<(f64, Tensor)> = None;
    for _ in 0..RINGS {
        if !rings.grow() {
            break;
        }
        let seen = rings.vertices().iter().filter_map(|&w| Some((offset(w)?, values[w as usize] - values[v as usize])));
        let (offsets, differences): (Vec<Vector>, Vec<f64>) = seen.unzip();
        let Some((independence, hessian)) = through(&offsets, differences) else { continue };
        if independence >= INDEPENDENT && offsets.len() >= NEIGHBOURS {
            return Some(hessian);
        }
        if best.is_none_or(|best| independence > best.0) {
            best = Some((independence, hessian));
        }
    }
    best.map(|best| best.1)
}

/// The Hessian by a stencil, and how independent its columns are.
fn through(offsets: &[Vector], mut differences: Vec<f64>) -> Option<(f64, Tensor)> {
    let frame = Frame::of(offsets)?;
    let mut rows = Vec::with_capacity(offsets.len());
    for (&offset, difference) in offsets.iter().zip(&mut differences) {
        let d = frame.place(offset);
        // Each row over its distance: nearer vertices count for more, and coinciding ones for nothing.
        let distance = d.norm();
        let weight = if distance > 0.0 { 1.0 / distance } else { 0.0 };
        rows.push([d.x, d.y, 0.5 * d.x * d.x, d.x * d.y, 0.5 * d.y * d.y].map(|entry| weight * entry));
        *difference *= weight;
    }
    let found = least_squares(&mut rows, &mut differences);
    let [_, _, xx, xy, yy] = found.coefficients;
    Some((found.independence, frame.back(Tensor::new(xx, xy, yy))))
}
