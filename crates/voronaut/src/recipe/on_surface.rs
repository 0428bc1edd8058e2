//! The main job on a surface, and the dual of seeds on it.

use super::dual::{SeedDual, account, compared, left_out};
use super::stopwatch::Stopwatch;
use super::{MeshOptions, Meshed, Mesher, Seeding};
use crate::canvas::{Canvas, CanvasFigures, Draped, Kind};
use crate::diagram::SurfaceDiagram;
use crate::dual::{Road, SurfaceDual};
use crate::error::{Error, Result};
use crate::geodesic::Method;
use crate::geometry::{Point3, Tensor3};
use crate::mesh::Mesh;
use crate::optimise::{FitOptions, Relaxed, Tangent, fit, mend_worst, relax};
use crate::output::report;
use crate::progress::Progress;
use crate::quality::{self, SurfaceFidelity};
use crate::rdt::{OnSurface, Rdt, Start};
use crate::sampling::{demand_memory, seed_surface, surface_triangulation};
use crate::surface::metric::{Constant, SurfaceMetric};
use crate::surface::{Implicit, Input, Place, Surface};
use crate::triangulation::{Triangulation, VertexId};
use std::time::Instant;

/// Vertices of the canvas on which the surface is measured first.
const MEASURING: usize = 20_000;
/// Relaxation goes in so many parts, the factor on the metric made fit between them.
const PARTS: usize = 4;
/// Rounds of more vertices for the sake of the distance to the surface at most, and how many times as many at most in one.
const ROUNDS: usize = 5;
const MOST_MORE: f64 = 3.0;
/// A round that brings the distance down by less than this factor is the last: facets of the surface, not the number of
/// vertices, keep it up.
const GAIN: f64 = 1.2;
/// Triangles that are mended in the end, as a share of all, and how often.
const MENDED_SHARE: f64 = 0.02;
const MENDINGS: usize = 3;

/// Meshes a surface by a metric: farthest points on its canvas, relaxed in charts, edges settled by geodesics on the canvas.
/// Vertices are on the surface. With a number of vertices asked for the metric is scaled by one factor to meet it.
///
/// # Errors
/// The metric is invalid somewhere; the work would exceed the memory limit; cells cannot be made discs with the vertices
/// asked for; options that are for the plane.
pub fn mesh_surface(
    input: &Input,
    metric: &dyn SurfaceMetric,
    options: &MeshOptions,
    progress: &dyn Progress,
) -> Result<Meshed> {
    demand_supported(options)?;
    let mut job = Job { input, metric, options, progress, watch: Stopwatch::default() };
    let (mut count, mut scale) = job.timed("plan", Job::plan)?;
    let mut last = f64::INFINITY;
    for round in 1.. {
        let (mut meshed, fidelity) = job.meshed(count, scale)?;
        let distance = fidelity.as_ref().map_or(0.0, |found| found.both.hausdorff);
        let ratio = options.hausd.map_or(0.0, |most| distance / most.max(f64::MIN_POSITIVE));
        let is_last = options.vertices.is_some() || round == ROUNDS || last < GAIN * ratio;
        if ratio > 1.0 && is_last {
            let most = options.hausd.unwrap_or_default();
            meshed.notes.push(format!("mesh and surface are {distance:.3e} apart where --hausd asks for {most:.3e}"));
        }
        if ratio <= 1.0 || is_last {
            return Ok(Meshed { fidelity, seconds: job.watch.seconds, ..meshed });
        }
        last = ratio;
        // Distances fall with the square of the edges: with the number of vertices.
        let more = (1.1 * ratio).min(MOST_MORE);
        (count, scale) = ((count as f64 * more).ceil() as usize, scale * more);
        demand_memory(count as f64, job.canvas_size(count) as f64, options.memory_limit)?;
    }
    unreachable!("the last round returns")
}

