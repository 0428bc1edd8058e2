//! `voronaut distance`: how far every point is from given ones, and the way back.

use crate::options::{Coordinates, Damage, MetricChoices, Run, coordinates};
use crate::stages::Stages;
use crate::world::World;
use crate::{account, fields, files, summary};
use clap::{Args, value_parser};
use serde_json::{Value, json};
use std::path::PathBuf;
use voronaut::canvas::{self, BYTES_PER_VERTEX, Canvas, CanvasFigures, Way};
use voronaut::diagram::{Distances, Ground, SurfaceDistances};
use voronaut::geodesic::{Method, Polyline};
use voronaut::geometry::{Aabb3, Point, Point3};
use voronaut::manifold::domain::Domain;
use voronaut::manifold::surface::Mended;
use voronaut::manifold::{Manifold, Place};
use voronaut::mesh::Mesh;
use voronaut::recipe::GradedAt;
use voronaut::triangulation::VertexId;
use voronaut::{Error, Result};
use voronaut_draw::{Layers, Picture, Scene, Stroke, View};
use voronaut_io::Given;

pub(crate) const EXAMPLES: &str = "\
DOMAIN and METRIC are as for `mesh`, or a surface and a metric on it as for `check`; the metric is used as it is. Points near a
surface are moved onto it. METHOD: march (fast marching by lengths, the most accurate),
stvd[:window=8] (Campen 2013), dijkstra, konukoglu (recursive fast marching, 2007), lbr (FM-LBR on a grid of the plane, Mirebeau
2014), heat (Crane 2013).
OUT has the canvas with point data `distance`; the path's points come behind the canvas's, its segments are line cells.

Examples:
  voronaut distance rect:-2,-2,2,2 --metric swirl --from 1,0.5 -o distance.vtu --picture distance.png
  voronaut distance sea.geojson --metric boundary:h0=2 --from 10,20 --from 300,-40 --to 90,80 -o way.vtu --report way.json
  voronaut distance torus:2,0.7 --metric curvature --from 2.7,0,0 --to -1.3,0,0 -o torus.vtu --picture torus.png";

#[derive(Debug, Args)]
pub(crate) struct DistanceArgs {
    /// The domain: a file or a shape
    pub(crate) domain: String,
    /// The metric in which distances are measured
    #[arg(long)]
    pub(crate) metric: String,
    /// Where distances start: a point of the domain; may be given more than once
    #[arg(long, value_name = "X,Y[,Z]", value_parser = coordinates, required = true, allow_hyphen_values = true)]
    pub(crate) from: Vec<Coordinates>,
    /// Trace the shortest path from this point to the nearest of those
    #[arg(long, value_name = "X,Y[,Z]", value_parser = coordinates, allow_hyphen_values = true)]
    pub(crate) to: Option<Coordinates>,
    /// The distances on the canvas, and the path: .vtu
    #[arg(short, long, value_name = "OUT")]
    pub(crate) out: PathBuf,
    /// How distances are computed
    #[arg(long, value_name = "METHOD", default_value_t = Method::default())]
    pub(crate) geodesic: Method,
    /// What distances travel on: intrinsic, isotropic or starset (see `dual`)
    #[arg(long, value_name = "WHICH", default_value_t = canvas::Kind::default())]
    pub(crate) canvas: canvas::Kind,
    /// Vertices of the canvas, in all
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..), default_value_t = CANVAS_VERTICES)]
    pub(crate) canvas_size: u32,
    /// Draw the distances, lines of equal distance and the path: .svg or .png
    #[arg(long, value_name = "FILE")]
    pub(crate) picture: Option<PathBuf>,
    /// Pixels of the picture's longer side
    #[arg(long, value_name = "PIXELS", default_value_t = Picture::default().width, value_parser = value_parser!(u32).range(16..=16_000), requires = "picture")]
    pub(crate) pixels: u32,
    #[command(flatten)]
    pub(crate) metric_choices: MetricChoices,
    #[command(flatten)]
    pub(crate) damage: Damage,
    #[command(flatten)]
    pub(crate) run: Run,
}

/// Vertices of the canvas of `distance`: marching errs by about a thousandth then, in half a second.
const CANVAS_VERTICES: u32 = 40_000;

/// Writes the distance field on the canvas, and the path if there is one.
pub(crate) fn run(args: &DistanceArgs, world: &World) -> Result<()> {
    let stages = Stages::start(world);
    world.file(&args.out).map(voronaut_io::demand_diagram).transpose()?;
    args.picture.as_deref().map(voronaut_draw::is_png).transpose()?;
    files::demand_apart([world.file(&args.out), args.picture.as_deref(), args.run.report.as_deref()])?;
    args.metric_choices.bounds().check()?;
    demand_memory(args)?;
    let (given, mended) = world.given(&args.domain, args.damage.options())?;
    match given {
        Given::Plane(domain) => in_plane(args, world, &domain, &mended, stages),
        Given::Surface(input) => on_surface(args, world, &input, &mended, stages),
    }
}

