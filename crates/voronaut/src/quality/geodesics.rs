//! The edges of a mesh as geodesics, from the metric alone: how long, and which way they leave their ends.

use super::planar_quality::{angle, collect};
use crate::error::Result;
use crate::geodesic::{Fineness, Logarithm, Paths};
use crate::geometry::{Point, Vector};
use crate::lists::in_order;
use crate::mesh::{EdgeSide, Edges, Mesh};
use crate::metric::MetricField;
use std::collections::HashSet;

/// Lengths that are known no better than this (relative) count as not found: a histogram hardly shows more.
const VAGUE: f64 = 1e-2;
/// Of those that are known no better than this more modes make nothing: the field has kinks there.
const HOPELESS: f64 = 0.1;
/// A geodesic that turns out of the domain by no more than this (radians) runs along its border.
const ALONG: f64 = 1e-6;

/// An edge, straight and as a geodesic; directions are vectors of the plane or of space.
#[derive(Clone, Copy, Debug)]
pub(super) struct MeasuredEdge<V> {
    /// Metric length of the straight edge.
    pub(super) straight: f64,
    /// Metric length of the geodesic.
    pub(super) geodesic: f64,
    /// Which way the geodesic leaves its first end, and its second; lengths mean nothing.
    pub(super) directions: [V; 2],
    pub(super) found: Found,
}

/// Whether the geodesic of an edge serves; if not, the straight edge stands for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Found {
    Geodesic,
    /// None was found, or its length is not known well.
    No,
    /// On the border of the domain, where the geodesic of the metric alone would leave the domain.
    OnBorder,
}

/// Measures all edges, in parallel, in their order: by one of its sides, and on the border of the domain by where that lies: 1 to the left
/// of the way from the first end to the second, -1 to the right.
pub(super) fn measure<V: Send>(
    mesh: &Mesh,
    edges: &Edges,
    edge: impl Fn(&EdgeSide, Option<f64>) -> Result<MeasuredEdge<V>> + Sync + Send,
) -> Result<Vec<MeasuredEdge<V>>> {
    let labelled: HashSet<[u32; 2]> = mesh.edges.iter().copied().map(in_order).collect();
    let all: Vec<(EdgeSide, bool)> = edges.iter().map(|sides| (sides[0], sides.len() == 1)).collect();
    collect(&all, |(side, is_outer)| {
        // The domain lies to the left of its border.
        let inside = if side.forward { 1.0 } else { -1.0 };
        let is_border = *is_outer && labelled.contains(&side.ends);
        edge(side, is_border.then_some(inside))
    })
}

/// The geodesic between two points in a metric, beside the straight edge of this length.
pub(super) fn geodesic(
    metric: &dyn MetricField,
    [p, q]: [Point; 2],
    straight: f64,
    inside: Option<f64>,
) -> MeasuredEdge<Vector> {
    let paths = &Paths::default();
    let chord = MeasuredEdge { straight, geodesic: straight, directions: [q - p, p - q], found: Found::No };
    let Some(ahead) = logarithm(paths, metric, [p, q]) else { return chord };
    let Some(back) = logarithm(paths, metric, [q, p]) else { return chord };
    if let Some(side) = inside {
        let turns = [angle(metric.at(p), q - p, ahead.velocity), angle(metric.at(q), back.velocity, p - q)];
        if turns.iter().any(|turn| side * turn < -ALONG) {
            return MeasuredEdge { found: Found::OnBorder, ..chord };
        }
    }
    let geodesic = 0.5 * (ahead.length.value + back.length.value);
    MeasuredEdge { straight, geodesic, directions: [ahead.velocity, back.velocity], found: Found::Geodesic }
}

/// With as many modes as it takes.
fn logarithm(paths: &Paths, metric: &dyn MetricField, [p, q]: [Point; 2]) -> Option<Logarithm> {
    let with = |fineness| paths.logarithm(metric, p, q, fineness);
    let first = with(Fineness::MIDDLE).filter(|found| found.length.error < HOPELESS)?;
    let found = if first.length.error < VAGUE { first } else { with(Fineness::FINEST)? };
    (found.length.error < VAGUE).then_some(found)
}

#[cfg(test)]
mod tests {
    use super::super::planar_quality::edge_length;
    use super::super::test_meshes::mesh;
    use super::*;
    use crate::geometry::Tensor;

    #[test]
    fn a_border_from_which_geodesics_would_bend_away_is_kept() {
        // In the half-plane they bend towards larger y.
        let half_plane = |p: Point| Tensor::isotropic(p.y);
        let [above, below] = [1.5, 0.5].map(|y| {
            let mut one = mesh(&[[0.0, 1.0], [0.8, 1.0], [0.4, y]], &[if y > 1.0 { [0, 1, 2] } else { [0, 2, 1] }]);
            one.edges = vec![[0, 1]];
            let edge = |side: &EdgeSide, inside: Option<f64>| {
                let ends = side.ends.map(|v| one.point(v));
                Ok(geodesic(&half_plane, ends, edge_length(ends, &half_plane)?, inside))
            };
            measure(&one, &Edges::of(&one.triangles), edge).unwrap()[0]
        });
        assert_eq!((above.found, below.found), (Found::Geodesic, Found::OnBorder));
        assert!((above.geodesic - 1.32_f64.acosh()).abs() < 1e-8 && (above.straight - 0.8).abs() < 1e-12);
        assert!((below.geodesic - 0.8).abs() < 1e-12);
    }
}
