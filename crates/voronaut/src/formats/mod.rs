//! File formats: text to plain structs and back, without files, domains or metrics.

pub mod geojson;
pub mod medit;
pub mod points;
pub mod poly;
mod sections;
pub mod sol;
mod words;

pub use geojson::Polygons;
pub use poly::Poly;
pub use sol::{Solution, SolutionValues};
