//! `voronaut dual`: diagram and dual of the seeds given.

use crate::options::{CanvasSize, Damage, EdgesOut, MetricChoices, Outputs, Paged, Run, Show, canvas_size, refuse};
use crate::seeds::SeedFile;
use crate::stages::Stages;
use crate::world::World;
use crate::{fields, files, pages, pictures};
use clap::Args;
use serde_json::{Value, json};
use std::path::PathBuf;
use voronaut::canvas::{self, Canvas, CanvasFigures};
use voronaut::certificate::Constants;
use voronaut::diagram::{self, Diagram, Ground, Kind, Nerve, RESOLVE_ROUNDS, SurfaceDiagram, resolve};
use voronaut::dual::Road;
use voronaut::figures;
use voronaut::geodesic::Method;
use voronaut::geometry::Point;
use voronaut::manifold::domain::Domain;
use voronaut::manifold::surface::Mended;
use voronaut::manifold::{Manifold, Riemannian};
use voronaut::mesh::Mesh;
use voronaut::metric::MetricField;
use voronaut::net::Net;
use voronaut::quality::{Meetings, Validity, crossing_edges, metric_quality, validity, validity_on};
use voronaut::realisation::Realisation;
use voronaut::recipe::{self, GradedAt, Measured, MeshOptions, SeedDual};
use voronaut::sampling;
use voronaut::{Error, Result};
use voronaut_draw::Layers;
use voronaut_io::{Given, Report};

pub(crate) const EXAMPLES: &str = "\
Line i of FILE, `x y` (of a surface `x y z`, on it or near), is seed and vertex i. DOMAIN and METRIC are as for `mesh`; the metric is used as it is.

With --edges geodesic OUT holds the seeds first, then the points of the geodesics; edges are their segments (in a .vtu one
polyline cell for each), labelled with the number of the edge, and triangles cut up the region of each Riemannian triangle,
labelled with its number, both from 1. Lengths are in the report and in the .vtu.

Examples:
  voronaut dual rect:-2,-2,2,2 --metric swirl --seeds seeds.txt -o dual.mesh
  voronaut dual rect:-2,-2,2,2 --metric swirl --seeds seeds.txt -o rdt.vtu --edges geodesic --picture rdt.png --show geodesics
  voronaut dual sea.geojson --metric boundary:h0=2 --seeds ports.txt -o dual.vtu --diagram cells.vtu --report run.json";

#[derive(Debug, Args)]
pub(crate) struct DualArgs {
    /// The domain: a file or a shape
    pub(crate) domain: String,
    /// The metric in which distances are measured
    #[arg(long)]
    pub(crate) metric: String,
    /// The seeds: a file with a line `x y` for each
    #[arg(long, value_name = "FILE")]
    pub(crate) seeds: PathBuf,
    /// The dual: .mesh, .meshb, .msh, .su2, .vtu, .vtp, .obj, .off, .ply or .stl
    #[arg(short, long, value_name = "OUT")]
    pub(crate) out: PathBuf,
    /// Write the coloured canvas, with colours and distances: .vtu
    #[arg(long, value_name = "FILE")]
    pub(crate) diagram: Option<PathBuf>,
    /// What decides on the edges: geodesic (their lengths), canvas (the diagram on one) or both (the diagram where lengths cannot)
    #[arg(long, value_name = "ROAD", default_value_t = Road::default())]
    pub(crate) dual: Road,
    /// Which Voronoi diagram: riemannian, or, by straight distances, du-wang (in the metric of the place) or labelle-shewchuk (in
    /// that of the seed). Of these two OUT has the nerve as the canvas shows it, whatever --dual says; --show cells has their
    /// orphans in red
    #[arg(long, value_name = "WHICH", default_value_t = diagram::Kind::default())]
    pub(crate) voronoi: diagram::Kind,
    /// How distances on the canvas are computed: march, stvd[:window=8], dijkstra or konukoglu
    #[arg(long, value_name = "METHOD", default_value_t = Method::default())]
    pub(crate) geodesic: Method,
    /// How OUT has the edges: straight, or as the geodesics that they are (polylines, with the regions between them)
    #[arg(long, value_enum, value_name = "HOW", default_value_t = EdgesOut::Straight)]
    pub(crate) edges: EdgesOut,
    /// What distances travel on: intrinsic (even in the metric), isotropic (Euclidean Delaunay, as fine as the metric's finest
    /// direction) or starset (even in the metric; methods on graphs travel along Delaunay stars, each in its own metric)
    #[arg(long, value_name = "WHICH", default_value_t = canvas::Kind::default())]
    pub(crate) canvas: canvas::Kind,
    /// Canvas vertices per seed (of up to 300 seeds the canvas is that of 2,500); or certified: as many as the theorems ask for
    #[arg(long, value_name = "N", value_parser = canvas_size, default_value_t = CanvasSize::default())]
    pub(crate) canvas_size: CanvasSize,
    /// Say which of the report's theorems hold of these seeds and this canvas, by how much others miss, and what it would take
    #[arg(long)]
    pub(crate) certify: bool,
    /// Measure the seeds as a net: epsilon, mu, protection (report)
    #[arg(long)]
    pub(crate) net: bool,
    /// The formulas of these theorems: corrected, or printed (with the report's errors, to compare)
    #[arg(long, value_name = "WHICH", default_value_t = Constants::default())]
    pub(crate) constants: Constants,
    /// Exit with 1 if what OUT would hold is not embedded: straight triangles inverted, edges that cross
    #[arg(long)]
    pub(crate) strict: bool,
    #[command(flatten)]
    pub(crate) metric_choices: MetricChoices,
    #[command(flatten)]
    pub(crate) outputs: Outputs,
    #[command(flatten)]
    pub(crate) paged: Paged,
    #[command(flatten)]
    pub(crate) damage: Damage,
    #[command(flatten)]
    pub(crate) run: Run,
}

