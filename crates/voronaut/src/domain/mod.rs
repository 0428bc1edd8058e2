//! Planar domains.

mod distinct;
mod from_geojson;
mod from_mesh;
mod from_poly;
mod pslg;
mod read;
mod shapes;

pub use from_geojson::from_geojson;
pub use from_mesh::from_mesh;
pub use from_poly::from_poly;
pub use pslg::{Filling, Pslg, Segment, Side};
pub use read::read as read_pslg;
pub use shapes::{disk, rect};
