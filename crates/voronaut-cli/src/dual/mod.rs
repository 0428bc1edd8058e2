//! `voronaut dual`: diagram and dual of the seeds given.

mod args;
pub(crate) mod certify;
mod on_surface;

pub(crate) use args::{DualArgs, EXAMPLES};

use crate::files::{Drawn, MeshFile};
use crate::options::{CanvasSize, EdgesOut, Show};
use crate::progress::Bar;
use crate::seeds::SeedFile;
use crate::{fields, files, summary};
use std::time::Instant;
use voronaut::canvas::{self, Canvas};
use voronaut::diagram::{Diagram, Kind, RESOLVE_ROUNDS, resolve};
use voronaut::domain::Domain;
use voronaut::dual::Road;
use voronaut::figures;
use voronaut::geodesic::Method;
use voronaut::mesh::Mesh;
use voronaut::metric::MetricField;
use voronaut::net::Net;
use voronaut::quality::{crossing_edges, metric_quality, validity};
use voronaut::realisation::Realisation;
use voronaut::recipe::{self, GradedAt, MeshOptions, SeedDual};
use voronaut::{Error, Result, sampling};
use voronaut_io::{Given, Report, Seconds};

/// The dual of the seeds. Triangles that come out inverted and edges that cross are counted, not refused.
pub(crate) fn run(args: &DualArgs) -> Result<()> {
    let start = Instant::now();
    demand(args)?;
    files::set_threads(&args.run)?;
    let bounds = args.metric_choices.bounds();
    bounds.check()?;
    let (given, mended) = Given::read_with(&args.domain, None, args.damage.options())?;
    let domain = match given {
        Given::Surface(input) => return on_surface::run(args, &input, &mended, start),
        Given::Plane(domain) => domain,
    };
    let at = GradedAt::Scale(1.0);
    let metric = fields::in_plane(&args.metric, &domain, &args.domain, &args.metric_choices, at)?.field;
    let file = SeedFile::read(&args.seeds)?;
    let seeds = &file.seeds;
    let mut stages = Vec::new();
    let mut begin = start;
    let mut stage = |name: &'static str| {
        stages.push((name, begin.elapsed().as_secs_f64()));
        begin = Instant::now();
    };
    stage("read");
    let road = args.dual;
    let canvas = canvas(args, &domain, metric.as_ref(), &file)?;
    let is_riemannian = args.voronoi == Kind::Riemannian;
    stage("canvas");
    let diagram = Diagram::of_kind(args.voronoi, &canvas, metric.as_ref(), seeds, args.geodesic)?;
    stage("diagram");
    let SeedDual { triangles, nerve, mut account, seconds, exact, raw_nerve } =
        recipe::dual(&diagram, metric.as_ref(), road, &Bar::new(args.run.quiet, args.run.verbose));
    let mesh = diagram.to_mesh(triangles, &nerve, &domain);
    account.crossing_edges = Some(crossing_edges(&mesh).len());
    stage("dual");
    let is_curved = args.edges == EdgesOut::Geodesic || Drawn::has_geodesics(&args.outputs);
    let curved = is_curved.then(|| Realisation::new(&diagram, metric.as_ref(), &mesh.triangles));
    account.geodesics = curved.as_ref().map(figures::Geodesics::of);
    if is_curved {
        stage("geodesics");
    }
    let mut report = reported(&mesh, metric.as_ref(), account)?;
    report.histograms = files::histograms(&args.outputs, &mesh, metric.as_ref())?;
    report.canvas = Some(canvas.figures());
    report.diagram =
        Some(figures::Diagram { raw_nerve: is_riemannian.then_some(raw_nerve), ..figures::Diagram::of(&diagram) });
    let is_measured = is_riemannian && (Drawn::needs_net(&args.outputs) || args.is_certified());
    let net = is_measured.then(|| recipe::net(&diagram, metric.as_ref(), &exact));
    report.net = net.as_ref().map(figures::NetFigures::of);
    if net.is_some() {
        stage("net");
    }
    report.certificate = certify::certificate(args, &diagram, &exact, net.as_ref());
    if report.certificate.is_some() {
        stage("certificate");
    }
    report.notes = notes(&diagram, &report);
    report.notes.extend(mended.sentences());
    report.options = args.as_used();
    // Parts of "dual".
    stages.extend(seconds);
    report.seconds = Seconds { stages, total: start.elapsed().as_secs_f64() };
    if args.strict {
        demand_embedded(args, &report).or_else(|fault| files::write_report(&args.outputs, &report).and(Err(fault)))?;
    }
    write(args, &diagram, &mesh, metric.as_ref(), curved.as_ref(), net.as_ref(), &report)?;
    summary::print(&args.out.display().to_string(), &report, &args.run);
    Ok(())
}

/// What can be refused before the work.
fn demand(args: &DualArgs) -> Result<()> {
    args.diagram.as_deref().map(voronaut_io::demand_diagram).transpose()?;
    files::demand_writable(Some(&args.out), args.diagram.as_deref(), &args.outputs)?;
    args.geodesic.demand_diagrams()?;
    demand_geodesics(args)?;
    if args.outputs.show.contains(&Show::Unmet) {
        let what = "a picture of where a metric is not met by seeds that are given".into();
        return Err(Error::Unsupported { what, help: "give the mesh of the dual to voronaut check".into() });
    }
    Ok(())
}

