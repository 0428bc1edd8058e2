//! voronaut: anisotropic triangle meshes from a Riemannian metric field.

// The modules follow the flow of data; each uses only those above it (held by tests/architecture.rs).
pub mod canvas;
pub mod diagram;
pub mod domain;
pub mod dual;
pub mod error;
pub mod formats;
pub mod geodesic;
pub mod geometry;
pub mod mesh;
pub mod metric;
pub mod optimise;
pub mod output;
pub mod planar;
pub mod progress;
pub mod quality;
pub mod recipe;
pub mod sampling;
pub mod triangulation;

pub use error::{Error, Result};
