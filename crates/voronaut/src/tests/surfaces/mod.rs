//! Diagrams and duals on surfaces, against what is known in closed form.

mod brute;
mod certificate;
mod protected;
mod random;
mod realisation;
mod sheet;
mod sphere;
mod torus;
