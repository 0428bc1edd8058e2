//! The steps of a straight mesh in the plane.

use super::periodic::correspondence;
use super::plane::{Case, Job};
use super::stopwatch::Stopwatch;
use super::{Aim, Meshed, Mesher, Seeding, closed_form_scale, curved, mesher, protection, settle};
use crate::canvas::Canvas;
use crate::dual::{Dual, Kind, Moving};
use crate::elementary::Elementary;
use crate::error::Result;
use crate::manifold::domain::{Pslg, paired};
use crate::mesh::Mesh;
use crate::metric::Scaled;
use crate::optimise::{Patience, Polished, Relaxed, polish};
use crate::parallel::prelude::*;
use crate::quality::{self, Validity};
use crate::sampling::{Picking, Plan, Target, demand_memory, refine, refine_protected, simplify};
use crate::triangulation::HalfEdge;

/// A function is polished for that has at least this share of the error to which it is known.
const KNOWN: f64 = 0.5;
/// What is said of others.
const NOT_KNOWN: &str = "the solution's own mesh is too coarse to polish this one: adapt again with a solution on it";

/// Seeding starts again with a corrected scale at most so many times.
const ROUNDS: usize = 4;
/// The geometric mean of the free edges' lengths may differ from one by this much before seeding starts again.
const SCALE_TOLERANCE: f64 = 0.04;
impl Case<'_> {
    /// By the mesher, and with the order of triangles, that is asked for.
    ///
    /// # Errors
    /// As for [`mesh_for`].
    pub(super) fn mesh(&self) -> Result<Meshed> {
        curved::demand_possible(self.options)?;
        if self.options.order > 1 {
            return curved::mesh_curved(self);
        }
        if self.options.mesher == Mesher::StarSet {
            return mesher::by_stars(self);
        }
        self.mesh_straight(true)
    }

    /// A straight mesh; where it is not settled, its edges are yet to be decided on.
    pub(super) fn mesh_straight(&self, settles: bool) -> Result<Meshed> {
        let Self { aim, options, progress, .. } = *self;
        options.geodesic.demand_diagrams()?;
        protection::demand_possible(options)?;
        let watch = Stopwatch::new(progress);
        let mut job = Job::new(self, &watch);
        let (plan, count, scale) = watch.time("plan", || job.plan())?;
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
}

impl<'a> Job<'a> {
    /// The plan of the domain with its curves simplified as allowed, and the count and scale to start from.
    pub(super) fn plan(&mut self) -> Result<(Plan, usize, f64)> {
        self.progress.begin("planning", 1)?;
        let tolerance = self.options.hausd.unwrap_or(self.domain.pslg().tolerance);
        let (target, limit) = (self.target(), self.options.memory_limit);
        let (whole, of_whole) = paired(self.domain, &self.options.periodic)?;
        let simplified_at = |factor: f64| {
            let field = Scaled { field: self.field, factor };
            let simplified = simplify(whole.pslg(), &of_whole, &field, tolerance, Pslg::validated);
            paired(simplified.as_ref().unwrap_or(&whole), &self.options.periodic)
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

    /// Seeds the domain with `count` vertices; the scale follows from what the seeds' distances turn out to be. Where
    /// the scale is given, the count follows instead.
    pub(super) fn seed(
        &mut self,
        canvas: Option<&Canvas>,
        plan: &Plan,
        mut count: usize,
        mut scale: f64,
    ) -> Result<Dual<'a>> {
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
    pub(super) fn fit_scale(&self, dual: &mut Dual) {
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
        let mut mesh = plan.mesh(dual);
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
    use super::super::{MeshOptions, mesh};
    use super::*;
    use crate::geometry::{Point, Tensor};
    use crate::manifold::domain::Domain;
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
