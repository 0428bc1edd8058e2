//! Curved meshes: triangles of order 2 and 3 that follow a metric where straight ones cannot.
//!
//! What is minimised is the energy of the map from equilateral triangles with unit sides to each triangle, seen in the metric
//! ([`term`]): zero where all are images of such triangles by isometries, whose sides are geodesics of length one. All Bezier points are
//! unknowns, vertices too, by Newton's method ([`newton`]); sides are flipped between ([`flips`]). It starts from a straight mesh of
//! a metric that is less anisotropic ([`Tempered`]), and goes on to the one asked for. Every state is valid: by bounds of
//! Jacobians ([`jacobian`]), positive everywhere, and a boundary that stays where it is.

mod bezier;
mod density;
mod elements;
mod flips;
mod jacobian;
mod newton;
mod rules;
mod system;
mod tempered;
mod term;

pub(crate) use bezier::{bezier_points, exponents, side};
pub(crate) use elements::HALVINGS;
pub(crate) use jacobian::bound;
pub(crate) use rules::{GAUSS, Rule};
pub(crate) use tempered::Tempered;
pub(crate) use term::curve_at;

use crate::error::Result;
use crate::mesh::Mesh;
use crate::metric::MetricField;
use crate::progress::Progress;
use elements::Elements;
use newton::{Aim, minimise};

/// The powers of anisotropy through which it goes, from that of the straight mesh.
pub(crate) const POWERS: [f64; 4] = [0.4, 0.6, 0.8, 1.0];
/// Rounds of steps and flips for each, at most, and Newton's steps of a round.
const ROUNDS: usize = 6;
const STEPS: usize = 4;

/// A curved mesh for a metric whose unit mesh it is to be, from a straight one of that metric with the first of [`POWERS`].
///
/// # Errors
/// The work is to stop.
pub(crate) fn curved(mesh: &Mesh, metric: &dyn MetricField, order: usize, progress: &dyn Progress) -> Result<Mesh> {
    let mut elements = Elements::of(mesh);
    for power in POWERS {
        let tempered = Tempered { field: metric, power };
        let aim = Aim { metric: if power < 1.0 { &tempered } else { metric }, lengths: 0.0 };
        if power == 1.0 && order == 3 {
            elements = elements.raised();
        }
        for _ in 0..ROUNDS {
            let energy = minimise(&mut elements, &aim, STEPS, 1e-3, progress)?;
            let flips = flips::flip(&mut elements, &aim);
            if std::env::var_os("CURVED_TRACE").is_some() {
                eprintln!("power {power} energy {} flips {flips}", energy / elements.triangles.len() as f64);
            }
            if flips == 0 {
                break;
            }
        }
        minimise(&mut elements, &aim, STEPS, 1e-3, progress)?;
    }
    Ok(elements.to_mesh(mesh))
}
