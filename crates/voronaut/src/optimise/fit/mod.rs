//! Vertices of a mesh moved off its surface, to where the mesh is closest to the surface in the sense of least squares.

mod closest;
mod crossing;
mod guard;
mod samples;
mod system;

use crate::error::Result;
use crate::geometry::Vector3;
use crate::mesh::Mesh;
use crate::surface::Surface;
use closest::Sheet;
use guard::Guard;
use samples::{Assignment, Samples};
use system::System;

/// How [`fit`] works.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitOptions {
    /// Steps at most: closest points are found, then positions solved for.
    pub steps: usize,
    /// Samples of the surface per triangle of the mesh, beside its vertices.
    pub samples: usize,
}

impl Default for FitOptions {
    fn default() -> Self {
        Self { steps: 8, samples: 30 }
    }
}

/// A mesh that was fitted to a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// The mesh with other positions.
    pub mesh: Mesh,
    /// How far mesh and surface were apart.
    pub before: Misfit,
    /// How far they are apart.
    pub after: Misfit,
    /// Vertices that are not where they were.
    pub moved: usize,
    /// Moves that were shortened or given up because a triangle would have come to harm, over all steps.
    pub held_back: usize,
    /// Steps that were taken.
    pub steps: usize,
}

/// Euclidean distances between a mesh and a surface, both ways, at samples of both.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Misfit {
    /// Square root of the mean, over both directions, of the mean square distance over the area.
    pub rms: f64,
    /// The greatest distance at a sample: a lower bound of the Hausdorff distance.
    pub greatest: f64,
}

pub fn fit(mesh: &Mesh, surface: &Surface, options: &FitOptions) -> Result<Fitted> {
    let start = Surface::new(mesh)?;
    let samples = Samples::new(surface, options.samples * start.topology().face_count());
    let t0 = std::time::Instant::now();
    let first = samples.assign(surface, &start);
    eprintln!("assign {:?}", t0.elapsed());
    let before = misfit(&first);
    let mut sheet = Sheet { topology: start.topology(), positions: start.positions().to_vec() };
    let free = free_vertices(mesh, &start);
    let guard = Guard::new(&samples.surface, &sheet, |f| samples.below(&first, f));
    let mut at = first;
    let (mut damping, mut held_back, mut steps) = (DAMPING, 0, 0);
    for _ in 0..options.steps {
        let t0 = std::time::Instant::now();
        let system = System::new(sheet.topology, &free, samples.pairs(&sheet, &at));
        let moves = system.solve(damping);
        let t1 = t0.elapsed();
        let limited = guard.limit(&sheet, &moves);
        let t2 = t0.elapsed();
        let next = Sheet { positions: limited.positions, ..sheet.clone() };
        let found = samples.follow(&next, &at);
        eprintln!("step {t1:?} {t2:?} {:?} damping {damping:.2e} rms {:.4e} -> {:.4e} greatest {:.4e} held {}", t0.elapsed(), at.mean_square.sqrt(), found.mean_square.sqrt(), found.greatest, limited.held_back);
        if found.mean_square < at.mean_square {
            let gain = 1.0 - found.mean_square / at.mean_square;
            (sheet, at) = (next, found);
            steps += 1;
            held_back += limited.held_back;
            damping *= 0.3;
            if gain < ENOUGH { break; }
        } else {
            damping *= 10.0;
        }
    }
    let mut result = mesh.clone();
    result.points = sheet.positions.iter().map(|p| p.to_array()).collect();
    let end = Surface::new(&result)?;
    let after = misfit(&samples.assign(surface, &end));
    let moved = result.points.iter().zip(&mesh.points).filter(|(a, b)| a != b).count();
    Ok(Fitted { mesh: result, before, after, moved, held_back, steps })
}
const DAMPING: f64 = 0.03;
const ENOUGH: f64 = 0.005;
fn misfit(a: &Assignment) -> Misfit { Misfit { rms: a.mean_square.sqrt(), greatest: a.greatest } }
fn free_vertices(mesh: &Mesh, surface: &Surface) -> Vec<bool> {
    let t = surface.topology();
    let mut free: Vec<bool> = (0..mesh.points.len() as u32).map(crate::triangulation::VertexId).map(|v| t.is_vertex(v) && !t.is_border_vertex(v)).collect();
    let ends = mesh.required_edges.iter().flat_map(|&e| mesh.edges[e as usize]);
    for v in mesh.corners.iter().chain(&mesh.required_points).copied().chain(ends) { free[v as usize] = false; }
    let _ = Vector3::default();
    free
}
