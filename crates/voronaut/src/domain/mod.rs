//! Planar domains.

mod pslg;

pub use pslg::{Filling, Pslg, Segment, Side};