impl DualArgs {
    /// Whether the seeds are to be certified: where that is asked for, or a canvas or a picture needs it.
    pub(super) fn is_certified(&self) -> bool {
        self.certify || self.canvas_size == CanvasSize::Certified || self.outputs.shows(Show::Certificate)
    }

    /// All options, as used.
    pub(super) fn as_used(&self) -> Value {
        let canvas_size = match self.canvas_size {
            CanvasSize::PerSeed(count) => json!(count),
            CanvasSize::Certified => json!("certified"),
        };
        json!({
            "domain": self.domain, "metric": self.metric, "seeds": self.seeds, "out": self.out, "diagram": self.diagram,
            "canvas": self.canvas, "canvas_size": canvas_size,
            "voronoi": self.voronoi, "certify": self.certify, "net": self.net, "constants": self.constants, "geodesic": self.geodesic, "dual": self.dual, "edges": self.edges, "strict": self.strict,
            "background": self.metric_choices.background, "bounds": self.metric_choices.bounds(),
            "smooth_metric": self.metric_choices.smooth_metric, "tensor_order": self.metric_choices.tensor_order, "gradation": self.metric_choices.gradation,
            "picture": self.outputs.picture, "view": self.paged.view, "cells": self.paged.cells, "histograms": self.outputs.histograms, "report": self.run.report, "threads": self.run.threads,
            "repair": self.damage.repair,
        })
    }
}

/// The dual of the seeds. Triangles that come out inverted and edges that cross are counted, not refused.
pub(crate) fn run(args: &DualArgs, world: &World) -> Result<()> {
    let stages = Stages::start(world);
    demand(args, world)?;
    args.metric_choices.bounds().check()?;
    let (given, mended) = world.given(&args.domain, args.damage.options())?;
    match given {
        Given::Surface(input) => on_surface(args, world, &input, &mended, stages),
        Given::Plane(domain) => in_plane(args, world, &domain, &mended, stages),
    }
}

