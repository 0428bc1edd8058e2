//! Seeds with the metric around them, at the scale of their cells.

use crate::geodesic::{LocalMetric, gauss_curvature};
use crate::geometry::Point;
use crate::metric::{MetricField, Scaled};

/// A seed and the metric around it.
pub(super) struct Site {
    pub(super) at: Point,
    /// At first the tensor only.
    pub(super) local: LocalMetric,
    /// Gauss curvature.
    pub(super) curvature: f64,
    /// Metric length that edges at the seed have.
    pub(super) spacing: f64,
}

impl Site {
    pub(super) fn new(field: &dyn MetricField, at: Point) -> Self {
        let local = LocalMetric { tensor: field.at(at), ..LocalMetric::default() };
        Self { at, local, curvature: 0.0, spacing: 0.0 }
    }

    /// Takes derivatives and curvature at the scale of the spacing.
    pub(super) fn expand(&mut self, field: &dyn MetricField, spacing: f64) {
        self.spacing = spacing;
        let factor = 1.0 / (spacing * spacing);
        let unit = Scaled { field, factor };
        if !self.local.tensor.is_positive_definite() || factor <= 0.0 || !factor.is_finite() {
            return;
        }
        let local = LocalMetric::at(&unit, self.at);
        let back = spacing * spacing;
        self.local =
            LocalMetric { tensor: local.tensor * back, derivative: local.derivative.map(|t| t * back), ..local };
        self.curvature = gauss_curvature(&unit, self.at) * factor;
    }
}

/// The median length, with the tensors at their ends, of the edges at every seed; that of all edges where a seed has none.
pub(super) fn spacings(sites: &[Site], triangles: &[[u32; 3]]) -> Vec<f64> {
    let mut around: Vec<Vec<f64>> = vec![Vec::new(); sites.len()];
    for &[a, b, c] in triangles {
        for (i, j) in [(a, b), (b, c), (c, a)] {
            let [p, q] = [i, j].map(|k| &sites[k as usize]);
            let length = 0.5 * (p.local.tensor.length(q.at - p.at) + q.local.tensor.length(q.at - p.at));
            around[i as usize].push(length);
            around[j as usize].push(length);
        }
    }
    let mut all: Vec<f64> = around.iter().flatten().copied().collect();
    let overall = median(&mut all).unwrap_or(1.0);
    around.iter_mut().map(|lengths| median(lengths).unwrap_or(overall)).collect()
}

fn median(lengths: &mut [f64]) -> Option<f64> {
    lengths.sort_unstable_by(f64::total_cmp);
    lengths.get(lengths.len() / 2).copied()
}
