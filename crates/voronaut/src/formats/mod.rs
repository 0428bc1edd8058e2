//! File formats: text to plain structs and back, without files, domains or metrics.

pub mod geojson;
pub mod medit;
pub mod obj;
pub mod off;
pub mod ply;
pub mod points;
pub mod poly;
mod sections;
pub mod sol;
pub mod stl;
mod words;

pub use geojson::Polygons;
pub use poly::Poly;
pub use sol::{Solution, SolutionValues, Solutions};
