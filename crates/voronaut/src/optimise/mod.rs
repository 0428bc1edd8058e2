//! Moving seeds: relaxation by the energy of centroidal Voronoi tessellations, and the exchange of seeds where edges are
//! too short or too long. On surfaces: vertices of a finished mesh moved to where it is closest to the surface (`fit`).

mod cell;
mod cells;
mod directions;
mod exchange;
mod fit;
mod lloyd;
mod mending;
mod movers;
mod on_canvas;
mod polish;
mod protect;
mod protect_in_plane;
mod protect_on_surface;
mod quasi_newton;
mod springs;
mod survey;
mod trials;

pub use cell::Cell;
pub(crate) use cells::Cells;
pub(crate) use exchange::{exchange, meet_blocked_flips};
pub(crate) use fit::{FitOptions, fit};
pub use lloyd::Relaxed;
pub(crate) use lloyd::{Patience, relax};
pub(crate) use mending::Mending;
pub(crate) use on_canvas::OnCanvas;
pub use polish::Polished;
pub(crate) use polish::{polish, polish_on_surface, polishing_norm};
pub use protect::Ending;
pub(crate) use protect::Protected;
pub(crate) use protect_in_plane::protect;
pub(crate) use protect_on_surface::{measured_on_surface, protect_on_surface};
pub(crate) use survey::measured;
