//! Seeds from those of coarser meshes, which are relaxed and whose edges are then halved: few seeds are put one by one, and what is far
//! apart is even from the start. (Two grids: Hateley, Wei and Chen 2015.)

use super::MeshOptions;
use super::options::{Centroid, Seeding};
use super::plane::Job;
use crate::dual::{Dual, Moving};
use crate::error::Result;
use crate::geodesic::LocalMetric;
use crate::metric::Scaled;
use crate::optimise::{Cells, Patience};
use crate::parallel::prelude::*;
use crate::progress::{Progress, Within};
use crate::sampling::{Fill, Plan, refine, sample_segments};
use crate::triangulation::VertexId;

/// The coarsest mesh has at least so many vertices. Meshes of less than four times as many get better, too (3,000 of one size: mean quality
/// 0.983 for 0.977), but take as long or longer.
const COARSEST: f64 = 2000.0;
/// A coarser mesh has at most this share of the vertices: else most of both are corners of the domain.
pub(super) const PAYS: f64 = 0.5;
/// The share of a coarser mesh's seeds at which the metric may be rough. With more, seeds are dense in the wrong places: 100,000 for front
/// and layer, whose coarser mesh has 0.06 to 0.13, have 1.5 % unit edges less and an error greater by 1.5 %.
const ROUGH: f64 = 0.05;
/// The same of one that is not relaxed before its edges are halved. 100,000 for that front and layer, without `polish`, take 0.92 of the time, with an error
/// lower by 0.3 %; with shares of 0.2 to 0.35 unit edges are 0.02 to 0.6 % fewer.
const HALF_KNOWN: f64 = 0.2;
/// How a coarser mesh is relaxed, in how many parts.
pub(super) const PATIENCE: Patience = Patience { steps: 20, gain: 2e-3 };
const PARTS: usize = 2;
/// Edges that are longer are halved: both halves are then nearer to one, by ratio.
const LONG: f64 = std::f64::consts::SQRT_2;

impl<'a> Job<'a> {
    /// A dual whose segments are sampled, with the seeds of coarser meshes where the metric lets these be made; and whether it has such.
    pub(super) fn begun(&self, plan: &Plan, count: usize, scale: f64) -> Result<(Dual<'a>, bool)> {
        let counts = self.counts(plan, count, scale);
        let (level, mut dual) = self.coarsest(plan, scale, &counts)?;
        let progress: &dyn Progress = &Within(self.progress);
        for finer in (0..level).rev() {
            let before = dual.vertex_count();
            dual = self.filled(dual, counts[finer])?;
            dual.reorder();
            self.relax_in_parts(&mut dual, &Cells::Tangent, PARTS, PATIENCE, progress)?;
            dual.rescale(factor(scale, finer));
            let most = counts[finer].saturating_sub(dual.vertex_count());
            dual.halve_longer(LONG, most);
            dual.verdict()?;
            self.progress.advance((dual.vertex_count() - before) as u64)?;
        }
        Ok((dual, level > 0))
    }

    /// The numbers of vertices of this mesh and of those that are coarser, each by two in length; this one alone where none is of use.
    fn counts(&self, plan: &Plan, count: usize, scale: f64) -> Vec<usize> {
        let mut counts = vec![count];
        let MeshOptions { seeding, centroid, lloyd, .. } = *self.options;
        if seeding != Seeding::Sizing || centroid != Centroid::Tangent || lloyd == 0 || !plan.pairs.is_empty() {
            return counts;
        }
        let expected = |level| plan.expected_vertices(factor(scale, level));
        for level in 1.. {
            let coarser = count as f64 * (expected(level) / expected(0));
            if coarser < COARSEST || coarser > PAYS * counts[level - 1] as f64 {
                break;
            }
            counts.push(coarser as usize);
        }
        counts
    }

    /// The coarsest level whose mesh resolves the metric, as far as the seeds of the last one tell: these are as dense, by the metric, as
    /// those of any other. And its dual, whose segments are sampled, with seeds if a coarser level has an idea of the metric.
    fn coarsest(&self, plan: &Plan, scale: f64, counts: &[usize]) -> Result<(usize, Dual<'a>)> {
        let last = counts.len() - 1;
        let probe = self.sampled(plan, scale, last)?;
        if last == 0 {
            return Ok((0, probe));
        }
        let probe = self.filled(probe, counts[last - 1])?;
        let seeds: Vec<VertexId> = probe.topology().vertices().collect();
        let rough = |level: usize| {
            let field = Scaled { field: self.field, factor: factor(scale, level) };
            let is_rough =
                |&v: &VertexId| LocalMetric::at_near(&field, probe.position(v), probe.local(v).near).is_rough;
            let rough = seeds.par_iter().with_min_len(256).filter(|v| is_rough(v)).count();
            rough as f64 / seeds.len() as f64
        };
        let shares: Vec<f64> = (1..=last).map(rough).collect();
        let at_most = |most: f64| (1..=last).rev().find(|&level| shares[level - 1] <= most).unwrap_or(0);
        let (level, first) = (at_most(ROUGH), at_most(HALF_KNOWN));
        let mut dual = if first == last { probe } else { self.sampled(plan, scale, first)? };
        if level < first && first < last {
            dual = self.filled(dual, counts[first - 1])?;
        }
        for finer in (level..first).rev() {
            dual.rescale(factor(scale, finer));
            let most = if finer > 0 { before_halving(&dual, counts[finer - 1]) } else { counts[0] };
            let room = most.saturating_sub(dual.vertex_count());
            dual.halve_longer(LONG, room);
        }
        Ok((level, dual))
    }