/// The dual of a diagram's seeds on a surface, by the road that is asked for; see [`super::dual()`].
pub fn surface_dual(diagram: &SurfaceDiagram, road: Road) -> SeedDual {
    let start = Instant::now();
    let nerve = diagram.sharp_nerve();
    let nerve_seconds = start.elapsed().as_secs_f64();
    let (glued, copies) = diagram.glued_nerve();
    let rdt = Rdt::from_glued(OnSurface::new(diagram), diagram.colours(), glued, &copies);
    let seconds = vec![("nerve", nerve_seconds), ("tests", start.elapsed().as_secs_f64() - nerve_seconds)];
    let triangles = match road {
        Road::Canvas => nerve.triangles.iter().map(|t| t.colours).collect(),
        Road::Geodesic => rdt.triangles(),
        Road::Both => rdt.triangles().into_iter().chain(left_out(&rdt, &nerve)).collect(),
    };
    let account = account(&rdt, &nerve, road);
    let exact = rdt.triangles();
    let raw_nerve = compared(diagram, &exact);
    SeedDual { triangles, nerve, exact, raw_nerve, account, seconds }
}

/// Triangles of seeds on a surface as a mesh: vertex i is seed i, with the region labels of the surface.
pub fn surface_mesh(input: &Input, places: &[Place], triangles: Vec<[u32; 3]>) -> Mesh {
    let topology = input.surface.topology();
    let label = |t: &[u32; 3]| {
        let corners = t.map(|v| places[v as usize].position);
        let middle = Point3::weighted(corners, [1.0 / 3.0; 3]);
        let place = input.lift(&places[t[0] as usize], middle).unwrap_or(places[t[0] as usize]);
        topology.region(place.face)
    };
    Mesh {
        points: places.iter().map(|place| place.position.to_array()).collect(),
        point_labels: vec![0; places.len()],
        triangle_labels: triangles.iter().map(label).collect(),
        triangles,
        ..Mesh::default()
    }
}

fn demand_supported(options: &MeshOptions) -> Result<()> {
    options.geodesic.demand_diagrams()?;
    let planar = if options.mesher == Mesher::StarSet {
        Some("the star-set mesher")
    } else if options.seeding == Seeding::Protected {
        Some("protected seeding")
    } else {
        None
    };
    planar.map_or(Ok(()), |what| {
        let help = "leave the option out: surfaces are seeded by farthest points".into();
        Err(Error::Unsupported { what: format!("{what} on a surface"), help })
    })
}

struct Job<'a> {
    input: &'a Input,
    metric: &'a dyn SurfaceMetric,
    options: &'a MeshOptions,
    progress: &'a dyn Progress,
    watch: Stopwatch,
}

/// What came of the last pass.
struct Settled {
    account: report::Dual,
    figures: CanvasFigures,
    diagram: report::Diagram,
    /// Of an equation's surface that is to be fitted, the canvas.
    fine: Option<Surface>,
}

impl<'a> Job<'a> {
    fn timed<T>(&mut self, stage: &'static str, work: impl FnOnce(&mut Self) -> T) -> T {
        let start = Instant::now();
        let result = work(self);
        self.watch.add(stage, start);
        result
    }

    /// A mesh with so many vertices, and how far it is from the surface, if that is asked for.
    fn meshed(&mut self, count: usize, scale: f64) -> Result<(Meshed, Option<SurfaceFidelity>)> {
        let canvas = self.timed("canvas", |job| job.canvas(count, &[]))?.0;
        let seeded = self.timed("seed", |job| {
            job.progress.stage("seeding", count as u64);
            seed_surface(&canvas, count, 1.0 / scale.sqrt(), job.options.geodesic, job.progress)
        })?;
        let (mut dual, relaxation) = self.timed("relax", |job| job.relaxed(&canvas, &seeded.dual, scale))?;
        let settled = self.timed("settle", |job| job.settle(&mut dual))?;
        let mut notes = Vec::new();
        if seeded.added > 0 {
            notes.push(format!("{} vertices were added where cells were no discs or met twice", seeded.added));
        }
        let mesh = self.timed("check", |job| job.finish(&dual))?;
        let mesh = self.timed("fit", |job| job.fitted(mesh, settled.fine.as_ref(), &mut notes))?;
        let fidelity = self.timed("check", |job| job.fidelity(&mesh))?;
        let meshed = Meshed {
            mesh,
            metric_scale: dual.factor(),
            dual: settled.account,
            relaxation,
            canvas: Some(settled.figures),
            diagram: Some(settled.diagram),
            notes,
            ..Meshed::default()
        };
        Ok((meshed, fidelity))
    }

