//! The main job in the plane: what is meshed, and what is made and told on the way.

use super::stopwatch::Stopwatch;
use super::{Adaptive, Aim, LoopOptions, MeshOptions, Meshed, PlanarMetric, metric_of_function, metric_of_solution};
use crate::canvas::CanvasFigures;
use crate::error::Result;
use crate::figures;
use crate::geometry::Point;
use crate::manifold::domain::Domain;
use crate::mesh::{Mesh, SolutionValues};
use crate::metric::{Expression, MetricField, ScalarField, Snapshot, Uniform};
use crate::progress::Progress;
use crate::sampling::{Fill, Target};

/// Meshes a domain by a metric, for any purpose: [`mesh_for`] without an aim.
///
/// # Errors
/// As for [`mesh_for`].
pub fn mesh(
    domain: &Domain,
    field: &dyn MetricField,
    options: &MeshOptions,
    progress: &dyn Progress,
) -> Result<Meshed> {
    mesh_for(domain, field, None, options, progress)
}

/// Meshes a domain by a metric: plans the scale, samples the boundary, fills the interior, relaxes, checks. With an aim, the
/// mesh is polished in the end: vertices and edges are then where the error is least, which is near the metric's unit mesh.
///
/// # Errors
/// The metric is invalid somewhere, the work would exceed the memory limit, or the method drives no diagrams. A valid domain with a valid metric is
/// refused for no other reason; what could not be met is in [`Meshed::notes`].
pub fn mesh_for(
    domain: &Domain,
    field: &dyn MetricField,
    aim: Option<Aim>,
    options: &MeshOptions,
    progress: &dyn Progress,
) -> Result<Meshed> {
    Case { domain, field, aim, options, progress }.mesh()
}

impl Adaptive for Domain {
    fn dimension(&self) -> u8 {
        2
    }

    fn mesh_at_time(
        &self,
        function: &Expression,
        time: f64,
        options: &LoopOptions,
        progress: &dyn Progress,
    ) -> Result<(Meshed, Vec<f64>)> {
        let now = Snapshot { expression: function.clone(), time };
        let metric = metric_of_function(&now, self.planar(), &options.metric, options.graded_at())?;
        let meshed = mesh_by(self, &metric, options, progress)?;
        let value = |&[x, y, _]: &[f64; 3]| now.value(Point::new(x, y));
        let values = meshed.mesh.points.iter().map(value).collect();
        Ok((meshed, values))
    }

    fn mesh_for_solution(
        &self,
        solution: Option<(&Mesh, &SolutionValues)>,
        options: &LoopOptions,
        progress: &dyn Progress,
    ) -> Result<Meshed> {
        let metric = match solution {
            None => PlanarMetric::plain(Uniform::default()),
            Some((mesh, values)) => {
                metric_of_solution(mesh, values, self.planar(), &options.metric, options.graded_at())?
            }
        };
        mesh_by(self, &metric, options, progress)
    }
}

fn mesh_by(domain: &Domain, metric: &PlanarMetric, options: &LoopOptions, progress: &dyn Progress) -> Result<Meshed> {
    mesh_for(domain, metric.field.as_ref(), metric.aim(options.metric.norm), &options.mesh, progress)
}

/// What is meshed, by what.
#[derive(Clone, Copy)]
pub(super) struct Case<'a> {
    pub(super) domain: &'a Domain,
    pub(super) field: &'a dyn MetricField,
    pub(super) aim: Option<Aim<'a>>,
    pub(super) options: &'a MeshOptions,
    pub(super) progress: &'a dyn Progress,
}

/// A mesh in the making, straight, and what is to be told of it.
pub(super) struct Job<'a> {
    pub(super) domain: &'a Domain,
    pub(super) field: &'a dyn MetricField,
    pub(super) options: &'a MeshOptions,
    pub(super) progress: &'a dyn Progress,
    pub(super) canvas: Option<CanvasFigures>,
    pub(super) diagram: Option<figures::Diagram>,
    pub(super) watch: &'a Stopwatch<'a>,
    /// Whether the seeds come from those of a coarser mesh.
    pub(super) is_even: bool,
    pub(super) notes: Vec<String>,
}

impl<'a> Job<'a> {
    pub(super) fn new(case: &Case<'a>, watch: &'a Stopwatch<'a>) -> Self {
        Self {
            domain: case.domain,
            field: case.field,
            options: case.options,
            progress: watch.progress,
            canvas: None,
            diagram: None,
            watch,
            is_even: false,
            notes: Vec::new(),
        }
    }

    pub(super) fn target(&self) -> Target {
        match (self.options.vertices, self.options.complexity) {
            (Some(n), _) => Target::Vertices(n),
            (None, Some(c)) => Target::Complexity(c),
            (None, None) => Target::Metric,
        }
    }

    /// A count that was asked for is met exactly; one that follows from the metric is an estimate.
    pub(super) fn fill(&self, count: usize) -> Fill {
        if self.options.vertices.is_some() { Fill::Exactly(count) } else { Fill::AtMost(count) }
    }
}
