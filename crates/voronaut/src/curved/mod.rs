//! Curved meshes: triangles of order 2 and 3 that follow a metric where straight ones cannot.
//!
//! What is minimised is the energy of the map from equilateral triangles with unit sides to each triangle, seen in the metric
//! ([`term`]): zero where all are images of such triangles by isometries, whose sides are geodesics of length one. All Bezier points are
//! unknowns, vertices too, by Newton's method ([`newton`]); sides are flipped between ([`flips`]). It starts from a straight mesh of
//! a metric that is less anisotropic ([`Tempered`]), and goes on to the one asked for. Every state is valid: by bounds of
//! Jacobians ([`jacobian`]), positive everywhere, and a boundary that stays where it is.

mod bezier;
mod density;
mod eigen;
mod elements;
mod exchange;
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
const ROUNDS: usize = 3;
const STEPS: usize = 2;
/// Exchanges of vertices for each, at most, and their share of all.
const EXCHANGES: usize = 3;
const EXCHANGED_SHARE: f64 = 0.06;
/// Steps end that gain less than this share.
const GAIN: f64 = 1e-3;

/// A curved mesh for a metric whose unit mesh it is to be, from a straight one of that metric with the first of [`POWERS`].
///
/// # Errors
/// The work is to stop.
pub(crate) fn curved(mesh: &Mesh, metric: &dyn MetricField, order: usize, progress: &dyn Progress) -> Result<Mesh> {
    let mut elements = Elements::of(mesh);
    let powers: Vec<f64> = std::env::var("POWERS").map_or(POWERS.to_vec(), |s| s.split(',').map(|x| x.parse().unwrap()).collect());
    for power in powers {
        let tempered = Tempered { field: metric, power };
        let aim = Aim { metric: if power < 1.0 { &tempered } else { metric }, lengths: 0.0 };
        settle(&mut elements, &aim, ROUNDS, progress)?;
        for _ in 0..EXCHANGES {
            if !exchanged(&mut elements, &aim, progress)? {
                break;
            }
        }
    }
    if order == 3 {
        elements = elements.raised();
        settle(&mut elements, &Aim { metric, lengths: 0.0 }, ROUNDS, progress)?;
    }
    Ok(elements.to_mesh(mesh))
}

/// Steps and flips in turns; the energy in the end.
fn settle(elements: &mut Elements, aim: &Aim, rounds: usize, progress: &dyn Progress) -> Result<f64> {
    for _ in 0..rounds {
        let energy = minimise(elements, aim, STEPS, GAIN, progress)?;
        let flips = flips::flip(elements, aim);
        if std::env::var_os("CURVED_TRACE").is_some() {
            eprintln!("energy {} flips {flips}", energy / elements.triangles.len() as f64);
        }
        if flips * 1000 < elements.triangles.len() {
            break;
        }
    }
    minimise(elements, aim, STEPS, GAIN, progress)
}

/// Exchanges vertices and lets the mesh settle; whether that gained anything. If not, all is as before.
fn exchanged(elements: &mut Elements, aim: &Aim, progress: &dyn Progress) -> Result<bool> {
    let before = newton::energy(elements, aim);
    let most = (elements.vertices() as f64 * EXCHANGED_SHARE) as usize;
    let (mut changed, count) = exchange::exchange(elements, aim, most);
    if count == 0 {
        return Ok(false);
    }
    let energy = settle(&mut changed, aim, 2, progress)?;
    if std::env::var_os("CURVED_TRACE").is_some() {
        eprintln!("exchanged {count}: {} {}", before / elements.triangles.len() as f64, energy / changed.triangles.len() as f64);
    }
    let gains = energy < before;
    if gains {
        *elements = changed;
    }
    Ok(gains)
}
