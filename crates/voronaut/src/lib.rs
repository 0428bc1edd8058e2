//! voronaut

pub mod domain;
pub mod error;
pub mod geometry;
pub mod mesh;
pub mod metric;

pub use error::{Error, Result};