fn in_plane(args: &DualArgs, world: &World, domain: &Domain, mended: &Mended, mut stages: Stages) -> Result<()> {
    let outputs = &args.outputs;
    let at = GradedAt::Scale(1.0);
    let metric = fields::in_plane(world, &args.metric, domain, &args.domain, &args.metric_choices, at)?.field;
    let metric = metric.as_ref();
    let file = SeedFile::of_points(world.seeds(&args.seeds)?)?;
    stages.end("read");
    let canvas = canvas(args, domain, metric, &file)?;
    stages.end("canvas");
    let diagram = Diagram::of_kind(args.voronoi, &canvas, metric, &file.seeds, args.geodesic)?;
    stages.end("diagram");
    let work = Work { args, world, diagram: &diagram, on: metric.into(), mended };
    let straight = |triangles, nerve: &Nerve| {
        let mesh = diagram.to_mesh(triangles, nerve, &domain.pslg().segments);
        let (found, crossing) = (validity(&mesh), crossing_edges(&mesh).len());
        (mesh, found, Some(crossing))
    };
    let found = work.found(canvas.figures(), straight, stages)?;
    let certificate = found.report.certificate.as_ref().filter(|_| outputs.shows(Show::Certificate));
    let layers = Layers {
        protection: pictures::protection(outputs, found.net.as_ref(), MeshOptions::default().protection),
        factors: certificate.map(|found| found.cells.iter().map(|cell| (cell.seed, cell.factor)).collect()),
        ..pictures::layers(outputs, &diagram, metric, found.curved.as_ref())
    };
    let picture = pictures::in_plane(outputs, &found.mesh, Some(metric), &layers)?;
    work.finish(found, picture)
}

/// The dual of seeds on a surface.
fn on_surface(args: &DualArgs, world: &World, input: &Manifold, mended: &Mended, mut stages: Stages) -> Result<()> {
    pictures::demand_of_surfaces(&args.outputs)?;
    let metric = fields::on_surface(world, &args.metric, input, &args.metric_choices, GradedAt::Scale(1.0))?;
    let places = SeedFile::of_places(world.seeds(&args.seeds)?)?.on_surface(input)?;
    stages.end("read");
    let metric = metric.as_ref();
    let (canvas, at) = if let Some(size) = canvas_vertices(args, places.len())? {
        Canvas::on_surface(args.canvas, input, metric, size, &places)?
    } else {
        let limit = args.run.limits.memory();
        recipe::certified_canvas_on(args.canvas, input, metric, &places, args.constants, limit)?
    };
    stages.end("canvas");
    let diagram = SurfaceDiagram::of_kind_on_surface(args.voronoi, &canvas, &at, args.geodesic)?;
    stages.end("diagram");
    let work = Work { args, world, diagram: &diagram, on: (input, metric).into(), mended };
    let straight = |triangles, _: &Nerve| {
        let mesh = recipe::surface_mesh(input, &places, triangles);
        let found = validity_on(&mesh, &Meetings::of(input.whole_mesh()));
        (mesh, found, None)
    };
    let found = work.found(canvas.figures(), straight, stages)?;
    let draw = || pictures::on_surface(&args.outputs, &diagram, &found.mesh, found.curved.as_ref());
    let picture = args.outputs.picture.is_some().then(draw).transpose()?;
    work.finish(found, picture)
}

/// A diagram whose dual is made.
struct Work<'w, 'a, G: Measured<'a>> {
    args: &'w DualArgs,
    world: &'w World<'w>,
    diagram: &'w Diagram<'a, G>,
    on: Riemannian<'w>,
    mended: &'w Mended,
}

/// A dual with straight edges, and what is found of it.
struct Found<S, P> {
    mesh: Mesh,
    report: Report,
    net: Option<Net<S>>,
    curved: Option<Realisation<P>>,
}

