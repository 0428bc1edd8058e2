//! The metric of a chart as polynomials: where it is smooth, a few hundred values of it tell all others in its middle.

use crate::elementary::Elementary;
use crate::geometry::{Point, Tensor, Vector};
use crate::metric::MetricField;
use std::f64::consts::PI;

/// Nodes along each axis.
const NODES: usize = 17;
/// Polynomials are to be as near as this (share of the tensor) at [`PROBES`], places as shares of the half-width, between nodes and
/// where they are farthest from these.
const NEAR: f64 = 1e-7;
const PROBES: [[f64; 2]; 6] = [[0.09, -0.05], [0.55, 0.31], [-0.44, 0.71], [-0.83, -0.37], [0.29, -0.77], [0.92, 0.95]];

/// Polynomials for the entries of a tensor on a square around the origin, by their values at Chebyshev's nodes (barycentric
/// interpolation: Berrut and Trefethen 2004).
pub(crate) struct Patch {
    half: f64,
    /// Nodes, as shares of the half-width, and their weights.
    nodes: [[f64; 2]; NODES],
    /// Row by row.
    values: Vec<Tensor>,
}

impl Patch {
    /// Of a field on the square of this half-width; `None` where polynomials do not follow it.
    pub(crate) fn new(field: &dyn MetricField, half: f64) -> Option<Self> {
        let node = |k: usize| {
            let (sine, cosine) = (PI * (k as f64 + 0.5) / NODES as f64).sine_and_cosine();
            [cosine, if k.is_multiple_of(2) { sine } else { -sine }]
        };
        let nodes: [[f64; 2]; NODES] = std::array::from_fn(node);
        let at = |[x, y]: [f64; 2]| field.at(Point::default() + Vector::new(x, y) * half);
        let rows = nodes.iter().flat_map(|&[y, _]| nodes.iter().map(move |&[x, _]| [x, y]));
        let patch = Self { half, nodes, values: rows.map(at).collect() };
        let is_near = |&[x, y]: &[f64; 2]| {
            let truth = at([x, y]);
            let Tensor { xx, xy, yy } = patch.inside([x, y]) - truth;
            xx.abs().max(xy.abs()).max(yy.abs()) <= NEAR * (truth.xx + truth.yy)
        };
        PROBES.iter().all(is_near).then_some(patch)
    }

    /// The tensor at a point; `None` outside the square.
    pub(crate) fn at(&self, p: Point) -> Option<Tensor> {
        let share = [p.x / self.half, p.y / self.half];
        share.iter().all(|x| x.abs() <= 1.0).then(|| self.inside(share))
    }

    fn inside(&self, [x, y]: [f64; 2]) -> Tensor {
        let (along, across) = (self.shares(x), self.shares(y));
        let rows = self.values.chunks_exact(NODES).zip(&across);
        rows.fold(Tensor::default(), |sum, (row, &share)| {
            sum + row.iter().zip(&along).fold(Tensor::default(), |sum, (&value, &share)| sum + value * share) * share
        })
    }

    /// The share that each node has in a value; all of it where it is at a node.
    fn shares(&self, x: f64) -> [f64; NODES] {
        if let Some(k) = self.nodes.iter().position(|node| (x - node[0]).abs() < f64::MIN_POSITIVE) {
            return std::array::from_fn(|i| f64::from(u8::from(i == k)));
        }
        let weights = self.nodes.map(|[node, weight]| weight / (x - node));
        let sum: f64 = weights.iter().sum();
        weights.map(|weight| weight / sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smooth_fields_are_followed_and_others_are_not() {
        let smooth = |p: Point| Tensor::new(1.0 / (1.0 - p.x * p.x), p.x * p.y, (0.5 * p.y).exp());
        let patch = Patch::new(&smooth, 0.5).unwrap();
        for (x, y) in [(0.0, 0.0), (0.123, -0.4), (0.5, 0.5), (-0.31, 0.02)] {
            let p = Point::new(x, y);
            let Tensor { xx, xy, yy } = patch.at(p).unwrap() - smooth(p);
            assert!(xx.abs().max(xy.abs()).max(yy.abs()) < 1e-7, "{p}");
        }
        assert!(patch.at(Point::new(0.51, 0.0)).is_none());
        let bent = |p: Point| Tensor::isotropic(1.0 + (p.x - 0.1).abs());
        assert!(Patch::new(&bent, 0.5).is_none() && Patch::new(&|_: Point| Tensor::isotropic(f64::NAN), 0.5).is_none());
    }
}