    /// The mesh with its vertices at least-squares positions, if that is asked for; as it was where that would not be valid.
    fn fitted(&self, mesh: Mesh, fine: Option<&Surface>, notes: &mut Vec<String>) -> Result<Mesh> {
        if !self.options.fit {
            return Ok(mesh);
        }
        self.progress.stage("fitting", 1);
        let fitted = fit(&mesh, fine.unwrap_or(&self.input.surface), &FitOptions::default())?.mesh;
        if quality::check(&fitted).is_ok() {
            return Ok(fitted);
        }
        notes.push("vertices are on the surface: least-squares positions would not make a valid mesh".into());
        Ok(mesh)
    }

    fn fidelity(&self, mesh: &Mesh) -> Result<Option<SurfaceFidelity>> {
        if self.options.hausd.is_none() && !self.options.fit {
            return Ok(None);
        }
        let implicit = self.input.implicit.as_ref().map(|f| f as &dyn Implicit);
        quality::surface_fidelity(mesh, &self.input.surface, implicit).map(Some)
    }

    /// The number of vertices, and the factor on the metric for which edges then are of unit length.
    ///
    /// A triangulation with V vertices has 2 (V - chi) - B faces, B of its edges on the border; each has the area sqrt(3) / 4.
    fn plan(&mut self) -> Result<(usize, f64)> {
        self.progress.stage("planning", 1);
        let (canvas, _) = Canvas::on_surface(Kind::Intrinsic, self.input, self.metric, MEASURING, &[])?;
        let draped = canvas.draped();
        let (area, chi) = (draped.area(), draped.topology().euler_characteristic() as f64);
        let border: f64 = draped.borders().iter().flatten().map(|&h| draped.topology().length(h)).sum();
        let vertices = |factor: f64| 2.0 / 3.0_f64.sqrt() * area * factor + 0.5 * border * factor.sqrt() + chi;
        let (count, factor) = match (self.options.vertices, self.options.complexity) {
            (Some(count), _) => {
                // The square root of the factor by the quadratic formula.
                let (a, b, c) = (2.0 / 3.0_f64.sqrt() * area, 0.5 * border, chi - count as f64);
                let root = ((b * b - 4.0 * a * c.min(0.0)).sqrt() - b) / (2.0 * a);
                (count, root * root)
            }
            (None, Some(complexity)) => (vertices(complexity / area).round() as usize, complexity / area),
            (None, None) => (vertices(1.0).round() as usize, 1.0),
        };
        let least = 4 * self.input.surface.components().len();
        let canvas = self.canvas_size(count) as f64;
        demand_memory(count as f64, canvas, self.options.memory_limit)?;
        let factor = if factor > 0.0 { factor } else { 1.0 };
        Ok((count.max(least), factor))
    }

    fn canvas_size(&self, count: usize) -> usize {
        crate::canvas::size_for(count, self.options.canvas_size)
    }

    fn canvas(&mut self, count: usize, seeds: &[Place]) -> Result<(Canvas<Draped<'a>>, Vec<VertexId>)> {
        self.progress.stage("canvas", 1);
        Canvas::on_surface(self.options.canvas, self.input, self.metric, self.canvas_size(count), seeds)
    }

