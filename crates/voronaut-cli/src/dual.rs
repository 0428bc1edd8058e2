//! `voronaut dual`: diagram and dual of the seeds given.

use crate::args::{DualArgs, EdgesOut};
use crate::files::{Drawn, MeshFile};
use crate::seeds::SeedFile;
use crate::{files, summary};
use serde_json::json;
use std::path::Path;
use std::time::Instant;
use voronaut::canvas::{self, Canvas};
use voronaut::diagram::{Diagram, RESOLVE_ROUNDS, resolve};
use voronaut::domain::Domain;
use voronaut::dual::Road;
use voronaut::mesh::Mesh;
use voronaut::metric::{MetricField, MetricSpec};
use voronaut::output::{self, Report, report};
use voronaut::quality::{crossing_edges, metric_quality, validity};
use voronaut::realisation::Realisation;
use voronaut::recipe::{self, MeshOptions, SeedDual};
use voronaut::sampling;
use voronaut::{Error, Result};

/// The dual of the seeds. Triangles that come out inverted and edges that cross are counted, not refused.
pub(crate) fn run(args: &DualArgs) -> Result<()> {
    let start = Instant::now();
    args.diagram.as_deref().map(output::demand_diagram).transpose()?;
    files::demand_writable(Some(&args.out), args.diagram.as_deref(), &args.outputs)?;
    args.geodesic.demand_diagrams()?;
    files::set_threads(&args.run)?;
    let bounds = args.metric_choices.bounds();
    bounds.check()?;
    let spec = MetricSpec::parse(&args.metric)?;
    let domain = Domain::read(&args.domain)?;
    let own = matches!(spec, MetricSpec::File(_)).then_some(Path::new(&args.domain));
    let background = args.metric_choices.background.as_deref().or(own);
    let metric = recipe::metric(&spec, &domain, background, bounds)?;
    let metric = recipe::smooth_metric(metric, &domain, background, args.metric_choices.smooth_metric)?;
    let file = SeedFile::read(&args.seeds)?;
    let seeds = &file.seeds;
    let mut stages = Vec::new();
    let mut begin = start;
    let mut stage = |name: &'static str| {
        stages.push((name, begin.elapsed().as_secs_f64()));
        begin = Instant::now();
    };
    stage("read");
    let size = canvas::size_for(seeds.len(), args.canvas_size);
    sampling::demand_memory(seeds.len() as f64, size as f64, args.memory_limit())?;
    let mut canvas = Canvas::new(args.canvas, &domain, metric.as_ref(), size)?;
    file.demand_inside(&canvas)?;
    let road = Road::from(args.dual);
    if road == Road::Canvas {
        canvas = resolve(canvas, metric.as_ref(), seeds, RESOLVE_ROUNDS)?.canvas;
    }
    stage("canvas");
    let diagram = Diagram::by_method(&canvas, metric.as_ref(), seeds, args.geodesic)?;
    stage("diagram");
    let SeedDual { triangles, nerve, mut account, seconds, exact, raw_nerve } =
        recipe::dual(&diagram, metric.as_ref(), road);
    let mesh = diagram.to_mesh(triangles, &nerve, &domain);
    account.crossing_edges = Some(crossing_edges(&mesh).len());
    stage("dual");
    let is_curved = args.edges == EdgesOut::Geodesic || Drawn::has_geodesics(&args.outputs);
    let curved = is_curved.then(|| Realisation::new(&diagram, metric.as_ref(), &mesh.triangles));
    account.geodesics = curved.as_ref().map(report::Geodesics::of);
    if is_curved {
        stage("geodesics");
    }
    let mut report = reported(&mesh, metric.as_ref(), account)?;
    report.histograms = files::histograms(&args.outputs, &mesh, metric.as_ref())?;
    report.canvas = Some(canvas.figures());
    report.diagram = Some(report::Diagram { raw_nerve: Some(raw_nerve), ..report::Diagram::of(&diagram) });
    let net = Drawn::needs_net(&args.outputs).then(|| recipe::net(&diagram, metric.as_ref(), &exact));
    report.net = net.as_ref().map(report::NetFigures::of);
    if net.is_some() {
        stage("net");
    }
    report.notes = notes(&diagram, &report);
    report.options = options(args);
    // Parts of "dual".
    stages.extend(seconds);
    report.seconds = report::Seconds { stages, total: start.elapsed().as_secs_f64() };
    if args.strict {
        demand_embedded(args, &report).or_else(|fault| files::write_report(&args.outputs, &report).and(Err(fault)))?;
    }
    let drawn = Drawn::from_diagram(&args.outputs, &diagram, &mesh, metric.as_ref(), curved.as_ref());
    let drawn = drawn.with_net(&args.outputs, net.as_ref(), MeshOptions::default().protection);
    let file = match &curved {
        Some(curved) if args.edges == EdgesOut::Geodesic => MeshFile::Geodesic(&args.out, curved),
        _ => MeshFile::Straight(&args.out),
    };
    files::write(&file, &args.outputs, &mesh, Some(metric.as_ref()), &report, &drawn)?;
    if let Some(path) = &args.diagram {
        let (canvas, distances) = diagram.to_coloured_canvas();
        output::write_diagram(&canvas, &distances, path)?;
    }
    summary::print(&args.out.display().to_string(), &report, &args.run);
    Ok(())
}

/// The figures of the dual with straight edges, in the metric only where it is valid.
fn reported(mesh: &Mesh, metric: &dyn MetricField, account: report::Dual) -> Result<Report> {
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

/// All options, as used.
fn options(args: &DualArgs) -> serde_json::Value {
    json!({
        "domain": args.domain, "metric": args.metric, "seeds": args.seeds, "out": args.out, "diagram": args.diagram,
        "canvas": args.canvas, "canvas_size": args.canvas_size, "geodesic": args.geodesic, "dual": Road::from(args.dual), "edges": args.edges.name(), "strict": args.strict,
        "background": args.metric_choices.background, "bounds": args.metric_choices.bounds(),
        "smooth_metric": args.metric_choices.smooth_metric,
        "picture": args.outputs.picture, "histograms": args.outputs.histograms, "report": args.outputs.report, "threads": args.run.threads,
    })
}
