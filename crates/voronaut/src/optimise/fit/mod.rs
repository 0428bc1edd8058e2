//! Vertices of a mesh moved off its surface, to where mesh and surface are closest in the sense of least squares.
//!
//! | module | what it is |
//! |---|---|
//! | `samples` | samples of surface and mesh, and the closest points of the other |
//! | `system` | the linear system of a step |
//! | `guard` | moves shortened until no triangle folds, becomes a sliver, or meets another |

mod guard;
mod samples;
mod system;
#[cfg(test)]
mod tests;

use crate::error::Result;
use crate::geometry::{Point3, Vector3};
use crate::manifold::Manifold;
use crate::mesh::Mesh;
use crate::triangulation::VertexId;
use guard::Guard;
use samples::{Assignment, Samples, Sheet};
use system::{Anchors, System};

/// How [`fit`] works.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FitOptions {
    /// Steps at most: closest points are found, then positions solved for.
    pub steps: usize,
    /// Samples of the surface per triangle of the mesh, beside the surface's vertices; one at least.
    pub samples: usize,
    /// How stiffly a vertex is held to the normal through its first place, as a share of what samples say of it: 0 lets it
    /// slide as far as that gains anything, at the cost of the triangles' shapes and lengths in the metric.
    pub stiffness: f64,
}

impl Default for FitOptions {
    fn default() -> Self {
        Self { steps: 8, samples: 24, stiffness: 0.05 }
    }
}

/// A mesh that was fitted to a surface.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fitted {
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
pub(crate) struct Misfit {
    /// Square root of the mean of both directions' mean square distances, each over the area.
    pub rms: f64,
    /// The greatest distance at a sample: a lower bound of the Hausdorff distance.
    pub greatest: f64,
}

/// Moves vertices of a mesh near a surface so that their root mean square distance falls: a mesh whose vertices are on a
/// curved surface is on its inner side everywhere else, and halving the differences costs no vertex.
///
/// Least squares to samples, as Levy and Bonneel 2012 have it, but of both directions' distances, and by Gauss-Newton steps: samples keep their closest points, and distances are measured along the directions between the two,
/// so that vertices glide along what is flat for free, and damping (Levenberg 1944, Marquardt 1963) keeps them where they
/// gain nothing by it. The mean square distance never rises. Topology, labels and order stay. Vertices at the border,
/// corners, the ends of the mesh's edges (its features), and what is required stay.
///
/// No triangle folds over, becomes a sliver or comes to cross another one: moves are shortened until that is so. What is
/// folded, thin or crossing in the input may remain so. Distances are Euclidean. The result does not depend on the number
/// of threads. A few kilobytes per triangle of the mesh are in use.
///
/// # Errors
/// As [`Manifold::of`], of a mesh that is no surface.
pub(crate) fn fit(mesh: &Mesh, surface: &Manifold, options: &FitOptions) -> Result<Fitted> {
    let start = Manifold::of(mesh)?;
    let samples = Samples::new(surface, options.samples.max(1) * start.topology().face_count());
    let first = samples.assign(surface, &start, None);
    let before = Misfit::of(&first);
    let mut fitting = Fitting::new(mesh, &start, &samples, first, options.stiffness);
    for _ in 0..options.steps {
        if !fitting.step() {
            break;
        }
    }
    let (held_back, steps) = (fitting.held_back, fitting.steps);
    let mut fitted = mesh.clone();
    fitted.points = fitting.sheet.positions.iter().map(|p| p.to_array()).collect();
    // Steps follow closest points from triangle to triangle; what counts is the closest of all.
    let end = Manifold::of(&fitted).ok().map(|end| Misfit::of(&samples.assign(surface, &end, Some(&fitting.at))));
    let Some(after) = end.filter(|after| after.rms <= before.rms) else {
        return Ok(Fitted { mesh: mesh.clone(), before, after: before, moved: 0, held_back, steps: 0 });
    };
    let moved = fitted.points.iter().zip(&mesh.points).filter(|&(&a, &b)| Point3::from(a) != b.into()).count();
    Ok(Fitted { mesh: fitted, before, after, moved, held_back, steps })
}