/// Writes all that is asked for.
fn write(
    args: &DualArgs,
    diagram: &Diagram,
    mesh: &Mesh,
    metric: &dyn MetricField,
    curved: Option<&Realisation>,
    net: Option<&Net>,
    report: &Report,
) -> Result<()> {
    let drawn = Drawn::from_diagram(&args.outputs, diagram, mesh, metric, curved);
    let drawn = drawn.with_net(&args.outputs, net, MeshOptions::default().protection);
    let drawn = drawn.with_certificate(&args.outputs, report.certificate.as_ref());
    let file = match curved {
        Some(curved) if args.edges == EdgesOut::Geodesic => MeshFile::Geodesic(&args.out, curved),
        _ => MeshFile::Straight(&args.out),
    };
    files::write(&file, &args.outputs, mesh, Some(metric), report, &drawn)?;
    if let Some(path) = &args.diagram {
        let (canvas, distances) = diagram.to_coloured_canvas();
        voronaut_io::write_diagram(&canvas, &distances, path)?;
    }
    Ok(())
}

/// The canvas that is asked for, in whose domain all seeds are.
fn canvas(args: &DualArgs, domain: &Domain, metric: &dyn MetricField, file: &SeedFile) -> Result<Canvas> {
    let seeds = &file.seeds;
    let CanvasSize::PerSeed(per_seed) = args.canvas_size else {
        file.demand_inside(&Canvas::new(args.canvas, domain, metric, 0)?)?;
        return recipe::certified_canvas(args.canvas, domain, metric, seeds, args.constants, args.memory_limit());
    };
    let size = canvas::size_for(seeds.len(), per_seed);
    sampling::demand_memory(seeds.len() as f64, size as f64, args.memory_limit())?;
    let canvas = Canvas::new(args.canvas, domain, metric, size)?;
    file.demand_inside(&canvas)?;
    if args.voronoi == Kind::Riemannian && args.dual == Road::Canvas {
        return Ok(resolve(canvas, metric, seeds, RESOLVE_ROUNDS)?.canvas);
    }
    Ok(canvas)
}

/// Refuses what only the Riemannian diagram has where another is asked for.
fn demand_geodesics(args: &DualArgs) -> Result<()> {
    let shows_protection = args.outputs.show.contains(&Show::Protection);
    let what = match () {
        () if args.voronoi == Kind::Riemannian => return Ok(()),
        () if args.edges == EdgesOut::Geodesic => "--edges geodesic",
        () if Drawn::has_geodesics(&args.outputs) => "--show geodesics or triangles",
        () if shows_protection => "--show protection",
        () if args.is_certified() => "--certify",
        () if args.canvas_size == CanvasSize::Certified => "--canvas-size certified",
        () if args.geodesic != Method::default() => "--geodesic",
        () => return Ok(()),
    };
    let help = format!("leave out {what}, or --voronoi");
    Err(Error::Unsupported { what: format!("{what} with a diagram that measures straight distances"), help })
}

/// The figures of the dual with straight edges, in the metric only where it is valid.
fn reported(mesh: &Mesh, metric: &dyn MetricField, account: figures::Dual) -> Result<Report> {
    let found = validity(mesh);
    let is_valid = found.valid;
    let mut report = Report::new(found, mesh.points.len(), mesh.triangles.len());
    if is_valid {
        report = report.with_quality(&metric_quality(mesh, metric)?);
    }
    report.dual = Some(account);
    Ok(report)
}

/// Refuses what OUT would hold if it is not embedded.
fn demand_embedded(args: &DualArgs, report: &Report) -> Result<()> {
    let dual = report.dual.as_ref();
    if args.edges == EdgesOut::Straight {
        report.validity.demand()?;
        let crossing = dual.and_then(|dual| dual.crossing_edges).unwrap_or(0);
        return demand_none(crossing, "pairs of straight edges cross", args);
    }
    let geodesics = dual.and_then(|dual| dual.geodesics.as_ref());
    let [crossing, open] = geodesics.map_or([0; 2], |found| [found.crossing_geodesics, found.open_regions]);
    demand_none(crossing, "pairs of geodesic edges meet elsewhere than at seeds", args)?;
    demand_none(open, "triangles of geodesic edges bound no region", args)
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
    let mut note = |count: usize, what: &str| {
        if count > 0 {
            notes.push(format!("{count} {what}"));
        }
    };
    note(
        report.validity.inverted,
        "straight triangles come out inverted: the dual does not embed with straight edges and these seeds",
    );
    let orphans = report.diagram.as_ref().map_or(0, |diagram| diagram.orphan_components);
    note(orphans, "orphans: parts of cells that do not hang together with their seeds");
    if let Some(dual) = &report.dual {
        note(dual.crossing_edges.unwrap_or(0), "pairs of straight edges cross");
        if let Some(found) = &dual.geodesics {
            note(found.crossing_geodesics, "pairs of geodesic edges meet elsewhere than at seeds");
            note(found.open_regions, "triangles of geodesic edges bound no region, and have none in the file");
        }
    }
    let empty = diagram.cell_sizes().iter().filter(|&&size| size == 0).count();
    if empty > 0 {
        notes.push(format!("{empty} seeds have no canvas vertex in their cell: raise --canvas-size"));
    }
    notes
}
