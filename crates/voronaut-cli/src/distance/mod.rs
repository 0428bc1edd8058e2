//! `voronaut distance`: how far every point is from given ones, and the way back.

mod args;
mod on_surface;
mod told;

pub(crate) use args::{DistanceArgs, EXAMPLES};

use crate::options::{Coordinates, Outputs};
use crate::{fields, files};
use std::time::Instant;
use told::{Asked, Made, levels, seconds, told};
use voronaut::canvas::{BYTES_PER_VERTEX, Canvas};
use voronaut::diagram::Distances;
use voronaut::domain::Domain;
use voronaut::geodesic::Polyline;
use voronaut::geometry::Point;
use voronaut::recipe::GradedAt;
use voronaut::{Error, Result};
use voronaut_draw::{Layers, Picture};
use voronaut_io::Given;

/// Writes the distance field on the canvas, and the path if there is one.
pub(crate) fn run(args: &DistanceArgs) -> Result<()> {
    let start = Instant::now();
    voronaut_io::demand_diagram(&args.out)?;
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
    voronaut_io::write_diagram(&made.mesh, &made.distances, &args.out)?;
    if let (Some(file), Some(svg)) = (&args.picture, &made.picture) {
        files::write_picture(svg, file)?;
    }
    if let Some(file) = &args.report {
        voronaut_io::write(file, format!("{:#}\n", made.told).as_bytes())?;
    }
    crate::summary::print_distance(&args.out.display().to_string(), &made.told, &args.run);
    Ok(())
}

fn in_plane(args: &DistanceArgs, domain: &Domain, start: Instant) -> Result<Made> {
    let from = args.from.iter().map(|p| flat("--from", p)).collect::<Result<Vec<Point>>>()?;
    let to = args.to.iter().map(|p| flat("--to", p)).next().transpose()?;
    let at = GradedAt::Scale(1.0);
    let metric = fields::in_plane(&args.metric, domain, &args.domain, &args.metric_choices, at)?.field;
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

fn draw(args: &DistanceArgs, found: &Distances, path: Option<&Polyline>) -> Result<String> {
    let (mesh, values) = found.to_mesh(None);
    let lines: Vec<Vec<Point>> = found.isolines(&levels(&values)).into_iter().map(|piece| piece.to_vec()).collect();
    let geodesics: Vec<Vec<Point>> = path.iter().map(|path| path.points.clone()).collect();
    let layers = Layers { values: Some(&values), grids: &lines, geodesics: &geodesics, ..Layers::default() };
    let picture = Picture { mesh: false, width: args.pixels, ..Picture::default() };
    voronaut_draw::svg_with(&mesh, None, &picture, &layers)
}
