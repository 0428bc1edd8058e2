//! Where the metric was not met, and why: the edges of a mesh that are no unit edges, each with its cause, and its needles.

mod forced;
#[cfg(test)]
mod tests;

use super::curved;
use super::faults::{Position, middle};
use super::planar_quality::{Corners, MetricQuality, Shape, Shapes, demand_planar, demand_vertices, of_edges, summed};
use super::surface_quality::Field;
use crate::curved::Rule;
use crate::elementary::Elementary;
use crate::error::Result;
use crate::geodesic::is_unit;
use crate::geometry::{NEEDLE, Point, Point3, Vector};
use crate::lists::{distinct, in_order};
use crate::manifold::Manifold;
use crate::manifold::surface::FeatureOptions;
use crate::manifold::surface::metric::SurfaceMetric;
use crate::mesh::{EdgeSide, Edges, Mesh, edges_of};
use crate::metric::MetricField;
use crate::parallel::prelude::*;
use forced::{Curves, Density, Forced, Judged};
use std::collections::BTreeMap;

/// Half the logarithm of 2: unit edges have metric lengths whose logarithms are no larger than this.
const RANGE: f64 = 0.5 * std::f64::consts::LN_2;

/// A planar curve that turns by more than this (radians) in a vertex has a corner there: less is rounding.
const STRAIGHT: f64 = 1e-6;

/// Why an edge is not of unit length: the first of these that holds of it, but that shortness across the domain comes after
/// the count.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Cause {
    /// What has to be kept leaves no choice: the edge is required; or it is short, and joins two corners along a border or a
    /// feature, or two places of borders and features across the domain (a narrow channel, a sharp corner); or it ends in a
    /// vertex of such an edge that lies on a border or a feature.
    Boundary,
    /// There are too few vertices around for this metric, or too many: edges are too long, or too short, all around by much
    /// the same factor, which is the greater part of the edge's own; divided by it the edge would be of unit length.
    Count,
    /// The metric turns or grows so fast that straight edges cannot honour it there, with any vertices: no unit triangle of the
    /// tensor at the edge's middle, laid around it (six ways are tried), has three straight edges that are of unit length in
    /// the metric as it varies. Or the edge is long, and bending it would save the greater part of that.
    Turning,
    /// None of these: how vertices happen to be packed, such as a vertex of five or seven edges, or one that relaxation has
    /// not brought to its place.
    Irregular,
}

impl Cause {
    /// All, in order.
    pub const ALL: [Cause; 4] = [Cause::Boundary, Cause::Count, Cause::Turning, Cause::Irregular];

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Cause::Boundary => "boundary",
            Cause::Count => "count",
            Cause::Turning => "turning metric",
            Cause::Irregular => "irregular",
        }
    }
}

/// An edge whose metric length is outside [1/sqrt 2, sqrt 2].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnmetEdge {
    /// Its vertices, the smaller first.
    pub edge: [u32; 2],
    /// Its metric length, as in [`EdgeLengths`](super::EdgeLengths).
    pub length: f64,
    /// Why.
    pub cause: Cause,
    /// Its middle.
    pub at: Position,
}

impl UnmetEdge {
    /// Whether it is too short; otherwise it is too long.
    pub fn is_short(&self) -> bool {
        self.length < 1.0
    }
}

/// The edges of a mesh that are not of unit length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Unmet {
    /// Those edges, by their vertices.
    pub edges: Vec<UnmetEdge>,
    /// Triangles of a quality below 0.05, the poorest first.
    pub needles: Vec<Needle>,
    /// The metric lengths of all edges of the mesh, in the order of [`Edges`].
    pub lengths: Vec<f64>,
    /// What [`metric_quality`](super::metric_quality()) finds; `None` where there are no triangles.
    pub quality: Option<MetricQuality>,
}

/// So many needles are told one by one.
const TOLD: usize = 10;

/// A triangle that is next to nothing in the metric.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Needle {
    /// Its quality, as in [`Quality`](super::Quality).
    pub quality: f64,
    /// Its centroid.
    pub at: Position,
    /// Whether what has to be kept leaves no choice: all its corners are on borders or features, or required; or its shortest
    /// edge is short because of what has to be kept ([`Cause::Boundary`]), joins two places of that, and is so short that even
    /// with two unit edges the triangle on it would be a needle.
    pub is_forced: bool,
}

/// How many needles there are.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Needles {
    /// How many.
    pub count: usize,
    /// Those that borders, features and required vertices force.
    pub forced: usize,
    /// The poorest of those that are not forced, and then of those that are, ten at most.
    pub poorest: Vec<Needle>,
}

