//! `voronaut dual`: diagram and dual of the seeds given.

mod args;
pub(crate) mod certify;

pub(crate) use args::{DualArgs, EXAMPLES};

use crate::options::{CanvasSize, EdgesOut, Show, refuse};
use crate::progress::{Bar, Stages};
use crate::seeds::SeedFile;
use crate::{fields, files, pictures};
use voronaut::canvas::{self, Canvas};
use voronaut::diagram::{Diagram, Kind, RESOLVE_ROUNDS, SurfaceDiagram, resolve};
use voronaut::domain::Domain;
use voronaut::dual::Road;
use voronaut::figures;
use voronaut::geodesic::Method;
use voronaut::geometry::Point;
use voronaut::mesh::Mesh;
use voronaut::metric::MetricField;
use voronaut::quality::{
    Meetings, MetricQuality, Validity, crossing_edges, metric_quality, surface_quality, validity, validity_on,
};
use voronaut::realisation::Realisation;
use voronaut::recipe::{self, GradedAt, MeshOptions, SeedDual};
use voronaut::surface::{Input, Mended};
use voronaut::{Error, Result, sampling};
use voronaut_draw::Layers;
use voronaut_io::{Given, Report};

/// The dual of the seeds. Triangles that come out inverted and edges that cross are counted, not refused.
pub(crate) fn run(args: &DualArgs) -> Result<()> {
    let stages = Stages::start();
    demand(args)?;
    args.run.set_threads()?;
    args.metric_choices.bounds().check()?;
    let (given, mended) = Given::read_with(&args.domain, None, args.damage.options())?;
    match given {
        Given::Surface(input) => on_surface(args, &input, &mended, stages),
        Given::Plane(domain) => in_plane(args, &domain, &mended, stages),
    }
}

fn in_plane(args: &DualArgs, domain: &Domain, mended: &Mended, mut stages: Stages) -> Result<()> {
    let outputs = &args.outputs;
    let at = GradedAt::Scale(1.0);
    let metric = fields::in_plane(&args.metric, domain, &args.domain, &args.metric_choices, at)?.field;
    let metric = metric.as_ref();
    let file = SeedFile::read(&args.seeds)?;
    stages.end("read");
    let canvas = canvas(args, domain, metric, &file)?;
    let is_riemannian = args.voronoi == Kind::Riemannian;
    stages.end("canvas");
    let diagram = Diagram::of_kind(args.voronoi, &canvas, metric, &file.seeds, args.geodesic)?;
    stages.end("diagram");
    let SeedDual { triangles, nerve, mut account, seconds, exact, raw_nerve } =
        recipe::dual(&diagram, metric, args.dual, &Bar::new(&args.run));
    let mesh = diagram.to_mesh(triangles, &nerve, domain);
    account.crossing_edges = Some(crossing_edges(&mesh).len());
    stages.end("dual");
    let is_curved = args.edges == EdgesOut::Geodesic || outputs.have_geodesics();
    let curved = is_curved.then(|| Realisation::new(&diagram, metric, &mesh.triangles));
    account.geodesics = curved.as_ref().map(figures::Geodesics::of);
    if is_curved {
        stages.end("geodesics");
    }
    let mut report = reported(args, &mesh, validity(&mesh), || metric_quality(&mesh, metric))?;
    report.dual = Some(account);
    report.histograms = files::histograms(outputs, &mesh, metric)?;
    report.canvas = Some(canvas.figures());
    report.diagram =
        Some(figures::Diagram { raw_nerve: is_riemannian.then_some(raw_nerve), ..figures::Diagram::of(&diagram) });
    let is_measured = args.run.report.is_some() || outputs.shows(Show::Protection) || args.is_certified();
    let net = (is_riemannian && is_measured).then(|| recipe::net(&diagram, metric, &exact));
    report.net = net.as_ref().map(figures::NetFigures::of);
    if net.is_some() {
        stages.end("net");
    }
    report.certificate = certify::certificate(args, &diagram, metric, &exact, net.as_ref());
    if report.certificate.is_some() {
        stages.end("certificate");
    }
    report.notes = notes(&diagram, &report);
    report.notes.extend(mended.sentences());
    // Parts of "dual".
    report.seconds = stages.seconds(seconds);
    demand_embedded(args, &report)?;
    let certificate = report.certificate.as_ref().filter(|_| outputs.shows(Show::Certificate));
    let layers = Layers {
        protection: pictures::protection(outputs, net.as_ref(), MeshOptions::default().protection),
        factors: certificate.map(|found| found.cells.iter().map(|cell| (cell.seed, cell.factor)).collect()),
        ..pictures::layers(outputs, &diagram, metric, curved.as_ref())
    };
    let picture = pictures::in_plane(outputs, &mesh, Some(metric), &layers)?;
    match curved.filter(|_| args.edges == EdgesOut::Geodesic) {
        Some(curved) => voronaut_io::write_realisation(&curved, &args.out)?,
        None => voronaut_io::write_mesh(&mesh, &args.out)?,
    }
    finish(args, picture, &report, || diagram.to_coloured_canvas())
}

