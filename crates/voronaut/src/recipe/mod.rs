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
mod protection;
mod remesh_input;
mod settle;
mod surface_field;
mod surface_coarse;
mod surface_pass;

pub use adapt::{Ground, LoopOptions, Source, Step, adapt};
pub use at_vertices::metric_at_vertices;
pub use certified::{certified_canvas, certified_canvas_on};
pub use dual::{SeedDual, dual, net, surface_dual, surface_mesh, surface_net};
#[cfg(test)]
pub(crate) use field::metric_named;
pub use field::{
    GradedAt, MetricOptions, PlanarMetric, metric, metric_of_field, metric_of_function, metric_of_samples,
    metric_of_solution, metric_of_values,
};
pub use idle::{Idle, Origin, Task};
pub use on_surface::mesh_surface;
pub use options::{Boundary, Centroid, Effort, MeshOptions, Mesher, Seeding};
pub use parts::{Part, mesh_in_parts, mesh_part, mesh_surface_in_parts, mesh_surface_part};
pub use remesh_input::{Asked, Keep, RemeshInput, RemeshSizes};
pub use surface_field::{SurfaceSource, metric_on_surface};

use crate::canvas::{Canvas, CanvasFigures};
use crate::domain::{Domain, paired};
use crate::dual::{Dual, Kind, Moving};
use crate::elementary::Elementary;
use crate::error::Result;
use crate::figures;
use crate::mesh::Mesh;
use crate::metric::nodal::COMPLEXITY_PER_VERTEX;
use crate::metric::{MetricField, Norm, ScalarField, Scaled};
use crate::net::Net;
use crate::optimise::{Patience, Polished, Relaxed, polish};
use crate::parallel::prelude::*;
use crate::progress::Progress;
use crate::quality::{self, SurfaceFidelity, Validity};
use crate::sampling::{Fill, Picking, Plan, Target, demand_memory, refine, refine_protected, simplify};
use crate::surface::Place;
use crate::triangulation::HalfEdge;
use periodic::correspondence;
use settle::Stopwatch;

/// A function is polished for that has at least this share of the error to which it is known.
const KNOWN: f64 = 0.5;
/// What is said of others.
const NOT_KNOWN: &str = "the solution's own mesh is too coarse to polish this one: adapt again with a solution on it";

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
    /// What the metric was made finer by for the sake of the distance to the surface: of a [`Finer`](crate::surface::metric::Finer).
    pub finer: Vec<f64>,
    /// The star set that became the mesh, with [`Mesher::StarSet`].
    pub star_set: Option<figures::StarSet>,
    /// Seconds per stage, in order, by the clock of [`Progress::seconds`].
    pub seconds: Vec<(&'static str, f64)>,
    /// What could not be met, in words for the user; empty when all was.
    pub notes: Vec<String>,
}

/// Seeding starts again with a corrected scale at most so many times.
const ROUNDS: usize = 4;
/// The geometric mean of the free edges' lengths may differ from one by this much before seeding starts again.
const SCALE_TOLERANCE: f64 = 0.04;
/// Seeds put at blocked flips, as a share of all: N is kept within one per cent.
const BLOCKED_SHARE: f64 = 0.005;
/// Seeds exchanged between two halves of the relaxation, as a share of all.
const EXCHANGED_SHARE: f64 = 0.06;

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
    curved::demand_possible(options)?;
    if options.order > 1 {
        return curved::mesh_curved(domain, field, aim, options, progress);
    }
    if options.mesher == Mesher::StarSet {
        return mesher::by_stars(domain, field, options, progress);
    }
    mesh_straight(domain, field, aim, true, options, progress)
}