    /// With seeds, one by one, as many as there may be if they are so many when edges are halved.
    fn filled(&self, mut dual: Dual<'a>, finer: usize) -> Result<Dual<'a>> {
        let fill = Fill::AtMost(before_halving(&dual, finer));
        refine(&mut dual, fill, &Within(self.progress))?;
        Ok(dual)
    }

    fn sampled(&self, plan: &Plan, scale: f64, level: usize) -> Result<Dual<'a>> {
        let mut dual = Dual::new(plan.domain.corners(), Scaled { field: self.field, factor: factor(scale, level) })?;
        sample_segments(&mut dual, &plan.edges, &plan.arcs, scale, level as u32);
        Ok(dual)
    }
}

/// The factor on the metric of a mesh so many levels coarser.
pub(super) fn factor(scale: f64, level: usize) -> f64 {
    scale * 0.25_f64.powi(level.try_into().unwrap_or(i32::MAX))
}

/// How many vertices there may be for there to be so many when all edges are halved, but those on segments that are short enough: each new
/// seed brings three edges.
fn before_halving(dual: &Dual, finer: usize) -> usize {
    let topology = dual.topology();
    let halved = topology.edges().filter(|&h| !topology.is_fixed(h) || dual.edge_length(h) > 0.5 * LONG).count();
    let now = dual.vertex_count();
    now + finer.saturating_sub(now + halved) / 4
}

#[cfg(test)]
mod tests {
    use super::super::plane::Case;
    use super::super::stopwatch::Stopwatch;
    use super::*;
    use crate::geometry::{Point, Tensor};
    use crate::manifold::domain::Domain;
    use crate::metric::{MetricField, Shock};
    use crate::progress::Silent;
    use crate::sampling::Target;
    use crate::test_cases::plate;

    /// The level that a mesh of so many vertices starts from, and how many vertices come of it.
    fn level(domain: &Domain, field: &dyn MetricField, count: usize) -> (usize, usize) {
        let (options, watch) = (MeshOptions::default(), Stopwatch::new(&Silent));
        let job = Job::new(&Case { domain, field, aim: None, options: &options, progress: &Silent }, &watch);
        let plan = Plan::new(domain.clone(), Vec::new(), field, Target::Vertices(count)).unwrap();
        let scale = plan.scale_for(count as f64);
        let counts = job.counts(&plan, count, scale);
        let (level, _) = job.coarsest(&plan, scale, &counts).unwrap();
        let (dual, is_even) = job.begun(&plan, count, scale).unwrap();
        assert_eq!(is_even, level > 0);
        assert!(dual.planar().is_embedded());
        (level, dual.vertex_count())
    }

    #[test]
    fn halved_meshes_have_next_to_all_vertices() {
        let square = Domain::shape("rect:0,0,1,1").unwrap();
        let graded = |p: Point| Tensor::new(4.0, 1.0, 1.0) * (1.0 + p.y);
        for (count, levels) in [(7_000, 0), (9_000, 1), (36_000, 2)] {
            let (level, got) = level(&square, &graded, count);
            assert_eq!(level, levels, "{count}");
            assert!(level == 0 || (0.97 * count as f64..=count as f64).contains(&(got as f64)), "{got} of {count}");
        }
    }

    #[test]
    fn what_a_coarser_mesh_does_not_resolve_is_seeded_directly() {
        let square = Domain::shape("rect:-1,-1,1,1").unwrap();
        assert_eq!(level(&square, &Shock { phi: 10.0, lambda: 0.06 }, 9_000).0, 0);
        // Most vertices are corners.
        let corner = |i: usize| {
            let (sine, cosine) = (std::f64::consts::TAU * i as f64 / 6_000.0).sin_cos();
            [cosine, sine]
        };
        let disc = plate(&[&(0..6_000).map(corner).collect::<Vec<_>>()]);
        assert_eq!(level(&disc, &|_: Point| Tensor::IDENTITY, 10_000).0, 0);
    }
}
