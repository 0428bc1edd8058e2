//! The main job on a surface.

use super::curved::{curve_onto, demand_possible_on};
use super::stopwatch::Stopwatch;
use super::surface_pass::Setting;
use super::{
    Adaptive, Idle, LoopOptions, MeshOptions, Meshed, Origin, SurfaceSource, Task, closed_form_scale,
    metric_on_surface, protection,
};
use crate::error::Result;
use crate::manifold::Manifold;
use crate::manifold::surface::metric::{Closer, Finer, Spec, SurfaceMetric};
use crate::mesh::{Mesh, SolutionValues};
use crate::metric::{Expression, Norm};
use crate::progress::Progress;
use crate::quality::{Deviation, Meetings, Position, SurfaceFidelity, distances_around};

/// Rounds of more vertices for the sake of the distance to the surface at most.
const ROUNDS: usize = 6;
/// The second round that brings the distance down by less than this factor, beside the best before, is the last: something else than
/// lengths of edges keeps it up. One may be chance, for a single triangle is what counts.
const GAIN: f64 = 1.05;
const IDLE_ROUNDS: usize = 2;

/// Meshes a surface by a metric: features at unit length, the surface's own triangles split and contracted to unit edges, relaxed in
/// charts; with [`Seeding::Farthest`](super::Seeding::Farthest) seeds are farthest points on a canvas, with [`crate::dual::Road::Canvas`] edges are settled by
/// geodesics on one. Vertices are on the surface. With a number of vertices asked for the metric is scaled
/// by one factor to meet it; without one, and with a distance to the surface, it is made finer where the mesh would be farther ([`Meshed::finer`]). Features are kept if the surface was cut open along them ([`Manifold::cut`]); else borders only.
///
/// With a function of space and a norm the mesh is polished in the end, so that interpolating the function on it has the least error in that norm, as
/// [`mesh_for`](super::mesh_for) does in the plane; the metric is that of the function's second derivatives.
///
/// # Errors
/// The metric is invalid somewhere; the work would exceed the memory limit; there is no valid mesh with the vertices asked for;
/// options that are for the plane; curved triangles of a surface without an equation; the function is not finite at a vertex.
pub fn mesh_surface(
    manifold: &Manifold,
    metric: &dyn SurfaceMetric,
    aim: Option<(&Expression, Norm)>,
    options: &MeshOptions,
    progress: &dyn Progress,
) -> Result<Meshed> {
    options.geodesic.demand_diagrams()?;
    demand_possible_on(manifold, options)?;
    protection::demand_possible(options)?;
    options
        .idle(Task {
            on_surface: true,
            is_drawn: true,
            origin: if aim.is_some() { Origin::Function } else { Origin::Sizes },
            ..Task::default()
        })
        .iter()
        .try_for_each(Idle::demand_unset)?;
    let is_open = options.vertices.is_none() && options.complexity.is_none();
    let asked = options.hausd.filter(|&hausd| is_open && hausd > 0.0);
    let closer = asked.map(|hausd| Closer::new(metric, manifold, hausd)).transpose()?;
    let metric = closer.as_ref().map_or(metric, |closer| closer as &dyn SurfaceMetric);
    let (meetings, watch) = (Meetings::of(manifold.whole_mesh()), Stopwatch::new(progress));
    let (mut logs, mut scale) = (Vec::new(), None);
    let (mut least, mut idle) = (f64::INFINITY, 0);
    for round in 1.. {
        let finer = Finer { field: metric, surface: manifold.surface(), logs: &logs };
        let setting = Setting::new(manifold, &finer, aim, options, &meetings, &watch)?;
        let plan = watch.time("plan", || setting.plan(scale))?;
        let (mut meshed, fidelity) = setting.meshed(plan.count, plan.scale)?;
        let distance = fidelity.as_ref().map_or(0.0, |found| found.both.hausdorff);
        let ratio = options.hausd.map_or(0.0, |most| distance / most.max(f64::MIN_POSITIVE));
        idle += usize::from(least < GAIN * ratio);
        let is_last = options.vertices.is_some() || round == ROUNDS || idle == IDLE_ROUNDS;
        if ratio > 1.0 && is_last {
            let most = options.hausd.unwrap_or_default();
            meshed.notes.push(format!("mesh and surface are {distance:.3e} apart where `hausd` asks for {most:.3e}"));
        }
        if ratio <= 1.0 || is_last {
            watch.time("curve", || curve_onto(&mut meshed, manifold, &meetings, options.order))?;
            let fidelity = if options.order > 1 { setting.fidelity(&meshed.mesh)? } else { fidelity };
            let closed_form_scale = options.vertices.map(|count| closed_form_scale(count, plan.complexity));
            return Ok(Meshed { fidelity, closed_form_scale, finer: logs, seconds: watch.seconds(), ..meshed });
        }
        (least, scale) = (least.min(ratio), Some(plan.scale));
        logs = watch.time("check", || too_far(&meshed.mesh, manifold, &finer, distance / ratio, fidelity.as_ref()))?;
    }
    unreachable!("the last round returns")
}

impl Adaptive for Manifold {
    fn dimension(&self) -> u8 {
        3
    }

    fn mesh_at_time(
        &self,
        function: &Expression,
        time: f64,
        options: &LoopOptions,
        progress: &dyn Progress,
    ) -> Result<(Meshed, Vec<f64>)> {
        let now = function.at_time(time);
        let aim = (!options.metric.is_limiting()).then_some((&now, options.metric.norm));
        let meshed = mesh_by(self, SurfaceSource::Named(&Spec::Hessian(now.clone())), aim, options, progress)?;
        let values = meshed.mesh.points.iter().map(|&[x, y, z]| now.at(x, y, z)).collect();
        Ok((meshed, values))
    }

    fn mesh_for_solution(
        &self,
        solution: Option<(&Mesh, &SolutionValues)>,
        options: &LoopOptions,
        progress: &dyn Progress,
    ) -> Result<Meshed> {
        let solution = solution.map(|(mesh, values)| SurfaceSource::Solution(mesh, values));
        mesh_by(self, solution.unwrap_or(SurfaceSource::Named(&Spec::Uniform)), None, options, progress)
    }
}

fn mesh_by(
    manifold: &Manifold,
    source: SurfaceSource,
    aim: Option<(&Expression, Norm)>,
    options: &LoopOptions,
    progress: &dyn Progress,
) -> Result<Meshed> {
    let metric = metric_on_surface(source, manifold, &options.metric, options.graded_at())?;
    mesh_surface(manifold, metric.as_ref(), aim, &options.mesh, progress)
}

/// The logarithms of factors with which the metric will be fine enough for a distance where the mesh is farther from the surface.
fn too_far(
    mesh: &Mesh,
    manifold: &Manifold,
    finer: &Finer,
    allowed: f64,
    found: Option<&SurfaceFidelity>,
) -> Result<Vec<f64>> {
    let mut distances = distances_around(mesh, manifold);
    if let Some(Deviation { at: Position::Space(at), hausdorff, .. }) = found.map(|found| found.both) {
        for v in manifold.topology().corners(manifold.closest(at.into())?.face) {
            distances[v.index()] = distances[v.index()].max(hausdorff);
        }
    }
    let ratios: Vec<f64> = distances.into_iter().map(|distance| distance / allowed).collect();
    finer.asked(&ratios)
}
