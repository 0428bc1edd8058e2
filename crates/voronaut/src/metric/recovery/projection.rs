//! Second derivatives by projecting gradients twice.

use super::super::neighbours::Neighbours;
use super::stencil::{Frame, Rings, least_squares};
use crate::geometry::Tensor;
use crate::lists::marked;
use crate::mesh::{Edges, Mesh};
use crate::parallel::prelude::*;

/// The double L2 projection with lumped masses: gradients of triangles averaged to the vertices by area, differentiated, and
/// averaged again. At the border the first averages are of one side only and wrong by a share of the edge's length, the second
/// by as much as the Hessian itself; there both are linear extrapolations from the vertices inside.
pub(super) fn project(mesh: &Mesh, values: &[f64]) -> Vec<Tensor> {
    let averaging = Averaging::of(mesh);
    let mut gradient = averaging.gradient(values);
    for component in &mut gradient {
        averaging.extrapolate(component);
    }
    let [xx, yx] = averaging.gradient(&gradient[0]);
    let [xy, yy] = averaging.gradient(&gradient[1]);
    let mixed: Vec<f64> = xy.iter().zip(&yx).map(|(a, b)| 0.5 * (a + b)).collect();
    let [xx, xy, yy] = [xx, mixed, yy].map(|mut entries| {
        averaging.extrapolate(&mut entries);
        entries
    });
    (0..values.len()).map(|v| Tensor::new(xx[v], xy[v], yy[v])).collect()
}

/// What it takes to average gradients.
struct Averaging<'a> {
    mesh: &'a Mesh,
    around: Neighbours,
    is_border: Vec<bool>,
    /// Sum of the areas of its triangles, by vertex.
    areas: Vec<f64>,
}

impl<'a> Averaging<'a> {
    fn of(mesh: &'a Mesh) -> Self {
        let mut areas = vec![0.0; mesh.points.len()];
        for &t in &mesh.triangles {
            let area = mesh.double_area(t);
            for v in t {
                areas[v as usize] += area;
            }
        }
        Self { mesh, around: Neighbours::of(mesh), is_border: border(mesh), areas }
    }

    /// The derivatives by x and y of what is linear on every triangle, averaged by area.
    fn gradient(&self, values: &[f64]) -> [Vec<f64>; 2] {
        let mut sums = [vec![0.0; values.len()], vec![0.0; values.len()]];
        for &t in &self.mesh.triangles {
            let [a, b, c] = self.mesh.corners_of(t);
            let (u, v) = (b - a, c - a);
            let [at_a, at_b, at_c] = t.map(|v| values[v as usize]);
            let (p, q, sign) = (at_b - at_a, at_c - at_a, u.cross(v).signum());
            // Times twice the area.
            let (dx, dy) = (sign * (p * v.y - q * u.y), sign * (q * u.x - p * v.x));
            for &w in &t {
                sums[0][w as usize] += dx;
                sums[1][w as usize] += dy;
            }
        }
        sums.map(|sum| sum.iter().zip(&self.areas).map(|(s, a)| if *a > 0.0 { s / a } else { 0.0 }).collect())
    }

    /// Replaces values at the border by linear polynomials fitted to values inside, as far as there are any.
    fn extrapolate(&self, values: &mut [f64]) {
        let border: Vec<usize> = (0..values.len()).filter(|&v| self.is_border[v]).collect();
        let found: Vec<Option<f64>> = border.par_iter().map(|&v| self.extrapolated(values, v)).collect();
        for (v, value) in border.into_iter().zip(found) {
            values[v] = value.unwrap_or(values[v]);
        }
    }

    fn extrapolated(&self, values: &[f64], v: usize) -> Option<f64> {
        let mut rings = Rings::new(&self.around, v);
        for _ in 0..RINGS {
            if !rings.grow() {
                break;
            }
            let inside: Vec<u32> = rings.vertices().iter().copied().filter(|&w| !self.is_border[w as usize]).collect();
            if inside.len() < POINTS {
                continue;
            }
            let offset = |w: &u32| self.mesh.point(*w) - self.mesh.point(v as u32);
            let Some(frame) = Frame::of(&rings.vertices().iter().map(offset).collect::<Vec<_>>()) else { continue };
            let places = inside.iter().map(|w| frame.place(offset(w)));
            let mut rows: Vec<[f64; 3]> = places.map(|d| [1.0, d.x, d.y]).collect();
            let mut taken: Vec<f64> = inside.iter().map(|&w| values[w as usize]).collect();
            let solved = least_squares(&mut rows, &mut taken);
            if solved.independence >= INDEPENDENT {
                return Some(solved.coefficients[0]);
            }
        }
        None
    }
}

/// Rings looked at around a vertex of the border.
const RINGS: usize = 4;
/// Vertices inside that a linear polynomial is fitted to, at least.
const POINTS: usize = 4;
/// Stencils whose columns depend on each other more are made larger.
const INDEPENDENT: f64 = 0.2;

/// Which vertices are on an edge of one triangle only.
fn border(mesh: &Mesh) -> Vec<bool> {
    marked(mesh.points.len(), Edges::of(&mesh.triangles).boundary().flat_map(|side| side.ends))
}
