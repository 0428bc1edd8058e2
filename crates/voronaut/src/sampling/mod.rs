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

pub use adapted::{Adapted, Held, Wanted, adapted, exchanged};
pub use curve_sizes::CurveSizes;
pub use curves::simplify;
pub use farthest::{Farthest, refine_farthest};
pub use features::{ALL_VERTICES, FeatureEdge, FeatureSeed, FeatureSeeds, MeasuredCurves};
pub(crate) use interior::insert_spaced;
pub use interior::{Fill, Refined, refine};
pub use on_surface::{Seeded, seed_surface, triangulated, triangulated_upright};
pub use plan::{Plan, Target, demand_memory};
pub use protected::{Picked, Picking, refine_protected};
pub use segments::{MetricArc, sample_segments};
