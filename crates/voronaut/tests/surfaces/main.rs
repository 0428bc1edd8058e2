//! Diagrams, duals and meshes on surfaces, against what is known in closed form.

mod meshes;
mod sphere;
