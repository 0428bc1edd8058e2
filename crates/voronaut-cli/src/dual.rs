//! `voronaut dual`: diagram and dual of the seeds given.

use crate::args::DualArgs;
use crate::{files, summary};
use serde_json::json;
use std::path::Path;
use std::time::Instant;
use voronaut::canvas::Canvas;
use voronaut::diagram::Diagram;
use voronaut::domain::Domain;
use voronaut::formats::points;
use voronaut::metric::MetricSpec;
use voronaut::output::{self, Report, report};
use voronaut::quality::{metric_quality, validity};
use voronaut::recipe;
use voronaut::{Error, Result};

/// Canvas vertices at least: a few seeds' cells are large, and so is what the metric does within them.
const LEAST_CANVAS: usize = 20_000;

/// The nerve of the seeds' cells with straight edges. Triangles that come out inverted are counted, not refused.
pub(crate) fn run(args: &DualArgs) -> Result<()> {
    let start = Instant::now();
    files::demand_writable(Some(&args.out), &args.outputs)?;
    if let Some(path) = &args.diagram {
        output::demand_diagram(path)?;
        output::demand_directory(path)?;
    }
    files::set_threads(&args.run)?;
    let bounds = args.metric_choices.bounds();
    bounds.check()?;
    let spec = MetricSpec::parse(&args.metric)?;
    let domain = Domain::read(&args.domain)?;
    let own = matches!(spec, MetricSpec::File(_)).then_some(Path::new(&args.domain));
    let metric = recipe::metric(&spec, &domain, args.metric_choices.background.as_deref().or(own), bounds)?;
    let text = std::fs::read_to_string(&args.seeds).map_err(|source| Error::Io { path: args.seeds.clone(), source })?;
    let seeds = points::read(&text, &args.seeds.display().to_string())?;
    let mut stages = Vec::new();
    let mut begin = start;
    let mut stage = |name: &'static str| {
        stages.push((name, begin.elapsed().as_secs_f64()));
        begin = Instant::now();
    };
    stage("read");
    let size = (args.canvas_size as usize).saturating_mul(seeds.len()).max(LEAST_CANVAS);
    let canvas = Canvas::intrinsic(&domain, metric.as_ref(), size)?;
    stage("canvas");
    let diagram = Diagram::new(&canvas, metric.as_ref(), &seeds)?;
    stage("diagram");
    let mesh = diagram.to_mesh(&diagram.sharp_nerve(), &domain);
    stage("nerve");
    let found = validity(&mesh);
    let inverted = found.inverted;
    let fault = if args.strict { found.demand().err() } else { None };
    let is_valid = found.valid;
    let mut report = Report::new(found, mesh.points.len(), mesh.triangles.len());
    if is_valid {
        report = report.with_quality(&metric_quality(&mesh, metric.as_ref())?);
    }
    report.canvas = Some(report::Canvas { kind: "intrinsic".into(), vertices: canvas.vertex_count() });
    report.diagram = Some(report::Diagram { orphans: diagram.orphans().len() });
    report.notes = notes(&diagram, inverted);
    report.options = options(args);
    report.seconds = report::Seconds { stages, total: start.elapsed().as_secs_f64() };
    if let Some(fault) = fault {
        files::write_report(&args.outputs, &report)?;
        return Err(fault);
    }
    files::write(Some(&args.out), &args.outputs, &mesh, Some(metric.as_ref()), &report)?;
    if let Some(path) = &args.diagram {
        let (canvas, distances) = diagram.to_coloured_canvas();
        output::write_diagram(&canvas, &distances, path)?;
    }
    summary::print(&args.out.display().to_string(), &report, &args.run);
    Ok(())
}

fn notes(diagram: &Diagram, inverted: usize) -> Vec<String> {
    let mut notes = Vec::new();
    if inverted > 0 {
        notes
            .push(format!("{inverted} straight triangles come out inverted: the dual does not embed with these seeds"));
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
        "canvas": "intrinsic", "canvas_size": args.canvas_size, "geodesic": "march", "strict": args.strict,
        "background": args.metric_choices.background, "bounds": args.metric_choices.bounds(),
        "picture": args.outputs.picture, "report": args.outputs.report, "threads": args.run.threads,
    })
}
