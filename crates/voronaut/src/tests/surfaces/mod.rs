//! Diagrams and duals on surfaces, against what is known in closed form.

mod random;
mod sheet;
mod sphere;
mod torus;