impl Needles {
    fn of(all: &[Needle]) -> Self {
        let (forced, free): (Vec<Needle>, Vec<Needle>) = all.iter().partition(|needle| needle.is_forced);
        let poorest = free.iter().chain(&forced).copied().take(TOLD).collect();
        Self { count: all.len(), forced: forced.len(), poorest }
    }
}

/// How many edges are not of unit length, and why; and how many triangles are needles.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct UnmetFigures {
    /// How many.
    pub edges: usize,
    /// The same as a share of all edges.
    pub share: f64,
    /// The same for each cause; every cause is there.
    pub by_cause: BTreeMap<Cause, CauseFigures>,
    /// Triangles that are next to nothing.
    pub needles: Needles,
}

/// The edges of one cause.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct CauseFigures {
    /// How many.
    pub count: usize,
    /// The same as a share of all edges.
    pub share: f64,
    /// Those that are too short.
    pub short: usize,
    /// Those that are too long.
    pub long: usize,
    /// The one whose length is farthest from 1, by its logarithm.
    pub worst: Option<WorstEdge>,
}

/// An edge to look at.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct WorstEdge {
    /// Its metric length.
    pub length: f64,
    /// Its middle.
    pub at: Position,
}

impl Unmet {
    /// The figures of these edges.
    pub fn figures(&self) -> UnmetFigures {
        let share = |count: usize| count as f64 / self.lengths.len().max(1) as f64;
        let of_cause = |cause: Cause| {
            let all: Vec<&UnmetEdge> = self.edges.iter().filter(|edge| edge.cause == cause).collect();
            let short = all.iter().filter(|edge| edge.is_short()).count();
            let far = |edge: &UnmetEdge| edge.length.logarithm().abs();
            let worst = all.iter().copied().reduce(|worst, edge| if far(edge) > far(worst) { edge } else { worst });
            let worst = worst.map(|edge| WorstEdge { length: edge.length, at: edge.at });
            (cause, CauseFigures { count: all.len(), share: share(all.len()), short, long: all.len() - short, worst })
        };
        let edges = self.edges.len();
        let by_cause = Cause::ALL.into_iter().map(of_cause).collect();
        UnmetFigures { edges, share: share(edges), by_cause, needles: Needles::of(&self.needles) }
    }
}

/// Of a planar mesh.
pub(super) fn in_plane(mesh: &Mesh, metric: &dyn MetricField, see: impl FnMut([f64; 2])) -> Result<Unmet> {
    demand_planar(mesh)?;
    let around = |ends: [u32; 2]| {
        let [a, b] = ends.map(|v| mesh.point(v));
        let (middle, half) = (a.midpoint(b), (b - a) * 0.5);
        Some(Around { field: Box::new(move |p: Point| metric.at(middle + (p - Point::default()))), half })
    };
    if mesh.curved.is_some() {
        mesh.check_numbers()?;
        let rule = Rule::fine(mesh);
        let shape = |t| curved::shape(mesh, &rule, t, metric).map(|[quality, angle]| Shape::new(quality, angle));
        let length = |side: &EdgeSide| curved::side_length(mesh, side, metric);
        return find(mesh, STRAIGHT, length, shape, around, Position::in_plane, see);
    }
    let (corners, mean) = Corners::of(mesh, metric)?;
    let shape = move |t: usize| Ok(Shape::of(mean(mesh.triangles[t]), mesh.corners_of(mesh.triangles[t])));
    let length = move |side: &EdgeSide| corners.edge_length(side.ends);
    find(mesh, STRAIGHT, length, shape, around, Position::in_plane, see)
}

/// Of the mesh of a surface.
pub(super) fn on_surface(
    mesh: &Mesh,
    surface: &Manifold,
    metric: &dyn SurfaceMetric,
    see: impl FnMut([f64; 2]),
) -> Result<Unmet> {
    demand_vertices(mesh)?;
    let field = Field::new(surface, metric);
    let around = |ends: [u32; 2]| {
        let [a, b] = ends.map(|v| mesh.position(v));
        let (metric, edge) = field.around(a.lerp(b, 0.5), b - a)?;
        Some(Around { field: Box::new(metric), half: edge * 0.5 })
    };
    let length = |side: &EdgeSide| field.length(side.ends.map(|v| mesh.position(v)));
    let shapes = field.shapes(mesh)?;
    let shape = |t: usize| Ok(shapes(mesh.triangles[t]));
    find(mesh, FeatureOptions::DEFAULT_ANGLE.to_radians(), length, shape, around, Position::from, see)
}

