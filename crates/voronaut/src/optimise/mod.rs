//! Moving seeds: Riemannian Lloyd relaxation, and the exchange of seeds where edges are too short or too long.

mod cell;
mod exchange;
mod lloyd;
mod protect;

pub use cell::{Cell, centroid};
pub use exchange::{exchange, meet_blocked_flips};
pub use lloyd::{Relaxed, relax};
pub use protect::{Ending, Protected, measured, protect};