impl<'a, G: Measured<'a>> Work<'_, 'a, G> {
    /// The dual by the road that is asked for; `straight` gives its triangles straight edges, and says how many of these cross.
    fn found(
        &self,
        canvas: CanvasFigures,
        straight: impl FnOnce(Vec<[u32; 3]>, &Nerve) -> (Mesh, Validity, Option<usize>),
        mut stages: Stages,
    ) -> Result<Found<G::Seed, G::Point>> {
        let Self { args, diagram, .. } = *self;
        let is_riemannian = args.voronoi == Kind::Riemannian;
        let SeedDual { triangles, nerve, mut account, seconds, exact, raw_nerve } =
            recipe::dual(diagram, args.dual, &*self.world.progress(&args.run));
        let (mesh, validity, crossing) = straight(triangles, &nerve);
        account.crossing_edges = crossing;
        stages.end("dual");
        let is_curved = args.edges == EdgesOut::Geodesic || args.outputs.have_geodesics() || args.paged.cells;
        let curved = is_curved.then(|| G::realisation(diagram, &mesh.triangles));
        account.geodesics = curved.as_ref().map(figures::Geodesics::of);
        if is_curved {
            stages.end("geodesics");
        }
        let meets = validity.meetings.note();
        let mut report = reported(args, &mesh, validity, self.on)?;
        report.dual = Some(account);
        report.histograms = files::histograms(&args.outputs, &mesh, self.on)?;
        report.canvas = Some(canvas);
        let raw_nerve = is_riemannian.then_some(raw_nerve);
        report.diagram = Some(figures::Diagram { raw_nerve, ..figures::Diagram::of(diagram) });
        let is_measured = args.net || args.outputs.shows(Show::Protection) || args.is_certified();
        let net = (is_riemannian && is_measured).then(|| recipe::net(diagram, &exact));
        report.net = net.as_ref().map(figures::NetFigures::of);
        if net.is_some() {
            stages.end("net");
        }
        let certified = net.as_ref().filter(|_| args.is_certified());
        report.certificate = certified.map(|net| G::certificate(diagram, &exact, net, args.constants));
        if report.certificate.is_some() {
            stages.end("certificate");
        }
        report.notes = notes(diagram, &report);
        report.notes.extend(self.mended.sentences().chain(meets));
        if matches!(self.on, Riemannian::Surface(..)) && !report.validity.valid {
            report.notes.push("straight triangles of the dual do not make a valid mesh of these seeds".into());
        }
        // Parts of "dual".
        report.seconds = stages.seconds(seconds);
        demand_embedded(args, self.world, &report)?;
        Ok(Found { mesh, report, net, curved })
    }

    /// Writes what is asked for.
    fn finish(&self, found: Found<G::Seed, G::Point>, picture: Option<String>) -> Result<()> {
        let Self { args, world, diagram, .. } = *self;
        let Found { mesh, report, curved, .. } = found;
        let sheet = pages::of(&args.paged, &args.out, &mesh, |sheet| {
            pages::measured(sheet, self.on, report.validity.valid)?;
            if let Some(curved) = curved.as_ref().filter(|_| args.paged.cells) {
                pages::show_diagram(sheet, diagram, curved);
            }
            Ok(())
        })?;
        match curved.filter(|_| args.edges == EdgesOut::Geodesic) {
            Some(curved) => world.write_realisation(&curved, &args.out)?,
            None => world.write_mesh(mesh, &args.out)?,
        }
        pages::write(&args.paged, world, sheet)?;
        if args.diagram.is_some() || world.keeps_diagrams() {
            world.write_diagram(diagram.to_coloured_canvas(), args.diagram.as_deref())?;
        }
        files::finish(world, &args.out, &args.outputs, picture, &report, &args.run)
    }
}

/// What can be refused before the work.
fn demand(args: &DualArgs, world: &World) -> Result<()> {
    args.diagram.as_deref().map(voronaut_io::demand_diagram).transpose()?;
    let view = world.page_file(&args.paged);
    files::demand_writable(world.file(&args.out), args.diagram.as_deref(), view, &args.outputs, &args.run)?;
    args.geodesic.demand_diagrams()?;
    demand_geodesics(args)?;
    let what = "a picture of where a metric is not met by seeds that are given";
    refuse([(args.outputs.shows(Show::Unmet), what, "give the mesh of the dual to voronaut check")])
}

/// Vertices of the canvas of so many seeds; `None`: as many as its certificate asks for.
fn canvas_vertices(args: &DualArgs, seeds: usize) -> Result<Option<usize>> {
    let CanvasSize::PerSeed(per_seed) = args.canvas_size else { return Ok(None) };
    let size = canvas::size_for(seeds, per_seed);
    sampling::demand_memory(seeds as f64, size as f64, args.run.limits.memory())?;
    Ok(Some(size))
}

/// The canvas that is asked for, in whose domain all seeds are.
fn canvas(args: &DualArgs, domain: &Domain, metric: &dyn MetricField, file: &SeedFile<Point>) -> Result<Canvas> {
    let seeds = &file.seeds;
    let size = canvas_vertices(args, seeds.len())?;
    let canvas = Canvas::new(args.canvas, domain.planar(), metric, size.unwrap_or_default())?;
    file.demand_inside(&canvas)?;
    if size.is_none() {
        return recipe::certified_canvas(
            args.canvas,
            domain.planar(),
            metric,
            seeds,
            args.constants,
            args.run.limits.memory(),
        );
    }
    if args.voronoi == Kind::Riemannian && args.dual == Road::Canvas {
        return Ok(resolve(canvas, metric, seeds, RESOLVE_ROUNDS)?.canvas);
    }
    Ok(canvas)
}

