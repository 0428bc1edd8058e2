//! Planar domains.

mod from_mesh;
mod pslg;
mod read;
mod shapes;

pub use pslg::{Filling, Pslg, Segment, Side};
