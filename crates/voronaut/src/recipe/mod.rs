//! The main job as one function: from a domain and a metric to a valid unit mesh.

mod adapt;
mod certified;
mod coarse;
mod curved;
mod dual;
mod at_vertices;
mod field;
mod idle;
mod mesher;
mod on_surface;
mod options;
mod parts;
mod patches;
mod periodic;
mod plane;
mod protection;
mod remesh_sizes;
mod settle;
mod stopwatch;
mod straight;
mod surface;
mod surface_field;
mod surface_coarse;
mod surface_pass;

pub use adapt::{Adaptive, LoopOptions, Source, Step, adapt};
pub use at_vertices::metric_at_vertices;
pub use certified::{certified_canvas, certified_canvas_on};
pub use dual::{Measured, SeedDual, dual, net, surface_mesh};
#[cfg(test)]
pub(crate) use field::metric_named;
pub use field::{
    GradedAt, MetricOptions, PlanarMetric, metric, metric_of_field, metric_of_function, metric_of_samples,
    metric_of_solution, metric_of_values,
};
pub use idle::{Idle, Origin, Task};
pub use options::{Boundary, Centroid, Effort, MeshOptions, Mesher, Seeding};
pub use parts::{Part, mesh_in_parts, mesh_part, mesh_surface_in_parts, mesh_surface_part};
pub use plane::{mesh, mesh_for};
pub use remesh_sizes::{Asked, RemeshSizes};
pub use surface::mesh_surface;
pub use surface_field::{SurfaceSource, metric_on_surface};

use crate::canvas::CanvasFigures;
use crate::figures;
use crate::manifold::Place;
use crate::mesh::Mesh;
use crate::metric::nodal::COMPLEXITY_PER_VERTEX;
use crate::metric::{Norm, ScalarField};
use crate::net::Net;
use crate::optimise::{Polished, Relaxed};
use crate::quality::{SurfaceFidelity, Validity};

/// The result of meshing.
#[derive(Clone, Debug, Default)]
pub struct Meshed {
    /// A valid mesh.
    pub mesh: Mesh,
    /// What was found when it was examined: no fault.
    pub validity: Validity,
    /// The factor on the metric tensor for which the mesh is a unit mesh (1 where the metric was used as it is).
    pub metric_scale: f64,
    /// The factor that the number of vertices asks for in closed form: [`COMPLEXITY_PER_VERTEX`] for each over the metric's complexity (to
    /// about 1 %). `metric_scale` is less where straight edges cannot honour the metric, and unit edges then flatter. `None` without a number.
    pub closed_form_scale: Option<f64>,
    /// How its edges were settled.
    pub dual: figures::Dual,
    /// How the seeds were relaxed.
    pub relaxation: Relaxed,
    /// How the error of interpolation was lowered, where the mesh is for a function.
    pub polished: Option<Polished>,
    /// The canvas, where one was made: that of the seeding, or where edges were settled by one.
    pub canvas: Option<CanvasFigures>,
    /// The diagram on it.
    pub diagram: Option<figures::Diagram>,
    /// The vertices as a net, by their numbers in the mesh, where it was asked for.
    pub net: Option<Net>,
    /// The same on a surface. A vertex of a feature is measured on each side of it by itself.
    pub surface_net: Option<Net<Place>>,
    /// How protection went, with [`Seeding::Protected`].
    pub protection: Option<figures::Protection>,
    /// How far the mesh of a surface is from it, where [`MeshOptions::hausd`] or [`MeshOptions::fit`] asked for it.
    pub fidelity: Option<SurfaceFidelity>,
    /// What the metric was made finer by for the sake of the distance to the surface: of a [`Finer`](crate::manifold::surface::metric::Finer).
    pub finer: Vec<f64>,
    /// The star set that became the mesh, with [`Mesher::StarSet`].
    pub star_set: Option<figures::StarSet>,
    /// Seconds per stage, in order, by the clock of [`Progress::seconds`](crate::progress::Progress::seconds).
    pub seconds: Vec<(&'static str, f64)>,
    /// What could not be met, in words for the user; empty when all was.
    pub notes: Vec<String>,
}

/// What a mesh is for: a function to be interpolated, and the norm in which the error counts.
#[derive(Clone, Copy)]
pub struct Aim<'a> {
    /// The function.
    pub function: &'a dyn ScalarField,
    /// The norm.
    pub norm: Norm,
    /// The error to which the function is known. A mesh whose error is less than half of that is not polished: the rest would be
    /// fitted to what is not known.
    pub known_to: f64,
}

/// See [`Meshed::closed_form_scale`].
fn closed_form_scale(count: usize, complexity: f64) -> f64 {
    COMPLEXITY_PER_VERTEX * count as f64 / complexity
}
