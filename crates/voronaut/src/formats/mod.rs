//! File formats: bytes to plain structs and back, without domains or metrics.

mod bytes;
mod cutting;
mod document;
mod ears;
mod files;
mod losses;
pub mod freefem;
pub mod geojson;
pub mod gmsh;
pub mod medit;
pub mod obj;
pub mod off;
pub mod ply;
pub mod points;
pub mod poly;
pub mod sol;
pub mod stl;
mod values;
mod volumes;
pub mod vtk;
mod words;

pub use document::{Document, Field, Fields};
pub use files::{Format, MESH_ENDINGS, open, read, read_solution, read_solutions, read_text};
pub use geojson::Polygons;
pub use losses::lost_in_outline;
pub use poly::Poly;
pub use values::{Solution, SolutionValues, Solutions, TensorOrder};