fn in_plane(args: &DistanceArgs, world: &World, domain: &Domain, mended: &Mended, mut stages: Stages) -> Result<()> {
    let from = args.from.iter().map(|p| flat("--from", p)).collect::<Result<Vec<Point>>>()?;
    let to = args.to.as_ref().map(|p| flat("--to", p)).transpose()?;
    let at = GradedAt::Scale(1.0);
    let metric = fields::in_plane(world, &args.metric, domain, &args.domain, &args.metric_choices, at)?.field;
    stages.end("read");
    let canvas = Canvas::new(args.canvas, domain.planar(), metric.as_ref(), args.canvas_size as usize)?;
    demand_inside(&from, to, &canvas)?;
    stages.end("canvas");
    let found = Distances::new(&canvas, metric.as_ref(), &from, args.geodesic)?;
    stages.end("distances");
    let path = to.map(|to| found.path(to)).transpose()?;
    stages.end("path");
    let asked = json!({
        "from": from.iter().map(|p| [p.x, p.y]).collect::<Vec<_>>(), "to": to.map(|p| [p.x, p.y]),
        "distance": to.and_then(|p| found.at(p)),
        "path_length": path.as_ref().map(|path| path.length), "path_points": path.as_ref().map(|path| path.points.len()),
    });
    let told = told(args, &found, asked, &canvas.figures(), mended, stages);
    let picture = args.picture.as_ref().map(|_| draw(args, &found, path.as_ref())).transpose()?;
    finish(args, world, found.to_mesh(path.as_ref()), picture, &told)
}

/// The distances on a canvas that has the points, moved onto the surface, as vertices.
fn on_surface(args: &DistanceArgs, world: &World, input: &Manifold, mended: &Mended, mut stages: Stages) -> Result<()> {
    let mut places: Vec<Place> = Vec::new();
    let from = args.from.iter().map(|p| Ok(add(on_it("--from", p, input)?, &mut places)));
    let from: Vec<usize> = from.collect::<Result<_>>()?;
    let to = args.to.as_ref().map(|p| on_it("--to", p, input)).transpose()?;
    let to = to.map(|place| add(place, &mut places));
    let metric = fields::on_surface(world, &args.metric, input, &args.metric_choices, GradedAt::Scale(1.0))?;
    stages.end("read");
    let (canvas, at) = Canvas::on_surface(args.canvas, input, metric.as_ref(), args.canvas_size as usize, &places)?;
    stages.end("canvas");
    let from: Vec<VertexId> = from.into_iter().map(|i| at[i]).collect();
    let to = to.map(|i| at[i]);
    let found = SurfaceDistances::on_surface(&canvas, &from, args.geodesic)?;
    stages.end("distances");
    let path = to.map(|to| found.path(to)).transpose()?;
    let position = |&v: &VertexId| canvas.draped().position(v);
    let written = |v: &VertexId| position(v).to_array();
    stages.end("path");
    let asked = json!({
        "from": from.iter().map(written).collect::<Vec<_>>(), "to": to.as_ref().map(written),
        "distance": to.map(|to| found.values()[to.index()]),
        "path_length": path.as_ref().map(|path| path.length), "path_points": path.as_ref().map(|path| path.points.len()),
    });
    let told = told(args, &found, asked, &canvas.figures(), mended, stages);
    let seeds = from.iter().map(position).collect();
    let picture = args.picture.as_ref().map(|_| draw_on(args, &found, seeds, path.as_ref())).transpose()?;
    finish(args, world, found.to_mesh(path.as_ref()), picture, &told)
}

