//! Placing seeds: first the boundary and interfaces at unit metric length, then the interior, one seed at a time where
//! the metric circumradius is largest.

mod curves;
mod interior;
mod plan;
mod segments;

pub use curves::simplify;
pub(crate) use interior::insert_spaced;
pub use interior::{Fill, Refined, refine};
pub use plan::{Plan, Target};
pub use segments::{MetricArc, sample_segments};