/// The dual of seeds on a surface.
fn on_surface(args: &DualArgs, input: &Input, mended: &Mended, mut stages: Stages) -> Result<()> {
    let refused = [
        (args.voronoi != Kind::Riemannian, "--voronoi"),
        (args.certify, "--certify"),
        (args.canvas_size == CanvasSize::Certified, "--canvas-size certified"),
    ];
    pictures::demand_of_surfaces(&args.outputs, &refused)?;
    let metric = fields::on_surface(&args.metric, input, &args.metric_choices)?;
    let places = SeedFile::read_in_space(&args.seeds)?.on_surface(input)?;
    stages.end("read");
    let size = canvas_vertices(args, places.len())?.unwrap_or_default();
    let (canvas, at) = Canvas::on_surface(args.canvas, input, metric.as_ref(), size, &places)?;
    stages.end("canvas");
    let diagram = SurfaceDiagram::on_surface(&canvas, &at, args.geodesic)?;
    stages.end("diagram");
    let SeedDual { triangles, account, seconds, raw_nerve, .. } =
        recipe::surface_dual(&diagram, args.dual, &Bar::new(&args.run));
    let mesh = recipe::surface_mesh(input, &places, triangles);
    stages.end("dual");
    let found = validity_on(&mesh, &Meetings::of(input.whole_mesh()));
    let meets = found.meetings.note();
    let mut report = reported(args, &mesh, found, || surface_quality(&mesh, &input.surface, metric.as_ref()))?;
    report.dual = Some(account);
    report.canvas = Some(canvas.figures());
    report.diagram = Some(figures::Diagram { raw_nerve: Some(raw_nerve), ..figures::Diagram::of(&diagram) });
    report.notes.extend(mended.sentences().chain(meets));
    if !report.validity.valid {
        report.notes.push("straight triangles of the dual do not make a valid mesh of these seeds".into());
    }
    report.seconds = stages.seconds(seconds);
    demand_embedded(args, &report)?;
    let is_drawn = args.outputs.picture.is_some();
    let picture = is_drawn.then(|| pictures::on_surface(&args.outputs, &diagram, &mesh)).transpose()?;
    let written = if args.edges == EdgesOut::Geodesic { pictures::with_geodesics(&diagram, &mesh) } else { mesh };
    voronaut_io::write_mesh(&written, &args.out)?;
    finish(args, picture, &report, || diagram.to_coloured_surface())
}

/// What can be refused before the work.
fn demand(args: &DualArgs) -> Result<()> {
    args.diagram.as_deref().map(voronaut_io::demand_diagram).transpose()?;
    files::demand_writable(Some(&args.out), args.diagram.as_deref(), &args.outputs, &args.run)?;
    args.geodesic.demand_diagrams()?;
    demand_geodesics(args)?;
    let what = "a picture of where a metric is not met by seeds that are given";
    refuse([(args.outputs.shows(Show::Unmet), what, "give the mesh of the dual to voronaut check")])
}

