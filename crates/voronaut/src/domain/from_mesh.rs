//! from_mesh