/// A straight mesh; where it is not settled, its edges are yet to be decided on.
fn mesh_straight(
    domain: &Domain,
    field: &dyn MetricField,
    aim: Option<Aim>,
    settles: bool,
    options: &MeshOptions,
    progress: &dyn Progress,
) -> Result<Meshed> {
    options.geodesic.demand_diagrams()?;
    protection::demand_possible(options)?;
    let watch = Stopwatch::new(progress);
    let mut job = Job::new(field, options, &watch);
    let (plan, count, scale) = watch.time("plan", || job.plan(domain))?;
    let asked = if options.seeding == Seeding::Protected { count } else { options.road().seeds_asked(count) };
    let on_canvas = asked as f64 * f64::from(options.canvas_size);
    demand_memory(count as f64, on_canvas, options.memory_limit)?;
    let canvas = job.canvas(&plan, count)?;
    let mut dual = watch.time("seed", || job.seed(canvas.as_ref(), &plan, count, scale))?;
    let (relaxation, aim) = job.relaxed(&mut dual, canvas.as_ref(), aim.filter(|_| job.may_polish()))?;
    let protected = job.protect(&plan, &mut dual)?;
    // Polishing decides on the edges.
    let settled = if aim.is_none() && settles {
        watch.time("settle", || settle::settle(&mut dual, &plan, job.options, job.progress))?
    } else {
        settle::Settled::default()
    };
    let polished = aim.map(|aim| watch.time("polish", || job.polish(&mut dual, aim))).transpose()?;
    let (mesh, validity) = watch.time("check", || job.finish(&plan, &dual))?;
    let (net, protection) = job.net(&plan, &dual, protected);
    Ok(Meshed {
        mesh,
        validity,
        metric_scale: dual.field().factor,
        closed_form_scale: options.vertices.map(|count| closed_form_scale(count, plan.complexity)),
        dual: settled.dual,
        relaxation,
        polished,
        canvas: job.canvas.or(settled.canvas),
        diagram: job.diagram.or(settled.diagram),
        net,
        protection,
        seconds: watch.seconds(),
        notes: job.notes,
        ..Meshed::default()
    })
}

/// See [`Meshed::closed_form_scale`].
fn closed_form_scale(count: usize, complexity: f64) -> f64 {
    COMPLEXITY_PER_VERTEX * count as f64 / complexity
}

struct Job<'a> {
    field: &'a dyn MetricField,
    options: &'a MeshOptions,
    progress: &'a dyn Progress,
    canvas: Option<CanvasFigures>,
    diagram: Option<figures::Diagram>,
    watch: &'a Stopwatch<'a>,
    /// Whether the seeds come from those of a coarser mesh.
    is_even: bool,
    notes: Vec<String>,
}

impl<'a> Job<'a> {
    fn new(field: &'a dyn MetricField, options: &'a MeshOptions, watch: &'a Stopwatch<'a>) -> Self {
        Self {
            field,
            options,
            progress: watch.progress,
            canvas: None,
            diagram: None,
            watch,
            is_even: false,
            notes: Vec::new(),
        }
    }

    fn target(&self) -> Target {
        match (self.options.vertices, self.options.complexity) {
            (Some(n), _) => Target::Vertices(n),
            (None, Some(c)) => Target::Complexity(c),
            (None, None) => Target::Metric,
        }
    }

    /// The plan of the domain with its curves simplified as allowed, and the count and scale to start from.
    fn plan(&mut self, domain: &Domain) -> Result<(Plan, usize, f64)> {
        self.progress.begin("planning", 1)?;
        let tolerance = self.options.hausd.unwrap_or(domain.pslg().tolerance);
        let (target, limit) = (self.target(), self.options.memory_limit);
        let (whole, of_whole) = paired(domain, &self.options.periodic)?;
        let simplified_at = |factor: f64| {
            let field = Scaled { field: self.field, factor };
            paired(&simplify(&whole, &of_whole, &field, tolerance), &self.options.periodic)
        };
        let stays = target == Target::Metric && tolerance > 0.0;
        let (simplified, pairs) = if stays { simplified_at(1.0)? } else { (whole.clone(), of_whole.clone()) };
        let mut plan = Plan::new(simplified, pairs, self.field, target)?;
        let (mut count, mut scale) = plan.start(target, limit)?;
        if tolerance > 0.0 && !stays {
            // Fewer corners let the metric be finer, and the other way round: two rounds settle it.
            for _ in 0..2 {
                let (simplified, pairs) = simplified_at(scale)?;
                plan = plan.again(simplified, pairs, self.field, target)?;
                (count, scale) = plan.start(target, limit)?;
            }
        }
        if plan.corners() > count && self.options.vertices.is_some() {
            let (count, corners) = (count - plan.copies(), plan.corners() - plan.copies());
            self.notes.push(format!(
                "{count} vertices were asked for, but the domain's own corners are {corners}: simplify with `hausd`"
            ));
        }
        Ok((plan, count, scale))
    }