/// Refuses what only the Riemannian diagram has where another is asked for.
fn demand_geodesics(args: &DualArgs) -> Result<()> {
    let all = [
        (args.edges == EdgesOut::Geodesic, "--edges geodesic"),
        (args.outputs.have_geodesics(), "--show geodesics or triangles"),
        (args.outputs.shows(Show::Protection), "--show protection"),
        (args.is_certified(), "--certify"),
        (args.net, "--net"),
        (args.geodesic != Method::default(), "--geodesic"),
    ];
    let is_other = args.voronoi != Kind::Riemannian;
    refuse(all.map(|(is_asked, what)| {
        let help = format!("leave out {what}, or --voronoi");
        (is_other && is_asked, format!("{what} with a diagram that measures straight distances"), help)
    }))
}

/// The figures of the dual with straight edges, in the metric only where it is valid.
fn reported(args: &DualArgs, mesh: &Mesh, found: Validity, on: Riemannian) -> Result<Report> {
    let is_valid = found.valid;
    let mut report = Report::new(mesh, found);
    if is_valid {
        report.add_quality(&metric_quality(mesh, on)?);
    }
    report.options = args.as_used();
    Ok(report)
}

/// Refuses, if that is asked for, what OUT would hold if it is not embedded, with the report.
fn demand_embedded(args: &DualArgs, world: &World, report: &Report) -> Result<()> {
    if args.strict {
        embedded(args, report).or_else(|fault| world.write_report(report.to_json(), &args.run).and(Err(fault)))?;
    }
    Ok(())
}

fn embedded(args: &DualArgs, report: &Report) -> Result<()> {
    let dual = report.dual.as_ref();
    if let Some(found) = dual.and_then(|dual| dual.geodesics.as_ref()).filter(|_| args.edges == EdgesOut::Geodesic) {
        let crossing = "pairs of geodesic edges meet elsewhere than at seeds";
        demand_none(found.crossing_geodesics, crossing, args)?;
        return demand_none(found.open_regions, "triangles of geodesic edges bound no region", args);
    }
    report.validity.demand()?;
    let crossing = dual.and_then(|dual| dual.crossing_edges).unwrap_or(0);
    demand_none(crossing, "pairs of straight edges cross", args)
}

fn demand_none(count: usize, what: &str, args: &DualArgs) -> Result<()> {
    if count == 0 {
        return Ok(());
    }
    let help = "add seeds where the metric changes fast, or leave out --strict";
    Err(Error::mesh(format!("{count} {what}"), args.out.display().to_string(), help))
}

fn notes<'a, G: Ground<'a>>(diagram: &Diagram<'a, G>, report: &Report) -> Vec<String> {
    let mut notes = Vec::new();
    if report.triangles == 0 {
        notes.push("there are no triangles: no three cells meet".into());
    }
    let mut note = |count: usize, what: &str| {
        if count > 0 {
            notes.push(format!("{count} {what}"));
        }
    };
    let inverted = "straight triangles come out inverted: the dual does not embed with straight edges and these seeds";
    note(report.validity.inverted, inverted);
    let orphans = report.diagram.as_ref().map_or(0, |diagram| diagram.orphan_components);
    note(orphans, "orphans: parts of cells that do not hang together with their seeds");
    let dual = report.dual.as_ref();
    note(dual.and_then(|dual| dual.crossing_edges).unwrap_or(0), "pairs of straight edges cross");
    if let Some(found) = dual.and_then(|dual| dual.geodesics.as_ref()) {
        note(found.crossing_geodesics, "pairs of geodesic edges meet elsewhere than at seeds");
        note(found.open_regions, "triangles of geodesic edges bound no region, and have none in the file");
    }
    let empty = diagram.cell_sizes().iter().filter(|&&size| size == 0).count();
    note(empty, "seeds have no canvas vertex in their cell: raise --canvas-size");
    notes
}
