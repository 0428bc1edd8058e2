//! `voronaut distance`: how far every point is from given ones, and the way back.

use crate::args::{DistanceArgs, Outputs};
use crate::files;
use serde_json::{Value, json};
use std::path::Path;
use std::time::Instant;
use voronaut::canvas::{BYTES_PER_VERTEX, Canvas};
use voronaut::diagram::Distances;
use voronaut::domain::Domain;
use voronaut::geodesic::Polyline;
use voronaut::geometry::Point;
use voronaut::metric::MetricSpec;
use voronaut::output::{self, Layers, Picture, report};
use voronaut::recipe;
use voronaut::{Error, Result};

/// Lines of equal distance in a picture.
const ISOLINES: u32 = 20;

/// Writes the distance field on the canvas, and the path if there is one.
pub(crate) fn run(args: &DistanceArgs) -> Result<()> {
    let start = Instant::now();
    output::demand_diagram(&args.out)?;
    files::demand_writable(Some(&args.out), None, &outputs(args))?;
    files::set_threads(&args.run)?;
    let bounds = args.metric_choices.bounds();
    bounds.check()?;
    demand_memory(args)?;
    let spec = MetricSpec::parse(&args.metric)?;
    let domain = Domain::read(&args.domain)?;
    let own = matches!(spec, MetricSpec::File(_)).then_some(Path::new(&args.domain));
    let background = args.metric_choices.background.as_deref().or(own);
    let metric = recipe::metric(&spec, &domain, background, bounds)?;
    let metric = recipe::smooth_metric(metric, &domain, background, args.metric_choices.smooth_metric)?;
    let read = start.elapsed().as_secs_f64();
    let canvas = Canvas::new(args.canvas, &domain, metric.as_ref(), args.canvas_size as usize)?;
    demand_inside(args, &canvas)?;
    let made = start.elapsed().as_secs_f64();
    let found = Distances::new(&canvas, metric.as_ref(), &args.from, args.geodesic)?;
    let solved = start.elapsed().as_secs_f64();
    let path = args.to.map(|to| found.path(to)).transpose()?;
    let total = start.elapsed().as_secs_f64();
    let stages = vec![("read", read), ("canvas", made - read), ("distances", solved - made), ("path", total - solved)];
    let seconds = report::Seconds { stages, total };
    let told = told(args, &found, path.as_ref(), &canvas, &seconds);
    let picture = args.picture.as_deref().map(|file| Ok((file, draw(args, &found, path.as_ref())?))).transpose()?;
    let (mesh, distances) = found.to_mesh(path.as_ref());
    output::write_diagram(&mesh, &distances, &args.out)?;
    picture.map(|(file, svg)| output::write_picture(&svg, file)).transpose()?;
    if let Some(file) = &args.report {
        let text = format!("{told:#}\n");
        output::write(file, text.as_bytes())?;
    }
    crate::summary::print_distance(&args.out.display().to_string(), &told, &args.run);
    Ok(())
}

/// What is written beside the field.
fn outputs(args: &DistanceArgs) -> Outputs {
    Outputs {
        picture: args.picture.clone(),
        show: Vec::new(),
        pixels: args.pixels,
        window: None,
        histograms: None,
        report: args.report.clone(),
    }
}

fn demand_memory(args: &DistanceArgs) -> Result<()> {
    let needed = f64::from(args.canvas_size) * BYTES_PER_VERTEX;
    if needed <= args.memory_limit() as f64 {
        return Ok(());
    }
    let what =
        format!("a canvas of {} vertices needs about {:.1} GiB", args.canvas_size, needed / (1_u64 << 30) as f64);
    Err(Error::Limit { what, help: "lower --canvas-size, or raise --memory-limit".into() })
}

fn demand_inside(args: &DistanceArgs, canvas: &Canvas) -> Result<()> {
    let named = args.from.iter().map(|&p| ("--from", p)).chain(args.to.map(|p| ("--to", p)));
    for (name, p) in named {
        if canvas.locate(p).is_none() {
            return Err(Error::domain("a point outside the domain", format!("{name} {p}"), "move it into the domain"));
        }
    }
    Ok(())
}

fn draw(args: &DistanceArgs, found: &Distances, path: Option<&Polyline>) -> Result<String> {
    let (mesh, values) = found.to_mesh(None);
    let most = values.iter().copied().filter(|d| d.is_finite()).fold(0.0, f64::max);
    let levels: Vec<f64> = (1..ISOLINES).map(|i| most * f64::from(i) / f64::from(ISOLINES)).collect();
    let lines: Vec<Vec<Point>> = found.isolines(&levels).into_iter().map(|piece| piece.to_vec()).collect();
    let geodesics: Vec<Vec<Point>> = path.iter().map(|path| path.points.clone()).collect();
    let layers = Layers { values: Some(&values), grids: &lines, geodesics: &geodesics, ..Layers::default() };
    let picture = Picture { mesh: false, width: args.pixels, ..Picture::default() };
    output::svg_with(&mesh, None, &picture, &layers)
}

/// The report: `distance` and `path_length` to the point that was asked for, both null without one.
fn told(
    args: &DistanceArgs,
    found: &Distances,
    path: Option<&Polyline>,
    canvas: &Canvas,
    seconds: &report::Seconds,
) -> Value {
    let reached = found.values().iter().filter(|d| d.is_finite());
    let unreached = found.values().len() - reached.clone().count();
    let bounds = args.metric_choices.bounds();
    let to = args.to.map(|p| [p.x, p.y]);
    let from: Vec<[f64; 2]> = args.from.iter().map(|p| [p.x, p.y]).collect();
    json!({
        "from": from, "to": to,
        "distance": args.to.and_then(|p| found.at(p)).filter(|d| d.is_finite()),
        "path_length": path.map(|path| path.length), "path_points": path.map(|path| path.points.len()),
        "farthest": reached.copied().fold(0.0, f64::max), "unreached": unreached,
        "geodesic": args.geodesic, "canvas": canvas.figures(), "counters": found.counters(),
        "seconds": seconds, "peak_memory_bytes": report::peak_memory_bytes(), "version": env!("CARGO_PKG_VERSION"),
        "options": {
            "domain": args.domain, "metric": args.metric, "out": args.out, "canvas": args.canvas,
            "canvas_size": args.canvas_size, "geodesic": args.geodesic, "background": args.metric_choices.background,
            "bounds": bounds, "smooth_metric": args.metric_choices.smooth_metric, "picture": args.picture,
            "pixels": args.pixels, "report": args.report, "threads": args.run.threads,
        },
    })
}