/// Writes what is beside the dual.
fn finish(
    args: &DualArgs,
    picture: Option<String>,
    report: &Report,
    coloured: impl FnOnce() -> (Mesh, Vec<f64>),
) -> Result<()> {
    if let Some(path) = &args.diagram {
        let (canvas, distances) = coloured();
        voronaut_io::write_diagram(&canvas, &distances, path)?;
    }
    files::finish(&args.out, &args.outputs, picture, report, &args.run)
}

/// Vertices of the canvas of so many seeds; `None`: as many as its certificate asks for.
fn canvas_vertices(args: &DualArgs, seeds: usize) -> Result<Option<usize>> {
    let CanvasSize::PerSeed(per_seed) = args.canvas_size else { return Ok(None) };
    let size = canvas::size_for(seeds, per_seed);
    sampling::demand_memory(seeds as f64, size as f64, args.memory.bytes())?;
    Ok(Some(size))
}

/// The canvas that is asked for, in whose domain all seeds are.
fn canvas(args: &DualArgs, domain: &Domain, metric: &dyn MetricField, file: &SeedFile<Point>) -> Result<Canvas> {
    let seeds = &file.seeds;
    let size = canvas_vertices(args, seeds.len())?;
    let canvas = Canvas::new(args.canvas, domain, metric, size.unwrap_or_default())?;
    file.demand_inside(&canvas)?;
    if size.is_none() {
        return recipe::certified_canvas(args.canvas, domain, metric, seeds, args.constants, args.memory.bytes());
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
        (args.geodesic != Method::default(), "--geodesic"),
    ];
    let is_other = args.voronoi != Kind::Riemannian;
    refuse(all.map(|(is_asked, what)| {
        let help = format!("leave out {what}, or --voronoi");
        (is_other && is_asked, format!("{what} with a diagram that measures straight distances"), help)
    }))
}

/// The figures of the dual with straight edges, in the metric only where it is valid.
fn reported(
    args: &DualArgs,
    mesh: &Mesh,
    found: Validity,
    quality: impl FnOnce() -> Result<MetricQuality>,
) -> Result<Report> {
    let is_valid = found.valid;
    let mut report = Report::new(found, mesh.points.len(), mesh.triangles.len());
    if is_valid {
        report = report.with_quality(&quality()?);
    }
    report.options = args.as_used();
    Ok(report)
}

/// Refuses, if that is asked for, what OUT would hold if it is not embedded, with the report.
fn demand_embedded(args: &DualArgs, report: &Report) -> Result<()> {
    if args.strict {
        embedded(args, report).or_else(|fault| args.run.write_report(&report.to_json()).and(Err(fault)))?;
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
    Err(Error::Mesh { what: format!("{count} {what}"), place: args.out.display().to_string(), help: help.into() })
}

fn notes(diagram: &Diagram, report: &Report) -> Vec<String> {
    let mut notes = Vec::new();
    if report.triangles == 0 {
        notes.push("there are no triangles: no three cells meet in the domain".into());
    }
    let dual = report.dual.as_ref();
    let [crossing, open] = dual
        .and_then(|dual| dual.geodesics.as_ref())
        .map_or([0; 2], |found| [found.crossing_geodesics, found.open_regions]);
    let counts = [
        (
            report.validity.inverted,
            "straight triangles come out inverted: the dual does not embed with straight edges and these seeds",
        ),
        (
            report.diagram.as_ref().map_or(0, |diagram| diagram.orphan_components),
            "orphans: parts of cells that do not hang together with their seeds",
        ),
        (dual.and_then(|dual| dual.crossing_edges).unwrap_or(0), "pairs of straight edges cross"),
        (crossing, "pairs of geodesic edges meet elsewhere than at seeds"),
        (open, "triangles of geodesic edges bound no region, and have none in the file"),
        (
            diagram.cell_sizes().iter().filter(|&&size| size == 0).count(),
            "seeds have no canvas vertex in their cell: raise --canvas-size",
        ),
    ];
    notes.extend(counts.into_iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")));
    notes
}
