//! Geodesics of a metric field.
//!
//! From the metric alone: local expansions, lengths of short paths, in-circle tests. On a canvas: distances to the nearest
//! of many sources, by solvers that share one interface, `Geodesic`. Each is made on what it travels on: `Marching` on a
//! triangulation with metric lengths, without positions; the others on a [`Graph`], which every kind of canvas gives.

mod bow;
mod circumcentre;
mod curve;
mod edge_path;
mod front;
mod graph;
mod heat;
mod in_circle;
mod jet;
mod karcher;
mod konukoglu;
mod label;
mod lattice;
mod length;
mod local;
mod march;
mod mending;
mod method;
mod patch;
mod path;
mod rule;
mod straighten;
mod strip;
mod stvd;
mod sweep;
mod tension;
mod update;

pub(crate) use bow::{bowed_between, bowed_chord};
pub(crate) use circumcentre::{Circle, equalising_step, flat_centre, margin_by_power};
pub use curve::Curve;
pub(crate) use curve::PathLength;
pub use graph::Graph;
pub(crate) use graph::Sight;
pub(crate) use heat::Heat;
pub use in_circle::{Angles, Margin};
pub(crate) use in_circle::{circumradius, frozen_margin, margin_from_lengths, margin_of_estimates};
pub(crate) use jet::gauss_curvature;
pub(crate) use karcher::karcher_mean;
pub(crate) use konukoglu::Konukoglu;
pub(crate) use label::{Label, NO_COLOUR, Sources, Support};
pub(crate) use lattice::Lattice;
pub(crate) use length::{
    Length, bent_chord, chord, chord_between, chord_by, chord_near, hermite, hermite_between, is_unit, place_at,
    reached,
};
pub(crate) use local::{LocalMetric, STILL};
pub(crate) use march::Marching;
pub use mending::Propagation;
pub use method::Method;
pub(crate) use path::{Fineness, Logarithm, Paths};
pub use straighten::Polyline;
pub(crate) use straighten::{Obstacles, straighten};
pub(crate) use strip::taut;
pub(crate) use stvd::Stvd;
pub(crate) use sweep::Dijkstra;
pub(crate) use update::{Wave, layout};

use crate::triangulation::VertexId;

/// A solver of distances on a canvas, with which it was made.
pub(crate) trait Geodesic: Sync {
    /// Distance to, and colour of, the nearest source of every vertex.
    fn propagate(&self, sources: &Sources) -> Propagation;

    /// Mends labels after the sources at the vertices `changed` have changed; the result equals [`Geodesic::propagate`].
    fn update(&self, sources: &Sources, changed: &[VertexId], state: &mut Propagation);

    /// The same method on parts of the canvas.
    fn patches(&self) -> Box<dyn Patches + '_>;
}

/// Distances from one source on one part of a canvas after the other, without regard for other sources.
pub(crate) trait Patches {
    /// The distance of each vertex of the patch from the source that has the given distances from some vertices; infinite
    /// where it is not reached within the patch.
    fn distances(&mut self, patch: &[VertexId], starts: &[(VertexId, f64)]) -> Vec<f64>;
}

/// Work of a propagation, counted; deterministic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct MarchCounters {
    /// Vertices taken from the front.
    pub settled: u64,
    /// Those of them whose label was stale and was withdrawn.
    pub withdrawn: u64,
    /// Crossings of a face tried; on a graph, steps over an edge.
    pub crossings: u64,
    /// Labels computed anew from all neighbours.
    pub reconsidered: u64,
}

impl std::ops::AddAssign for MarchCounters {
    fn add_assign(&mut self, more: Self) {
        self.settled += more.settled;
        self.withdrawn += more.withdrawn;
        self.crossings += more.crossings;
        self.reconsidered += more.reconsidered;
    }
}
