//! Placing seeds: first the boundary and interfaces at unit metric length, then the interior, one seed at a time where
//! the metric circumradius is largest, or where the nearest seed is farthest.

mod adapted;
mod curves;
mod farthest;
mod features;
mod interior;
mod plan;
mod protected;
mod queue;

pub(crate) use adapted::{Adapted, Halving, Held, Holding, Wanted, adapted, contracted, exchanged, halved};
pub(crate) use curves::{CurveSizes, simplify};
pub use farthest::Farthest;
pub(crate) use farthest::{fill_farthest, refine_farthest};
pub(crate) use features::{ALL_VERTICES, FeatureEdge, FeatureSeeds, MeasuredCurves};
pub(crate) use interior::{Fill, insert_spaced, refine};
pub use plan::demand_memory;
pub(crate) use plan::{MetricArc, Plan, Target, pieces, sample_segments};
pub(crate) use protected::{Picking, refine_protected};
