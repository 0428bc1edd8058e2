//! Placing seeds: first the boundary and interfaces at unit metric length, then the interior, one seed at a time where
//! the metric circumradius is largest, or where the nearest seed is farthest.

mod adapted;
mod contract;
mod curve_sizes;
mod curves;
mod farthest;
mod features;
mod interior;
mod on_surface;
mod plan;
mod protected;
mod segments;

pub(crate) use adapted::{Adapted, Held, Wanted, adapted, exchanged};
pub(crate) use curve_sizes::CurveSizes;
pub(crate) use curves::simplify;
pub use farthest::Farthest;
pub(crate) use farthest::refine_farthest;
pub(crate) use features::{ALL_VERTICES, FeatureEdge, FeatureSeeds, MeasuredCurves};
pub(crate) use interior::{Fill, insert_spaced, refine};
pub(crate) use on_surface::{Seeded, seed_surface, triangulated, triangulated_upright};
pub use plan::demand_memory;
pub(crate) use plan::{Plan, Target};
pub(crate) use protected::{Picking, refine_protected};
pub(crate) use segments::sample_segments;
