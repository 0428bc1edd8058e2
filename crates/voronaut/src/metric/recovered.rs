//! A solution known at the vertices of a mesh, and its recovered second derivatives.

use super::nodal::absolute;
use super::{Norm, Recovery, Sampled, ScalarField, recover_hessian};
use crate::error::{Error, Result};
use crate::geometry::{Point, Tensor};
use crate::mesh::{Located, Locator, Mesh};

/// The floor of absolute eigenvalues, as a share of the mean over the domain of the greater one: where a function is linear in
/// some direction, longer edges would gain nothing, and make a metric that no straight edges can honour. Measured: a hundredth
/// of it makes errors larger by 1 to 3 %, for the mesh cannot follow; ten times as much by 4 %.
pub(super) const FLOOR: f64 = 1e-4;

/// The function that is quadratic on every triangle, has a solution's values at the vertices, and there, as well as a continuous
/// function can, its recovered second derivatives: linear interpolation and, of each edge e, -e'He / 8 in the middle.
///
/// Outside the mesh the value is that at the nearest point.
#[derive(Clone, Debug)]
pub(crate) struct Recovered {
    values: Vec<f64>,
    hessians: Vec<Tensor>,
    mesh: Mesh,
    locator: Locator,
}

impl Recovered {
    /// Of one value per vertex of a planar mesh.
    ///
    /// # Errors
    /// As for [`recover_hessian`].
    pub(crate) fn new(mesh: &Mesh, values: &[f64], recovery: Recovery) -> Result<Self> {
        let hessians = recover_hessian(mesh, values, recovery)?;
        let locator = Locator::new(mesh, "the mesh of the solution")?;
        Ok(Self { values: values.to_vec(), hessians, mesh: mesh.clone(), locator })
    }

    /// The metric of the second derivatives, as [`super::Hessian`] has it of a formula.
    ///
    /// # Errors
    /// [`Error::Metric`] where all are zero.
    pub(crate) fn metric(&self, norm: Norm) -> Result<Sampled> {
        let size = self.mean_size();
        let floor = FLOOR * size;
        if size > self.rounding() && floor > 0.0 {
            let tensors: Vec<Tensor> = self.hessians.iter().map(|&h| norm.weighted(absolute(h, floor))).collect();
            return Sampled::new(&self.mesh, &tensors);
        }
        let help = "its interpolation is exact on any mesh: use another metric, such as uniform";
        Err(Error::metric("the solution's second derivatives vanish everywhere", "the whole mesh", help))
    }

    /// Second derivatives that rounding of the values alone could make up.
    fn rounding(&self) -> f64 {
        let twice = |&triangle: &[u32; 3]| {
            let [a, b, c] = self.mesh.corners_of(triangle);
            (b - a).cross(c - a).abs()
        };
        let area = 0.5 * self.mesh.triangles.iter().map(twice).sum::<f64>();
        let greatest = self.values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        100.0 * f64::EPSILON * greatest * self.values.len() as f64 / area
    }

    /// The mean over the mesh's area of the greater absolute eigenvalue.
    fn mean_size(&self) -> f64 {
        let size = |v: u32| {
            let e = self.hessians[v as usize].eigen();
            e.large.abs().max(e.small.abs())
        };
        let (mut sum, mut total) = (0.0, 0.0);
        for &triangle in &self.mesh.triangles {
            let [a, b, c] = self.mesh.corners_of(triangle);
            let area = (b - a).cross(c - a).abs();
            sum += area * triangle.map(size).iter().sum::<f64>() / 3.0;
            total += area;
        }
        sum / total
    }
}

impl ScalarField for Recovered {
    fn value(&self, p: Point) -> f64 {
        let Some(Located { triangle, weights, .. }) = self.locator.locate(p) else { return f64::NAN };
        let vertices = self.mesh.triangles[triangle as usize];
        let linear: f64 = vertices.iter().zip(weights).map(|(&v, weight)| weight * self.values[v as usize]).sum();
        let bend = |i: usize| {
            let j = (i + 1) % 3;
            let (u, v) = (vertices[i], vertices[j]);
            let edge = self.mesh.point(v) - self.mesh.point(u);
            let sum = self.hessians[u as usize] + self.hessians[v as usize];
            // 4 of the shape function in the middle times e' (sum / 2) e / 8.
            0.25 * weights[i] * weights[j] * sum.dot(edge, edge)
        };
        linear - (0..3).map(bend).sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::super::nodal::test_meshes::grid;
    use super::*;
    use crate::metric::MetricField;

    fn recovered(f: impl Fn(Point) -> f64) -> Recovered {
        let mesh = grid(12, 0.4);
        let values: Vec<f64> = (0..mesh.points.len() as u32).map(|v| f(mesh.point(v))).collect();
        Recovered::new(&mesh, &values, Recovery::Fit).unwrap()
    }

    #[test]
    fn quadratics_are_reproduced_between_the_vertices() {
        let f = |p: Point| 3.0 * p.x * p.x - p.x * p.y + 0.5 * p.y * p.y + p.x - 2.0;
        let found = recovered(f);
        for i in 0..200 {
            let p = Point::new((f64::from(i) * 0.618).fract(), (f64::from(i) * 0.414).fract());
            assert!((found.value(p) - f(p)).abs() < 1e-9, "{p}");
        }
        // Second derivatives ((6, -1), (-1, 1)), positive definite.
        let m = found.metric(Norm::new(f64::INFINITY).unwrap()).unwrap().at(Point::new(0.4, 0.7));
        assert!((m.xx - 6.0).abs() + (m.xy + 1.0).abs() + (m.yy - 1.0).abs() < 1e-7, "{m:?}");
    }

    #[test]
    fn what_is_linear_but_for_rounding_has_no_metric() {
        for linear in [0.0, 1.0, 1e6] {
            let error =
                recovered(|p| 1.0 + linear * (p.x + 2.0 * p.y)).metric(Norm::default()).unwrap_err().to_string();
            assert!(error.contains("vanish everywhere"), "{linear}: {error}");
        }
    }
}
