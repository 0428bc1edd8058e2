//! Which mesher; and the local Delaunay algorithm as one (RR-9103, section 7.1), to compare.

use super::plane::{Case, Job};
use super::stopwatch::Stopwatch;
use super::{MeshOptions, Meshed};
use crate::canvas::{Consistency, NEEDS_MORE, UNIT_RADIUS, consistent};
use crate::dual::{Dual, Kind, Moving};
use crate::error::{Error, Result};
use crate::figures;
use crate::metric::{Scaled, Steadied};
use crate::optimise::Relaxed;
use crate::quality;
use crate::sampling::{Plan, demand_memory};
use crate::triangulation::VertexId;

/// The metric turns by about so much over a unit of the sampling: the first with which stars come to agree.
const TURNS: [f64; 5] = [1.4, 1.2, 1.0, 0.7, 0.5];
/// Steps of relaxation of such a sampling, at most: vertices are moved after it, for another reason.
const LLOYD: usize = 10;
/// Stars are given up when they have so many times the vertices of a unit mesh, and [`SPARE`].
const MOST: usize = 10;
/// Vertices more, for coarse meshes of intricate domains.
const SPARE: usize = 1000;

/// Meshes a domain by consistent star sets: relaxed seeds, those of the other mesher first, then denser and denser where the
/// metric turns, moved and refined until their stars agree.
///
/// # Errors
/// As for [`super::mesh`], and where stars do not come to agree or are no valid mesh.
pub(super) fn by_stars(case: &Case) -> Result<Meshed> {
    let (options, watch) = (case.options, Stopwatch::new(case.progress));
    let mut job = Job::new(case, &watch);
    let start = sampled(&mut job, None)?;
    let (scaled, unit) = (*start.dual.field(), start.dual.vertex_count());
    let mut meshed = agreed(&mut job, &start, &scaled, unit);
    for most in TURNS {
        if !matches!(meshed, Err(Error::Limit { .. })) {
            break;
        }
        let steadied = Steadied { field: &scaled, most };
        let lloyd = options.lloyd.min(LLOYD);
        let as_it_is = MeshOptions { vertices: None, complexity: None, lloyd, ..options.clone() };
        let case = Case { field: &steadied, options: &as_it_is, ..*case };
        let mut steady = Job { notes: job.notes, ..Job::new(&case, &watch) };
        let start = sampled(&mut steady, Some(unit))?;
        meshed = agreed(&mut steady, &start, &scaled, unit);
        job.notes = steady.notes;
    }
    let mut meshed = meshed?;
    let got = meshed.mesh.points.len();
    if let Some(asked) = options.vertices.filter(|&asked| asked != got) {
        job.notes.push(format!("{asked} vertices set the scale of the metric; stars that agree took {got}"));
    }
    (meshed.seconds, meshed.notes) = (watch.seconds(), job.notes);
    Ok(meshed)
}

/// What stars are refined from.
struct Start<'a> {
    plan: Plan,
    dual: Dual<'a>,
    relaxation: Relaxed,
}

/// Relaxed seeds; where the size of a unit mesh is given, an error if they are too many beside that.
fn sampled<'a>(job: &mut Job<'a>, unit: Option<usize>) -> Result<Start<'a>> {
    let (plan, count, scale) = job.watch.time("plan", || job.plan())?;
    let unit = unit.unwrap_or(count);
    if count > most(unit) {
        let what = format!("stars need about {count} vertices to agree, where a unit mesh has {unit}");
        return Err(Error::limit(what, NEEDS_MORE));
    }
    demand_memory(count as f64, most(unit) as f64, job.options.memory_limit)?;
    let mut dual = job.watch.time("seed", || job.seed(None, &plan, count, scale))?;
    let relaxation = job.watch.time("relax", || job.relax(&mut dual, None, job.options.effort))?;
    Ok(Start { plan, dual, relaxation })
}

fn most(unit: usize) -> usize {
    MOST * unit + SPARE
}

