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

pub use adapted::Held;
pub use adapted::adapted;
pub(crate) use adapted::exchanged;
pub use adapted::{Adapted, Wanted};
pub(crate) use curve_sizes::CurveSizes;
pub use curves::simplify;
pub use farthest::{Farthest, refine_farthest};
pub(crate) use features::{ALL_VERTICES, FeatureEdge, FeatureSeeds, MeasuredCurves};
pub use interior::Refined;
pub(crate) use interior::insert_spaced;
pub use interior::{Fill, refine};
pub(crate) use on_surface::{Seeded, triangulated};
pub(crate) use on_surface::{seed_surface, triangulated_upright};
pub use plan::{Plan, Target, demand_memory};
pub(crate) use protected::{Picking, refine_protected};
pub use segments::MetricArc;
pub use segments::sample_segments;
