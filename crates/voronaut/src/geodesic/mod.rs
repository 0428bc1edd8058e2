//! Geodesics of a metric field.
//!
//! From the metric alone: local expansions, lengths of short paths, in-circle tests. On a triangulation with metric lengths
//! (a canvas): distances to the nearest of many sources, by solvers that share one interface, [`Geodesic`], and never
//! read positions.

mod bow;
mod circumcentre;
mod curve;
mod front;
mod graph;
mod in_circle;
mod jet;
mod karcher;
mod label;
mod length;
mod local;
mod logarithm;
mod march;
mod patch;
mod path;
mod predicate;
mod rule;
mod straighten;
mod tension;
mod update;

pub use bow::{bowed_between, bowed_chord};
pub use circumcentre::{Circle, margin_by_power};
pub(crate) use circumcentre::{equalising_step, flat_centre};
pub use curve::Curve;
pub use graph::Graph;
pub use in_circle::{Angles, circumradius, frozen_margin};
pub use jet::gauss_curvature;
pub use karcher::karcher_mean;
pub use label::{Label, NO_COLOUR, Sources, Support};
pub use length::{Length, bent_chord, chord, hermite, path_energy};
pub use local::LocalMetric;
pub use logarithm::Logarithm;
pub use march::{Marching, Propagation};
pub use patch::PatchSolver;
pub use path::{Fineness, PathLength, Paths};
pub use predicate::{Margin, margin_from_lengths};
pub use straighten::{Obstacles, Open, Polyline, straighten};
pub use update::Wave;

use crate::triangulation::{Triangulation, VertexId};

/// A solver of distances on a canvas.
pub trait Geodesic: Sync {
    /// Distance to, and colour of, the nearest source of every vertex.
    fn propagate(&self, canvas: &Triangulation, sources: &Sources) -> Propagation;

    /// Mends labels after the sources at the vertices `changed` have changed; the result equals [`Geodesic::propagate`].
    fn update(&self, canvas: &Triangulation, sources: &Sources, changed: &[VertexId], state: &mut Propagation);
}

/// Work of a propagation, counted; deterministic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct MarchCounters {
    /// Vertices taken from the front.
    pub settled: u64,
    /// Those of them whose label was stale and was withdrawn.
    pub withdrawn: u64,
    /// Crossings of a face tried.
    pub crossings: u64,
    /// Labels computed anew from all neighbours.
    pub reconsidered: u64,
}
