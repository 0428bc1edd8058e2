//! File formats: text to plain structs and back, without domains or metrics. Only [`read_text`] touches files.

pub mod geojson;
pub mod medit;
pub mod poly;
mod sections;
pub mod sol;
mod text;
mod words;

pub use geojson::Polygons;
pub use poly::Poly;
pub use sol::{Solution, SolutionValues};
pub use text::read_text;
