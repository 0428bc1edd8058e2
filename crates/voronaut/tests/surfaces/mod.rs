//! Meshes of surfaces.

mod given;
mod meshes;
