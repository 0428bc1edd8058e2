//! Diagrams, duals and meshes on surfaces, against what is known in closed form.

mod given;
mod meshes;
mod random;
mod sheet;
mod sphere;
mod torus;
