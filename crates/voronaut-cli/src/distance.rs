//! `voronaut distance`: how far every point is from given ones, and the way back.

mod on_surface;

use crate::args::{Coordinates, DistanceArgs, Outputs};
use crate::{files, metric};
use serde_json::{Value, json};
use std::time::Instant;
use voronaut::canvas::{BYTES_PER_VERTEX, Canvas, CanvasFigures};
use voronaut::diagram::{Distances, Ground};
use voronaut::domain::Domain;
use voronaut::geodesic::Polyline;
use voronaut::geometry::Point;
use voronaut::mesh::Mesh;
use voronaut::output::{self, Layers, Picture, report};
use voronaut::recipe::GradedAt;
use voronaut::surface::Given;
use voronaut::{Error, Result};

/// Lines of equal distance in a picture.
const ISOLINES: u32 = 20;

/// Writes the distance field on the canvas, and the path if there is one.
pub(crate) fn run(args: &DistanceArgs) -> Result<()> {
    let start = Instant::now();
    output::demand_diagram(&args.out)?;
    files::demand_writable(Some(&args.out), None, &outputs(args))?;
    files::set_threads(&args.run)?;
    args.metric_choices.bounds().check()?;
    demand_memory(args)?;
    let (given, mended) = Given::read_with(&args.domain, None, args.damage.options())?;
    let mut made = match given {
        Given::Plane(domain) => in_plane(args, &domain, start)?,
        Given::Surface(input) => on_surface::run(args, &input, start)?,
    };
    made.told["notes"] = mended.sentences().collect();
    output::write_diagram(&made.mesh, &made.distances, &args.out)?;
    if let (Some(file), Some(svg)) = (&args.picture, &made.picture) {
        output::write_picture(svg, file)?;
    }
    if let Some(file) = &args.report {
        output::write(file, format!("{:#}\n", made.told).as_bytes())?;
    }
    crate::summary::print_distance(&args.out.display().to_string(), &made.told, &args.run);
    Ok(())
}

/// What is written.
struct Made {
    mesh: Mesh,
    distances: Vec<f64>,
    picture: Option<String>,
    told: Value,
}

fn in_plane(args: &DistanceArgs, domain: &Domain, start: Instant) -> Result<Made> {
    let from = args.from.iter().map(|p| flat("--from", p)).collect::<Result<Vec<Point>>>()?;
    let to = args.to.iter().map(|p| flat("--to", p)).next().transpose()?;
    let at = GradedAt::Scale(1.0);
    let metric = metric::in_plane(&args.metric, domain, &args.domain, &args.metric_choices, at)?.field;
    let read = start.elapsed().as_secs_f64();
    let canvas = Canvas::new(args.canvas, domain, metric.as_ref(), args.canvas_size as usize)?;
    demand_inside(&from, to, &canvas)?;
    let made = start.elapsed().as_secs_f64();
    let found = Distances::new(&canvas, metric.as_ref(), &from, args.geodesic)?;
    let solved = start.elapsed().as_secs_f64();
    let path = to.map(|to| found.path(to)).transpose()?;
    let asked = Asked {
        from: from.iter().map(|p| vec![p.x, p.y]).collect(),
        to: to.map(|p| vec![p.x, p.y]),
        distance: to.and_then(|p| found.at(p)),
        path: path.as_ref().map(|path| (path.length, path.points.len())),
    };
    let told = told(args, &found, &asked, &canvas.figures(), &seconds(&[read, made, solved], start));
    let picture = args.picture.as_ref().map(|_| draw(args, &found, path.as_ref())).transpose()?;
    let (mesh, distances) = found.to_mesh(path.as_ref());
    Ok(Made { mesh, distances, picture, told })
}

/// A point of the plane.
fn flat(name: &str, p: &Coordinates) -> Result<Point> {
    match *p {
        Coordinates::Plane(p) => Ok(p),
        Coordinates::Space(p) => {
            let help = "write two numbers, X,Y; three are for surfaces";
            Err(Error::parse(format!("{name} {p}"), "a point of space, and the domain is planar", help))
        }
    }
}

/// From the times at which stages ended, and the last one now.
fn seconds(ends: &[f64; 3], start: Instant) -> report::Seconds {
    let ([read, made, solved], total) = (ends, start.elapsed().as_secs_f64());
    let stages = vec![("read", *read), ("canvas", made - read), ("distances", solved - made), ("path", total - solved)];
    report::Seconds { stages, total }
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

fn demand_inside(from: &[Point], to: Option<Point>, canvas: &Canvas) -> Result<()> {
    let named = from.iter().map(|&p| ("--from", p)).chain(to.map(|p| ("--to", p)));
    for (name, p) in named {
        if canvas.locate(p).is_none() {
            return Err(Error::domain("a point outside the domain", format!("{name} {p}"), "move it into the domain"));
        }
    }
    Ok(())
}

/// The levels of lines of equal distance.
fn levels(values: &[f64]) -> Vec<f64> {
    let most = values.iter().copied().filter(|d| d.is_finite()).fold(0.0, f64::max);
    (1..ISOLINES).map(|i| most * f64::from(i) / f64::from(ISOLINES)).collect()
}

fn draw(args: &DistanceArgs, found: &Distances, path: Option<&Polyline>) -> Result<String> {
    let (mesh, values) = found.to_mesh(None);
    let lines: Vec<Vec<Point>> = found.isolines(&levels(&values)).into_iter().map(|piece| piece.to_vec()).collect();
    let geodesics: Vec<Vec<Point>> = path.iter().map(|path| path.points.clone()).collect();
    let layers = Layers { values: Some(&values), grids: &lines, geodesics: &geodesics, ..Layers::default() };
    let picture = Picture { mesh: false, width: args.pixels, ..Picture::default() };
    output::svg_with(&mesh, None, &picture, &layers)
}

/// Where distances start, and what was found of the point that was asked for: its distance, the path's length and points.
struct Asked {
    from: Vec<Vec<f64>>,
    to: Option<Vec<f64>>,
    distance: Option<f64>,
    path: Option<(f64, usize)>,
}

/// The report: `distance` and `path_length` to the point that was asked for, both null without one.
fn told<'a, G: Ground<'a>>(
    args: &DistanceArgs,
    found: &Distances<'a, G>,
    asked: &Asked,
    canvas: &CanvasFigures,
    seconds: &report::Seconds,
) -> Value {
    let reached = found.values().iter().filter(|d| d.is_finite());
    let unreached = found.values().len() - reached.clone().count();
    json!({
        "from": asked.from, "to": asked.to,
        "distance": asked.distance.filter(|d| d.is_finite()),
        "path_length": asked.path.map(|path| path.0), "path_points": asked.path.map(|path| path.1),
        "farthest": reached.copied().fold(0.0, f64::max), "unreached": unreached,
        "geodesic": args.geodesic, "canvas": canvas, "counters": found.counters(),
        "seconds": seconds, "peak_memory_bytes": report::peak_memory_bytes(), "version": env!("CARGO_PKG_VERSION"),
        "options": {
            "domain": args.domain, "metric": args.metric, "out": args.out, "canvas": args.canvas,
            "canvas_size": args.canvas_size, "geodesic": args.geodesic, "background": args.metric_choices.background,
            "bounds": args.metric_choices.bounds(), "smooth_metric": args.metric_choices.smooth_metric, "tensor_order": args.metric_choices.tensor_order, "gradation": args.metric_choices.gradation, "picture": args.picture,
            "pixels": args.pixels, "report": args.report, "threads": args.run.threads,
            "repair": args.damage.repair,
        },
    })
}