    /// A count that was asked for is met exactly; one that follows from the metric is an estimate.
    fn fill(&self, count: usize) -> Fill {
        if self.options.vertices.is_some() { Fill::Exactly(count) } else { Fill::AtMost(count) }
    }

    /// Seeds the domain with `count` vertices; the scale follows from what the seeds' distances turn out to be. Where
    /// the scale is given, the count follows instead.
    fn seed(&mut self, canvas: Option<&Canvas>, plan: &Plan, mut count: usize, mut scale: f64) -> Result<Dual<'a>> {
        for round in 1.. {
            self.progress.begin("seeding", count as u64)?;
            let (mut dual, is_even) = self.begun(plan, count, scale)?;
            self.is_even = is_even;
            if let Some(canvas) = canvas.filter(|_| self.options.seeding == Seeding::Farthest) {
                self.seed_farthest(canvas, &mut dual, count)?;
            }
            self.refine(&mut dual, count)?;
            dual.verdict()?;
            let mean = mean_free_edge(&dual);
            if round == ROUNDS || (mean - 1.0).abs() < SCALE_TOLERANCE {
                self.note_shortfall(&dual, plan, count);
                return Ok(dual);
            }
            if self.options.vertices.is_some() {
                scale /= mean * mean;
            } else {
                // One round corrects by a factor of two at most: a mean over few edges can be far off.
                count = ((count as f64) * (mean * mean).clamp(0.5, 2.0)).round() as usize;
            }
            let too_many = |scale| plan.boundary_vertices(scale) > count.max(plan.corners()) as f64;
            while self.options.vertices.is_some() && too_many(scale) {
                scale *= 0.98;
            }
        }
        unreachable!("the last round returns")
    }

    /// Fills the interior. Places are picked for protection only if no relaxation is going to move the seeds.
    fn refine(&self, dual: &mut Dual, count: usize) -> Result<()> {
        let (fill, options) = (self.fill(count), self.options);
        if options.seeding == Seeding::Protected && options.lloyd == 0 {
            let picking = Picking { protection: options.protection, radius: options.picking_radius };
            refine_protected(dual, fill, picking, self.progress)?;
        } else {
            refine(dual, fill, self.progress)?;
        }
        Ok(())
    }

    fn note_shortfall(&mut self, dual: &Dual, plan: &Plan, count: usize) {
        let got = dual.vertex_count();
        if self.options.vertices.is_some() && got < count {
            let (got, count) = (got - plan.copies(), count - plan.copies());
            self.notes.push(format!("{count} vertices were asked for, but rounding leaves room for {got} only"));
        }
    }

    /// With a count given, the factor is the one for which free edges have unit length in the (geometric) mean. The metric is
    /// measured anew at every seed.
    fn fit_scale(&self, dual: &mut Dual) {
        if self.options.vertices.is_some() {
            let mean = mean_free_edge(dual);
            dual.rescale(dual.field().factor / (mean * mean));
        } else {
            dual.measure_all();
        }
    }

    /// Relaxes, only roughly where polishing follows; and what it is polished for.
    fn relaxed<'b>(
        &mut self,
        dual: &mut Dual,
        canvas: Option<&Canvas>,
        aim: Option<Aim<'b>>,
    ) -> Result<(Relaxed, Option<Aim<'b>>)> {
        let (effort, watch) = (self.options.effort, self.watch);
        let relax = |dual: &mut Dual, job: &Self, effort| watch.time("relax", || job.relax(dual, canvas, effort));
        let Some(aim) = aim else { return Ok((relax(dual, self, effort)?, None)) };
        let mut relaxed = relax(dual, self, effort.before_polishing())?;
        if self.is_known(dual, aim)? {
            return Ok((relaxed, Some(aim)));
        }
        relaxed.append(relax(dual, self, effort)?);
        Ok((relaxed, None))
    }

    /// Whether meshes may be polished: not where protection was asked for, which it would undo.
    fn may_polish(&self) -> bool {
        self.options.polish > 0 && self.options.seeding != Seeding::Protected
    }

    /// Whether there is something to gain, and the function is known well enough for it.
    fn is_known(&mut self, dual: &mut Dual, aim: Aim) -> Result<bool> {
        let now = polish(dual, aim.function, aim.norm, Patience::NONE, self.progress)?;
        let Some(&error) = now.error.first() else { return Ok(false) };
        if error < KNOWN * aim.known_to {
            self.notes.push(NOT_KNOWN.into());
            return Ok(false);
        }
        Ok(true)
    }

    fn polish(&self, dual: &mut Dual, aim: Aim) -> Result<Polished> {
        let sweeps = self.options.polish;
        let patience = Patience { steps: sweeps, gain: self.options.effort.gain_of_polishing() };
        self.progress.begin("polishing", sweeps as u64)?;
        polish(dual, aim.function, aim.norm, patience, self.progress)
    }

    fn finish(&self, plan: &Plan, dual: &Dual) -> Result<(Mesh, Validity)> {
        self.progress.begin("checking", 1)?;
        self.progress.sketch(&|| dual.sketch());
        let mut mesh = dual.to_mesh(&plan.domain);
        mesh.periodic = correspondence(&mesh, plan)?;
        let validity = quality::validity(&mesh);
        validity.demand()?;
        Ok((mesh, validity))
    }
}

