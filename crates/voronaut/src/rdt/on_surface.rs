//! Seeds on a surface: lengths are those of geodesics pulled taut on the canvas.

use super::Judge;
use crate::canvas::{Canvas, Draped, metric_area};
use crate::diagram::SurfaceDiagram;
use crate::elementary::Elementary;
use crate::geodesic::{Margin, PathLength, circumradius, margin_from_lengths};
use crate::geometry::{Point3, TangentPlane, Vector};
use crate::in_circle::{InCircle, Known, Lengths, Quad, Tested};
use crate::parallel::prelude::*;
use crate::triangulation::{FaceId, Triangulation, VertexId};
use std::f64::consts::TAU;

/// The level at which geodesics are pulled taut: the only one.
const TAUT: usize = 2;
/// What such a length errs by, as a share: rounding on a polyhedral surface,
const ROUNDING: f64 = 1e-12;
/// and, on an equation's surface, what the canvas's edges leave of its curvature.
const OF_EQUATION: f64 = 1e-6;

/// Margins with a greater error are not followed: where a quadrilateral spans much of a sphere lengths alone do not tell.
const DOUBT: f64 = 0.5;

/// Seeds of a diagram on a surface. Lengths between them are those of geodesics pulled taut on the canvas, and curvatures the mean over their cells.
pub(crate) struct OnSurface<'a> {
    canvas: &'a Canvas<Draped<'a>>,
    seeds: Vec<VertexId>,
    planes: Vec<TangentPlane>,
    /// Gauss curvature in the metric, the mean over each seed's cell.
    curvature: Vec<f64>,
}

impl<'a> OnSurface<'a> {
    /// The seeds of a diagram, none of which was removed.
    pub(crate) fn new(diagram: &SurfaceDiagram<'a>) -> Self {
        let canvas = diagram.canvas();
        let seeds: Vec<VertexId> = (0..diagram.colours() as u32).filter_map(|colour| diagram.seed(colour)).collect();
        let planes = seeds.par_iter().map(|&v| canvas.draped().plane(v)).collect();
        Self { canvas, planes, curvature: curvatures(diagram, seeds.len()), seeds }
    }

    fn position(&self, i: u32) -> Point3 {
        self.canvas.draped().position(self.seeds[i as usize])
    }

    /// What the tensors at both ends say of the chord, in the mean.
    fn chord(&self, i: u32, j: u32) -> f64 {
        let e = self.position(j) - self.position(i);
        0.5 * [i, j].map(|k| self.canvas.draped().tensor(self.seeds[k as usize]).length(e)).iter().sum::<f64>()
    }
}

impl Judge for OnSurface<'_> {
    fn is_seed(&self, i: u32) -> bool {
        (i as usize) < self.seeds.len()
    }

    fn direction(&self, from: u32, to: u32) -> Vector {
        self.planes[from as usize].flatten(self.position(to) - self.position(from))
    }

    fn size(&self, [a, b, c]: [u32; 3]) -> f64 {
        let radius = circumradius(self.chord(a, b), self.chord(b, c), self.chord(c, a));
        if radius.is_finite() { radius * radius } else { f64::MAX }
    }

    /// A closed surface has no outer loop, and one that is not is known by its border.
    fn encloses(&self, _outline: &[u32]) -> bool {
        true
    }

    fn doubt(&self) -> f64 {
        DOUBT
    }
}

impl InCircle for OnSurface<'_> {
    fn may_tell(&self, _quad: &Quad, level: usize, _lengths: &Lengths, _known: Option<Tested>) -> bool {
        level == TAUT
    }

    fn is_by_lengths(&self, level: usize) -> bool {
        level == TAUT
    }

    fn solve(&self, i: u32, j: u32, level: usize) -> Option<Known> {
        let [from, to] = [i, j].map(|k| self.seeds[k as usize]);
        let value = self.canvas.draped().geodesic(from, to)?.length;
        let error = if self.canvas.draped().manifold().equation().is_some() { OF_EQUATION } else { ROUNDING };
        Some(Known { length: PathLength { value, error, curvature: [0.0; 2] }, level, is_vetoed: false })
    }

    fn margin(&self, quad: &Quad, _level: usize, lengths: &Lengths) -> Margin {
        let Some(lengths) = quad.lengths(lengths) else { return Margin::UNKNOWN };
        let bends = || quad.seeds().map(|i| self.curvature[i as usize]).into_iter();
        let curvature = [bends().fold(f64::INFINITY, f64::min), bends().fold(f64::NEG_INFINITY, f64::max)];
        margin_from_lengths(&lengths.map(|length| PathLength { curvature, ..length }))
    }
}

/// The mean Gauss curvature over every cell: the angles that are missing to a full turn around its inner canvas vertices, over
/// its metric area.
fn curvatures(diagram: &SurfaceDiagram, seeds: usize) -> Vec<f64> {
    let topology = diagram.canvas().topology();
    let mut missing = vec![TAU; topology.vertex_slots()];
    let mut share = vec![0.0; topology.vertex_slots()];
    for f in topology.faces() {
        let (angles, area) = flat(topology, f);
        for (v, angle) in topology.corners(f).into_iter().zip(angles) {
            missing[v.index()] -= angle;
            share[v.index()] += area / 3.0;
        }
    }
    let mut sums = vec![[0.0; 2]; seeds];
    for v in topology.vertices() {
        if let Some(sum) = diagram.colour(v).and_then(|colour| sums.get_mut(colour as usize)) {
            sum[0] += if topology.is_border_vertex(v) { 0.0 } else { missing[v.index()] };
            sum[1] += share[v.index()];
        }
    }
    sums.into_iter().map(|[curvature, area]| if area > 0.0 { curvature / area } else { 0.0 }).collect()
}

/// The angles at the corners of a face with its lengths, and its area.
fn flat(topology: &Triangulation, f: FaceId) -> ([f64; 3], f64) {
    let [ab, bc, ca] = f.half_edges().map(|h| topology.length(h));
    let area = metric_area(topology, f);
    let angle = |x: f64, y: f64, opposite: f64| (4.0 * area).arctangent_over(x * x + y * y - opposite * opposite);
    ([angle(ab, ca, bc), angle(ab, bc, ca), angle(bc, ca, ab)], area)
}
