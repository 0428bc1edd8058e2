//! Geodesics of a metric field, from the metric alone: local expansions, lengths of short paths, in-circle tests.

mod in_circle;
mod length;
mod local;

pub use in_circle::{Angles, frozen_margin};
pub use length::{Length, bent_chord, chord, hermite, path_energy};
pub use local::LocalMetric;
