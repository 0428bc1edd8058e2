//! How large convex disks are (RR-9103, section 10.2): curvature, and geodesic loops excluded by Gauss and Bonnet.

use super::coverage::Coverage;
use super::sight::{Sight, Sights};
use crate::diagram::Diagram;
use crate::geodesic::{Fineness, Paths, gauss_curvature};
use crate::geometry::Point;
use crate::metric::{MetricField, Scaled};
use crate::net::Net;
use crate::parallel::prelude::*;
use crate::triangulation::VertexId;
use serde::Serialize;
use std::f64::consts::PI;

/// Canvas vertices at which the curvature is sampled, at most about.
const SAMPLES: usize = 5_000;

/// What is known of convex disks. Lengths are of the metric.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Convexity {
    /// The greatest Gauss curvature at canvas vertices: sampled, no bound.
    pub curvature: f64,
    /// The integral of the curvature where it is positive. A geodesic loop bounds more than pi of it.
    pub total: f64,
    /// Holes of the domain: loops around them are not excluded.
    pub holes: usize,
    /// No smaller disk is other than convex, if there are no short loops: min(injectivity radius / 2, pi / (2 sqrt
    /// curvature)); infinite where the curvature is nowhere positive.
    pub radius: f64,
    /// On a surface an estimate of the injectivity radius from below, by geodesic loops that were found at seeds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub injectivity: Option<f64>,
    /// Of the covered triangles: how much the two shorter sides are longer than the third at least, as a share of it,
    /// less the errors of the lengths. Positive where no three seeds of a triangle lie on a geodesic.
    pub bend: f64,
    /// What else keeps disks from being known to be convex.
    #[serde(skip)]
    pub open: Option<&'static str>,
}

impl Convexity {
    /// Why short geodesic loops are not excluded.
    pub(crate) fn doubt(&self) -> Option<String> {
        if let Some(open) = self.open {
            return Some(open.into());
        }
        if let Some(injectivity) = self.injectivity {
            return injectivity.is_nan().then(|| "the injectivity radius: no figure".into());
        }
        if self.holes > 0 {
            let holes = self.holes;
            return Some(format!("the injectivity radius: geodesic loops around {holes} holes are not excluded"));
        }
        let total = self.total;
        // A value that is none is a doubt as well.
        let doubt = || format!("the injectivity radius: {total:.3} of positive curvature (pi or more) may bound loops");
        (total >= PI || total.is_nan()).then(doubt)
    }
}

/// Samples the curvature over differences of a few hundredths of `unit`, a length of the metric.
pub(super) fn convexity(diagram: &Diagram, net: &Net, coverage: &Coverage, unit: f64) -> Convexity {
    let (canvas, field) = (diagram.canvas(), diagram.field());
    let planar = canvas.embedded();
    let topology = &planar.topology;
    let scaled = Scaled { field, factor: unit.powi(-2) };
    let stride = (canvas.vertex_count() / SAMPLES).max(1);
    let vertices: Vec<VertexId> = (0..canvas.vertex_count() as u32).step_by(stride).map(VertexId).collect();
    // A third of the faces around a vertex is its share of the area.
    let sampled = |&v: &VertexId| {
        let p = planar.position(v);
        let doubled = |[a, b, c]: [Point; 3]| (b - a).cross(c - a);
        let faces = topology.star(v).map(|h| 0.5 * doubled(planar.triangle(h.face()))).sum::<f64>() / 3.0;
        (gauss_curvature(&scaled, p), faces * scaled.at(p).determinant().max(0.0).sqrt())
    };
    let found: Vec<(f64, f64)> = vertices.par_iter().with_min_len(256).map(sampled).collect();
    // NaN must not be lost in a maximum.
    let most = found.iter().map(|s| s.0).fold(0.0, |a: f64, b: f64| if b > a || b.is_nan() { b } else { a });
    let total =
        stride as f64 * found.iter().map(|&(k, area)| if k.is_nan() { k } else { k.max(0.0) * area }).sum::<f64>();
    let parts = topology.vertex_parts();
    let parts = topology.vertices().filter(|v| parts[v.index()] == v.index()).count();
    let holes = parts.cast_signed().saturating_sub(topology.euler_characteristic()).max(0).cast_unsigned();
    let of_curved = unit * 0.5 * PI / most.sqrt();
    let radius = if most <= FLAT { f64::INFINITY } else { of_curved };
    let is_covered = |corners: &[u32; 3]| corners.iter().any(|&i| coverage.covered[i as usize]);
    let triangles = net.triangles.iter().map(|ball| ball.corners).filter(is_covered).collect();
    let bend = bend(triangles, diagram);
    Convexity { curvature: most / unit.powi(2), total, holes, radius, injectivity: None, bend, open: None }
}

/// Curvatures (in units of the sampling) that differences may show of a flat metric.
const FLAT: f64 = 1e-7;

/// The least [`Convexity::bend`] of triangles; NaN where lengths are not known.
pub(super) fn bend<P>(triangles: Vec<[u32; 3]>, sights: &impl Sights<P>) -> f64 {
    let paths = Paths::default();
    let of_triangle = |corners: [u32; 3]| {
        let Some(sight) = sights.around(corners) else { return f64::NAN };
        let [a, b, c] = corners.map(|i| sight.seed(i));
        let mut sides = [(a, b), (b, c), (c, a)].map(|(p, q)| sight.length(&paths, p, q, Fineness::COARSEST));
        sides.sort_unstable_by(|x, y| x.0.total_cmp(&y.0));
        let error: f64 = sides.iter().map(|side| side.0 * side.1).sum();
        (sides[0].0 + sides[1].0 - sides[2].0 - error) / sides[2].0
    };
    let bends: Vec<f64> = triangles.into_par_iter().with_min_len(16).map(of_triangle).collect();
    bends.into_iter().fold(f64::INFINITY, |a, b| if b < a || b.is_nan() { b } else { a })
}