/// Geometric mean of the metric lengths of the edges that touch no constraint. Where there are next to none (channels
/// narrower than a unit) the median of all edges, which is that of the edges along the channel.
fn mean_free_edge(dual: &Dual) -> f64 {
    let topology = dual.topology();
    let is_free = |v| dual.kind(v) == Kind::Free;
    let edges: Vec<HalfEdge> = topology.edges().collect();
    let logarithm = |&h: &HalfEdge| dual.edge_length(h).max(f64::MIN_POSITIVE).logarithm();
    let mut all: Vec<f64> = edges.par_iter().with_min_len(1024).map(logarithm).collect();
    let free = edges.iter().zip(&all).filter(|(h, _)| topology.ends(**h).into_iter().all(is_free));
    let free: Vec<f64> = free.map(|(_, &logarithm)| logarithm).collect();
    if 20 * free.len() > all.len() {
        return (free.iter().sum::<f64>() / free.len() as f64).exponential();
    }
    all.sort_by(f64::total_cmp);
    all[all.len() / 2].exponential()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Point, Tensor};
    use crate::progress::Silent;
    use crate::test_cases::plate;

    fn meshed(domain: &Domain, vertices: Option<usize>) -> Meshed {
        let options = MeshOptions { vertices, ..MeshOptions::default() };
        mesh(domain, &|_: Point| Tensor::isotropic(0.01), &options, &Silent).unwrap()
    }

    #[test]
    fn holes_that_touch_cost_no_vertex() {
        // They share a corner.
        let holes =
            [&[[1.0, 2.0], [1.5, 1.5], [2.0, 2.0], [1.5, 2.5]], &[[2.0, 2.0], [2.5, 1.5], [3.0, 2.0], [2.5, 2.5]]];
        let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
        let domain = plate(&[&square, holes[0], holes[1]]);
        assert_eq!(meshed(&domain, Some(200)).mesh.points.len(), 200);
    }

    #[test]
    fn a_metric_that_is_used_as_it_is_is_not_scaled() {
        let strip = Domain::shape("rect:0,0,1,1e-3").unwrap();
        assert_eq!(meshed(&strip, None).metric_scale.to_bits(), 1.0_f64.to_bits());
    }
}