    /// The triangulation of the seeds, relaxed.
    fn relaxed(
        &mut self,
        canvas: &Canvas<Draped>,
        seeds: &Rdt<OnSurface>,
        scale: f64,
    ) -> Result<(SurfaceDual<'a>, Relaxed)> {
        let steps = self.options.lloyd;
        self.progress.stage("relaxing", steps as u64);
        let places: Vec<Place> = seeds.judge().seeds().iter().map(|&v| *canvas.draped().place(v)).collect();
        let triangles = seeds.triangles();
        let topology = Triangulation::from_triangles(places.len(), &triangles, &vec![0; triangles.len()]);
        let mut dual = SurfaceDual::new(self.input, self.metric, scale, places, topology)?;
        if dual.downright() > 0
            && let Some(topology) = euclidean(canvas, seeds.judge().seeds())?
        {
            // Straight edges cannot honour the metric here. The Delaunay triangulation in space can be flipped towards it.
            let straight = SurfaceDual::new(self.input, self.metric, scale, dual.places().to_vec(), topology)?;
            dual = if straight.downright() < dual.downright() { straight } else { dual };
        }
        dual.flip_all();
        self.fit_scale(&mut dual)?;
        let mut relaxed = Relaxed::default();
        for part in 0..PARTS {
            let steps = (steps * (part + 1)) / PARTS - (steps * part) / PARTS;
            relaxed.append(relax(&mut dual, &Tangent, steps, self.progress)?);
            self.fit_scale(&mut dual)?;
        }
        mend(&mut dual);
        Ok((dual, relaxed))
    }

    fn fit_scale(&self, dual: &mut SurfaceDual) -> Result<()> {
        if self.options.vertices.is_some() {
            let mean = dual.mean_length();
            dual.rescale(dual.factor() / (mean * mean))?;
        }
        Ok(())
    }

    /// Flips by lengths of geodesics on a canvas that has the seeds as vertices.
    fn settle(&mut self, dual: &mut SurfaceDual) -> Result<Settled> {
        self.progress.stage("settling edges", 1);
        let (canvas, at) = self.canvas(dual.places().len(), dual.places())?;
        let diagram = SurfaceDiagram::on_surface(&canvas, &at, self.options.geodesic)?;
        let triangles = dual.triangles();
        let nerve = diagram.nerve();
        let at_border = Start::from_nerve(&nerve).at_border;
        let rdt = Rdt::judged(OnSurface::new(&diagram), at.len(), &Start { triangles, at_border });
        dual.settle_by(|quad| rdt.margin_of(quad));
        let blocked = dual.disagreeing(|quad| rdt.margin_of(quad));
        mend(dual);
        let account = report::Dual { blocked_flips: blocked, ..account(&rdt, &nerve, Road::Geodesic) };
        let is_fine = self.options.fit && self.input.implicit.is_some();
        let fine = is_fine.then(|| canvas.draped().to_surface()).transpose()?;
        Ok(Settled { account, figures: canvas.figures(), diagram: report::Diagram::of(&diagram), fine })
    }

    fn finish(&self, dual: &SurfaceDual) -> Result<Mesh> {
        self.progress.stage("checking", 1);
        let mesh = surface_mesh(self.input, dual.places(), dual.triangles());
        quality::check(&mesh)?;
        if dual.topology().euler_characteristic() != self.input.surface.euler_characteristic() {
            let help = "ask for more vertices (-n); please report this with the input".into();
            let what = "the mesh has another topology than the surface".into();
            return Err(Error::Mesh { what, place: "the mesh".into(), help });
        }
        Ok(mesh)
    }
}

/// Mends the worst triangles.
fn mend(dual: &mut SurfaceDual) {
    let poor = (dual.topology().face_count() as f64 * MENDED_SHARE).ceil() as usize;
    for _ in 0..MENDINGS {
        mend_worst(dual, poor);
    }
}

/// The Delaunay triangulation of seeds in the surface's own metric; `None` where cells are no discs or meet twice.
fn euclidean(canvas: &Canvas<Draped>, seeds: &[VertexId]) -> Result<Option<Triangulation>> {
    let own = Constant(Tensor3::IDENTITY);
    let canvas = canvas.remeasured(&own)?;
    let diagram = SurfaceDiagram::on_surface(&canvas, seeds, Method::March)?;
    let (dual, poor) = surface_triangulation(&diagram);
    let triangles = dual.triangles();
    let topology = Triangulation::from_triangles(seeds.len(), &triangles, &vec![0; triangles.len()]);
    Ok(poor.is_empty().then_some(topology))
}