/// The least damping, a part of a vertex's own stiffness, and that of the first step. A tenth of it makes distances 3 to 10
/// per cent smaller still, by sliding vertices far along what is nearly flat: triangles then lose their shapes.
const DAMPING: f64 = 0.01;
/// After a step that was taken damping is so many times the last, ...
const BOLDER: f64 = 0.3;
/// ... after one that was taken back so many times.
const SHYER: f64 = 10.0;
/// A step that lowers the mean square distance by less than this part is the last.
const ENOUGH: f64 = 0.01;
/// Moves and distances of this part of the mesh's size are rounding.
const ROUNDING: f64 = 1e-12;

/// A mesh on its way.
struct Fitting<'a> {
    samples: &'a Samples<'a>,
    guard: Guard<'a>,
    free: Vec<bool>,
    /// Where vertices began, and the unit normals there.
    first: Vec<(Point3, Vector3)>,
    stiffness: f64,
    sheet: Sheet<'a>,
    at: Assignment,
    damping: f64,
    /// The greatest distance that is rounding.
    rounding: f64,
    held_back: usize,
    steps: usize,
}

impl<'a> Fitting<'a> {
    fn new(mesh: &Mesh, start: &'a Manifold, samples: &'a Samples<'a>, at: Assignment, stiffness: f64) -> Self {
        let sheet = Sheet::of(start);
        let normal = |v: u32| start.vertex_normal(VertexId(v));
        let first = (0..).zip(start.positions()).map(|(v, &p)| (p, normal(v))).collect();
        Self {
            guard: Guard::new(&samples.surface, &sheet, |f| at.below(f)),
            samples,
            free: free_vertices(mesh, start),
            first,
            stiffness,
            sheet,
            at,
            damping: DAMPING,
            rounding: ROUNDING * start.bounds().diagonal(),
            held_back: 0,
            steps: 0,
        }
    }

    /// Takes a step, or takes it back where distances would not fall; says whether another one may gain something.
    fn step(&mut self) -> bool {
        if self.at.mean_square.sqrt() <= self.rounding {
            return false;
        }
        let system = System::new(self.sheet.topology, &self.free, self.samples.pairs(&self.sheet, &self.at));
        let away = self.sheet.positions.iter().zip(&self.first).map(|(&now, &(then, normal))| (now - then, normal));
        let anchors = Anchors { lines: away.collect(), stiffness: self.stiffness };
        let mut moves = system.solve(self.damping, &anchors);
        moves.iter_mut().filter(|m| m.norm() <= self.rounding).for_each(|m| *m = Vector3::default());
        let limited = self.guard.limit(&self.sheet, &moves);
        let next = Sheet { positions: limited.positions, ..self.sheet };
        let found = self.samples.follow(&next, &self.at);
        if found.mean_square >= self.at.mean_square {
            self.damping *= SHYER;
            return true;
        }
        let gain = 1.0 - found.mean_square / self.at.mean_square;
        (self.sheet, self.at) = (next, found);
        self.damping = (self.damping * BOLDER).max(DAMPING);
        self.held_back += limited.held_back;
        self.steps += 1;
        gain > ENOUGH
    }
}

impl Misfit {
    fn of(assignment: &Assignment) -> Self {
        Self { rms: assignment.mean_square.sqrt(), greatest: assignment.greatest }
    }
}

/// Whether each vertex may move.
fn free_vertices(mesh: &Mesh, surface: &Manifold) -> Vec<bool> {
    let t = surface.topology();
    let slots = (0..mesh.points.len() as u32).map(VertexId);
    let mut free: Vec<bool> = slots.map(|v| t.is_vertex(v) && !t.is_border_vertex(v)).collect();
    let required = mesh.required_triangles.iter().flat_map(|&t| mesh.triangles[t as usize]);
    let ends = mesh.edges.as_flattened().iter().chain(&mesh.corners).chain(&mesh.required_points).copied();
    for v in ends.chain(required) {
        free[v as usize] = false;
    }
    free
}