/// Writes the distances on the canvas, and what is beside them.
fn finish(
    args: &DistanceArgs,
    world: &World,
    field: (Mesh, Vec<f64>),
    picture: Option<String>,
    told: &Value,
) -> Result<()> {
    world.go_on()?;
    world.write_diagram(field, Some(&args.out))?;
    files::write_picture(picture, args.picture.as_deref())?;
    world.write_report(format!("{told:#}\n"), &args.run)?;
    summary::print_distance(&args.out, told, &args.run);
    Ok(())
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

/// The place of the surface that is meant.
fn on_it(name: &str, p: &Coordinates, input: &Manifold) -> Result<Place> {
    match *p {
        Coordinates::Space(p) => input.closest(p).map_err(|error| match error {
            Error::Domain { what, help, .. } => Error::domain(what, format!("{name} {p}"), help),
            other => other,
        }),
        Coordinates::Plane(p) => {
            let help = "write three numbers, X,Y,Z; two are for planar domains";
            Err(Error::parse(format!("{name} {p}"), "a point of the plane, and the domain is a surface", help))
        }
    }
}

/// The number of a place among others, which it joins if it is new.
fn add(place: Place, places: &mut Vec<Place>) -> usize {
    let known = places.iter().position(|other| other.position == place.position);
    known.unwrap_or_else(|| {
        places.push(place);
        places.len() - 1
    })
}

fn demand_memory(args: &DistanceArgs) -> Result<()> {
    let needed = f64::from(args.canvas_size) * BYTES_PER_VERTEX;
    if needed <= args.run.limits.memory() as f64 {
        return Ok(());
    }
    let what =
        format!("a canvas of {} vertices needs about {:.1} GiB", args.canvas_size, needed / (1_u64 << 30) as f64);
    Err(Error::limit(what, "lower --canvas-size, or raise --memory-limit"))
}

fn demand_inside(from: &[Point], to: Option<Point>, canvas: &Canvas) -> Result<()> {
    let mut named = from.iter().map(|&p| ("--from", p)).chain(to.map(|p| ("--to", p)));
    match named.find(|(_, p)| canvas.first_outside(&[*p]).is_some()) {
        None => Ok(()),
        Some((name, p)) => {
            Err(Error::domain("a point outside the domain", format!("{name} {p}"), "move it into the domain"))
        }
    }
}

/// The report, with what was asked: `distance` and `path_length` to the point that was asked for, both null without one.
fn told<'a, G: Ground<'a>>(
    args: &DistanceArgs,
    found: &Distances<'a, G>,
    asked: Value,
    canvas: &CanvasFigures,
    mended: &Mended,
    stages: Stages,
) -> Value {
    let reached = found.values().iter().filter(|d| d.is_finite());
    let unreached = found.values().len() - reached.clone().count();
    let figures = json!({
        "farthest": reached.copied().fold(0.0, f64::max), "unreached": unreached,
        "geodesic": args.geodesic, "canvas": canvas, "counters": found.counters(),
        "notes": mended.sentences().collect::<Value>(),
        "seconds": stages.seconds(Vec::new()), "peak_memory_bytes": voronaut_io::peak_memory_bytes(), "version": env!("CARGO_PKG_VERSION"),
        "options": {
            "domain": args.domain, "metric": args.metric, "out": args.out, "canvas": args.canvas,
            "canvas_size": args.canvas_size, "geodesic": args.geodesic, "background": args.metric_choices.background,
            "bounds": args.metric_choices.bounds(), "smooth_metric": args.metric_choices.smooth_metric, "tensor_order": args.metric_choices.tensor_order, "gradation": args.metric_choices.gradation, "picture": args.picture,
            "pixels": args.pixels, "report": args.run.report, "threads": args.run.threads,
            "repair": args.damage.repair,
        },
    });
    account::joined(asked, figures)
}

/// The levels of lines of equal distance in a picture.
fn levels(values: &[f64]) -> Vec<f64> {
    const ISOLINES: u32 = 20;
    let most = values.iter().copied().filter(|d| d.is_finite()).fold(0.0, f64::max);
    (1..ISOLINES).map(|i| most * f64::from(i) / f64::from(ISOLINES)).collect()
}

fn draw(args: &DistanceArgs, found: &Distances, path: Option<&Polyline>) -> Result<String> {
    let (mesh, values) = found.to_mesh(None);
    let grids = found.isolines(&levels(&values)).into_iter().map(|piece| piece.to_vec()).collect();
    let geodesics = path.iter().map(|path| path.points.clone()).collect();
    let layers = Layers { values: Some(values), grids, geodesics, ..Layers::default() };
    let picture = Picture { mesh: false, width: args.pixels, ..Picture::default() };
    voronaut_draw::svg_with(&mesh, None, &picture, &layers)
}

fn draw_on(args: &DistanceArgs, found: &SurfaceDistances, seeds: Vec<Point3>, path: Option<&Way>) -> Result<String> {
    let (mesh, values) = found.to_mesh(None);
    let points: Vec<Point3> = mesh.points.iter().copied().map(Point3::from).collect();
    let Some(bounds) = Aabb3::of(points.iter().copied()) else { return Ok(String::new()) };
    let lines = found.isolines(&levels(&values)).into_iter().map(|piece| piece.to_vec());
    let scene = Scene::of_values(&points, &mesh.triangles, &values)
        .with(lines, Stroke::Level)
        .with(path.map(|path| path.points.clone()), Stroke::Geodesic)
        .with(seeds.into_iter().map(|seed| vec![seed]), Stroke::Seed);
    voronaut_draw::draw_surface(&scene, &View { pixels: args.pixels, ..View::of(bounds) })
}