/// Moves and refines until stars agree.
fn agreed(job: &mut Job, start: &Start, scaled: &Scaled, unit: usize) -> Result<Meshed> {
    job.progress.begin("stars", 1)?;
    let asked = Consistency { radius: UNIT_RADIUS, most: most(unit) };
    let found = job.watch.time("stars", || consistent(start.dual.planar().clone(), scaled, asked))?;
    job.progress.begin("checking", 1)?;
    let mesh = start.plan.domain.mesh_of(&found.planar, |v| corner(&start.dual, v));
    let validity = job.watch.time("check", || quality::validity(&mesh));
    validity.demand()?;
    Ok(Meshed {
        mesh,
        validity,
        metric_scale: scaled.factor,
        relaxation: start.relaxation.clone(),
        star_set: Some(figures::StarSet { figures: found.figures, counters: found.counters }),
        ..Meshed::default()
    })
}

/// The point of the domain's graph that a vertex is, if it was one before the stars were refined.
fn corner(dual: &Dual, v: VertexId) -> Option<u32> {
    match (v.index() < dual.planar().positions.len()).then(|| dual.kind(v)) {
        Some(Kind::Corner(point)) => Some(point),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Point, Tensor, Vector};
    use crate::manifold::domain::Domain;
    use crate::metric::{MetricField, Shock, Uniform};
    use crate::progress::Silent;
    use crate::recipe;
    use crate::recipe::Mesher;

    fn mesh(domain: &str, field: &dyn MetricField, vertices: usize) -> Result<Meshed> {
        let options = MeshOptions { mesher: Mesher::StarSet, vertices: Some(vertices), ..MeshOptions::default() };
        recipe::mesh(&Domain::shape(domain).unwrap(), field, &options, &Silent)
    }

    #[test]
    fn stars_that_agree_are_a_valid_mesh() {
        let uniform = Uniform(Tensor::new(30.0, 5.0, 1.0));
        let gentle = |p: Point| Tensor::new(4.0 + 0.5 * p.x, 0.3 * p.y, 1.0 + 0.5 * p.y * p.y);
        for (domain, field) in [("rect:0,0,2,1", &uniform as &dyn MetricField), ("rect:0,0,2,1", &gentle)] {
            let meshed = mesh(domain, field, 300).unwrap();
            let found = meshed.star_set.unwrap();
            let vertices = meshed.mesh.points.len();
            assert!(found.figures.inconsistencies == 0 && found.figures.radius <= UNIT_RADIUS, "{found:?}");
            assert_eq!((found.figures.vertices, found.figures.unsettled), (vertices, 0));
            assert_eq!(found.figures.simplices, meshed.mesh.triangles.len());
            assert!(quality::validity(&meshed.mesh).area > 1.999 && (300..400).contains(&vertices), "{vertices}");
        }
    }

    #[test]
    fn where_the_metric_turns_seeds_are_denser_and_stages_are_told_once() {
        // Cells that are three times as long as wide, along a direction that turns by three radians over the domain.
        let turning = |p: Point| Tensor::from_axis(Vector::new((1.5 * p.x).cos(), (1.5 * p.x).sin()), 1.0, 9.0);
        let meshed = mesh("rect:0,0,2,1", &turning, 100).unwrap();
        let vertices = meshed.mesh.points.len();
        assert!(meshed.star_set.unwrap().figures.inconsistencies == 0 && (100..1000).contains(&vertices), "{vertices}");
        let stages: Vec<&str> = meshed.seconds.iter().map(|stage| stage.0).collect();
        assert_eq!(stages, ["plan", "seed", "relax", "stars", "check"]);
        let expected = format!("100 vertices set the scale of the metric; stars that agree took {vertices}");
        assert_eq!(meshed.notes, [expected]);
    }

    #[test]
    fn stars_that_do_not_come_to_agree_are_an_error_with_an_estimate() {
        let error = mesh("rect:-1,-1,1,1", &Shock { phi: 10.0, lambda: 0.6 }, 100).unwrap_err();
        assert!(error.to_string().contains(": stars need about "), "{error}");
        assert!(error.to_string().ends_with(" vertices to agree, where a unit mesh has 100"), "{error}");
        assert!(error.help().contains("`mesher=voronoi`"), "{}", error.help());
    }
}