/// What the metric is around the middle of an edge, which lies at the origin.
pub(super) struct Around<'a> {
    /// The metric in a plane.
    pub(super) field: Box<dyn MetricField + 'a>,
    /// From the middle to the edge's second end.
    pub(super) half: Vector,
}

fn find<'a>(
    mesh: &Mesh,
    corner: f64,
    length: impl Fn(&EdgeSide) -> Result<f64> + Sync + Send,
    shape: impl Fn(usize) -> Result<Shape> + Sync + Send,
    around: impl Fn([u32; 2]) -> Option<Around<'a>> + Sync + Send,
    position: impl Fn(Point3) -> Position + Sync,
    mut see: impl FnMut([f64; 2]),
) -> Result<Unmet> {
    let mut poor = Vec::new();
    let of_all = Shapes::of(mesh, &shape, &position, |t, found| {
        see(found);
        poor.extend((found[0] < NEEDLE).then_some((t, found[0])));
    })?;
    // What it holds is as large as the mesh, as is what lengths are measured by.
    drop(shape);
    let edges = Edges::of(&mesh.triangles);
    let lengths = of_edges(&edges, &length)?;
    drop(length);
    let curves = Curves::of(mesh, &edges, corner);
    let ends: Vec<[u32; 2]> = edges.ends().collect();
    let forced = Forced::of(&curves, &ends, &lengths);
    let judged = |((&ends, &length), &forced)| Judged { ends, length, forced };
    let all = || ends.iter().zip(&lengths).zip(&forced).map(judged);
    let wrong: Vec<Judged> = all().filter(|edge| !is_unit(edge.length)).collect();
    let near = Density::near(mesh.points.len(), &wrong, all);
    let of_poor = distinct(poor.iter().flat_map(|&(t, _)| edges_of(mesh.triangles[t])).map(in_order));
    let sides: Vec<Judged> = all().filter(|edge| of_poor.binary_search(&edge.ends).is_ok()).collect();
    let quality = summed(mesh, &edges, &ends, &lengths, &of_all, &position);
    drop((edges, ends, forced));
    let density = Density::of(mesh.points.len(), near);
    let turns = |edge: &Judged| {
        let around = around(edge.ends);
        around.is_some_and(|around| {
            forced::straight_edges_fail(around.field.as_ref()) || forced::bends(&around, edge.length)
        })
    };
    let cause = |edge: &Judged| match () {
        () if edge.forced == Forced::Kept => Cause::Boundary,
        () if density.explains(edge) => Cause::Count,
        () if edge.forced == Forced::Across => Cause::Boundary,
        () if turns(edge) => Cause::Turning,
        () => Cause::Irregular,
    };
    let unmet = |edge: &Judged| {
        let at = position(middle(mesh, &edge.ends));
        UnmetEdge { edge: edge.ends, length: edge.length, cause: cause(edge), at }
    };
    let stands_on_kept = |corners: [u32; 3]| {
        let at = |side: [u32; 2]| sides.binary_search_by_key(&in_order(side), |edge| edge.ends).ok();
        let found = edges_of(corners).into_iter().filter_map(|side| Some(sides[at(side)?]));
        found.min_by(|e, f| e.length.total_cmp(&f.length)).is_some_and(|edge| {
            edge.forced != Forced::No && curves.has_all(&edge.ends) && isosceles(edge.length) < NEEDLE
        })
    };
    let needle = |(t, quality): (usize, f64)| {
        let corners = mesh.triangles[t];
        let is_forced = curves.has_all(&corners) || stands_on_kept(corners);
        Needle { quality, at: position(middle(mesh, &corners)), is_forced }
    };
    let mut needles: Vec<Needle> = poor.iter().copied().map(needle).collect();
    needles.sort_by(|a, b| a.quality.total_cmp(&b.quality));
    let edges = wrong.par_iter().map(unmet).collect();
    Ok(Unmet { edges, needles, lengths, quality })
}

/// The quality of a triangle of two unit edges and one of this metric length.
fn isosceles(base: f64) -> f64 {
    // 4 sqrt 3 A over the sum of the squares, A half of the base times the height.
    let height = (1.0 - 0.25 * base * base).max(0.0).sqrt();
    2.0 * 3.0_f64.sqrt() * base * height / (2.0 + base * base)
}
