//! The surface's own triangulation, made as fine as a metric asks for: edges split that are too long, vertices contracted that are
//! too many, edges flipped. Every state is a triangulation of the surface whose triangles stand upright on it, or as upright as those
//! of the surface itself; so where vertices are held it is the surface. Flips and contractions leave no poorer
//! needles of the metric than were there, splits none where there were none: where nothing is relaxed afterwards they would stay.

mod coarsen;
mod halve;
mod refine;
mod work;

use crate::geometry::{Aabb3, Bounds, Point3, widened};
use crate::manifold::surface::closest_weights;
use crate::manifold::surface::metric::SurfaceMetric;
use crate::manifold::{Manifold, Place};
use crate::triangulation::{Triangulation, VertexId};
use work::Work;

pub(crate) use halve::{Halving, halved};

/// The least cosine between a new triangle's normal and those of the surface at its corners.
const UPRIGHT: f64 = 0.5;
/// Edges longer than this (metric: the longest of unit length) are split in exchange for others, one of so many vertices at most.
const TOO_LONG: f64 = std::f64::consts::SQRT_2;
const EXCHANGED: usize = 16;
/// Vertices at most, as a multiple of those wanted and of those of the surface together.
const MOST: usize = 8;

/// What is wanted of a triangulation.
pub(crate) struct Wanted<'a> {
    /// Places on the border of patches, or at their vertices, that shall be vertices; the only ones of the border.
    pub given: &'a [Place],
    /// The factor on the metric for which edges are of unit length.
    pub factor: f64,
    /// Vertices.
    pub count: usize,
    /// Where all vertices of the surface are kept.
    pub held: Holding<'a>,
}

/// What stays of a surface's own triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Holding<'a> {
    /// Vertices near these.
    Near(&'a [Held]),
    /// All of them, and their edges, but that too long ones are split.
    All,
}

/// What is near a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Held {
    /// The triangle.
    pub corners: [Point3; 3],
    /// How far (Euclidean) around it.
    pub within: f64,
}

impl Held {
    /// A box around all that is held.
    fn bounds(&self) -> Bounds<3> {
        widened(Aabb3::of(self.corners).expect("three corners").into(), self.within)
    }

    fn holds(&self, p: Point3) -> bool {
        Point3::weighted(self.corners, closest_weights(self.corners, p)).distance(p) <= self.within
    }
}

/// A triangulation of a surface.
pub(crate) struct Adapted {
    /// Its vertices: first the given ones, in order, then those that are held.
    pub places: Vec<Place>,
    /// How many these are.
    pub staying: usize,
    /// How they hang together.
    pub topology: Triangulation,
    /// Vertices of the surface on the border of patches that could not be contracted: more places should be given there.
    pub stuck: Vec<VertexId>,
}

/// Adapts the triangles of a surface. `None` where two of the given places are one vertex.
pub(crate) fn adapted(manifold: &Manifold, metric: &dyn SurfaceMetric, wanted: &Wanted) -> Option<Adapted> {
    let mut work = Work::new(manifold, metric, wanted)?;
    if work.keeps_edges {
        work.split_long(wanted.count);
        return Some(work.finished());
    }
    // Large triangles turn over less easily; where the border cannot be had of them, smaller ones may let it go.
    work.contract_border();
    work.split_long(MOST * (wanted.count + manifold.positions().len()));
    work.contract_border();
    if work.stuck().is_empty() {
        work.contract_to(wanted.count);
    }
    Some(work.finished())
}

/// What is left of a triangulation of the surface when vertices are contracted until there are so many: onto those that are `kept`, as far as
/// triangles stand upright. The first of these, so many, stay and come first; of the border no others are left.
pub(crate) fn contracted(
    manifold: &Manifold,
    metric: &dyn SurfaceMetric,
    factor: f64,
    (topology, places): (Triangulation, Vec<Place>),
    kept: &[VertexId],
    staying: usize,
    count: usize,
) -> Adapted {
    let mut work = Work::of(manifold, metric, factor, topology, places);
    for (i, v) in (0..).zip(kept) {
        work.vertices[v.index()].given = Some(i);
    }
    work.contract_border();
    work.contract_to(count);
    for v in &kept[staying..] {
        work.vertices[v.index()].given = None;
    }
    work.contract_to(count);
    work.finished()
}

/// Exchanges vertices of a triangulation of the surface whose first `staying` places stay: edges that are too long are split, and as
/// many vertices contracted where edges are shortest.
pub(crate) fn exchanged(
    manifold: &Manifold,
    metric: &dyn SurfaceMetric,
    factor: f64,
    places: &[Place],
    topology: &Triangulation,
    staying: usize,
) -> Adapted {
    let mut work = Work::of(manifold, metric, factor, topology.clone(), places.to_vec());
    for (i, vertex) in (0..).zip(&mut work.vertices[..staying]) {
        vertex.given = Some(i);
    }
    work.split_once(TOO_LONG, places.len() / EXCHANGED);
    work.contract_to(places.len());
    work.finished()
}

#[cfg(test)]
mod tests;
