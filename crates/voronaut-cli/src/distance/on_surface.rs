//! Distances on a surface.

use super::args::DistanceArgs;
use super::told::{Asked, Made, levels, seconds, told};
use crate::fields;
use crate::options::Coordinates;
use std::time::Instant;
use voronaut::canvas::{Canvas, Way};
use voronaut::diagram::SurfaceDistances;
use voronaut::geometry::{Aabb3, Point3};
use voronaut::mesh::Mesh;
use voronaut::surface::{Input, Place};
use voronaut::triangulation::VertexId;
use voronaut::{Error, Result};
use voronaut_draw::{Scene, Stroke, View};

/// The distances on a canvas that has the points, moved onto the surface, as vertices.
pub(super) fn run(args: &DistanceArgs, input: &Input, start: Instant) -> Result<Made> {
    let mut places: Vec<Place> = Vec::new();
    let from = args.from.iter().map(|p| Ok(add(on_surface("--from", p, input)?, &mut places)));
    let from: Vec<usize> = from.collect::<Result<_>>()?;
    let to = args.to.as_ref().map(|p| on_surface("--to", p, input)).transpose()?;
    let to = to.map(|place| add(place, &mut places));
    let metric = fields::on_surface(&args.metric, input, &args.metric_choices)?;
    let read = start.elapsed().as_secs_f64();
    let (canvas, at) = Canvas::on_surface(args.canvas, input, metric.as_ref(), args.canvas_size as usize, &places)?;
    let made = start.elapsed().as_secs_f64();
    let from: Vec<VertexId> = from.into_iter().map(|i| at[i]).collect();
    let to = to.map(|i| at[i]);
    let found = SurfaceDistances::on_surface(&canvas, &from, args.geodesic)?;
    let solved = start.elapsed().as_secs_f64();
    let path = to.map(|to| found.path(to)).transpose()?;
    let position = |&v: &VertexId| canvas.draped().position(v);
    let written = |v: &VertexId| position(v).to_array().to_vec();
    let asked = Asked {
        from: from.iter().map(written).collect(),
        to: to.as_ref().map(written),
        distance: to.map(|to| found.values()[to.index()]),
        path: path.as_ref().map(|path| (path.length, path.points.len())),
    };
    let told = told(args, &found, &asked, &canvas.figures(), &seconds(&[read, made, solved], start));
    let seeds = from.iter().map(position).collect();
    let picture = args.picture.as_ref().map(|_| draw(args, &found, seeds, path.as_ref())).transpose()?;
    let (mesh, distances) = found.to_mesh(path.as_ref());
    Ok(Made { mesh, distances, picture, told })
}

/// The number of a place among others, which it joins if it is new.
fn add(place: Place, places: &mut Vec<Place>) -> usize {
    let known = places.iter().position(|other| other.position == place.position);
    known.unwrap_or_else(|| {
        places.push(place);
        places.len() - 1
    })
}

/// The place of the surface that is meant.
fn on_surface(name: &str, p: &Coordinates, input: &Input) -> Result<Place> {
    match *p {
        Coordinates::Space(p) => input.closest(p).map_err(|error| match error {
            Error::Domain { what, help, .. } => Error::Domain { what, place: format!("{name} {p}"), help },
            other => other,
        }),
        Coordinates::Plane(p) => {
            let help = "write three numbers, X,Y,Z; two are for planar domains";
            Err(Error::parse(format!("{name} {p}"), "a point of the plane, and the domain is a surface", help))
        }
    }
}

fn draw(args: &DistanceArgs, found: &SurfaceDistances, seeds: Vec<Point3>, path: Option<&Way>) -> Result<String> {
    let (mesh, values): (Mesh, Vec<f64>) = found.to_mesh(None);
    let points: Vec<Point3> = mesh.points.iter().copied().map(Point3::from).collect();
    let Some(bounds) = Aabb3::of(points.iter().copied()) else { return Ok(String::new()) };
    let lines = found.isolines(&levels(&values)).into_iter().map(|piece| piece.to_vec());
    let scene = Scene::of_values(&points, &mesh.triangles, &values)
        .with(lines, Stroke::Level)
        .with(path.map(|path| path.points.clone()), Stroke::Geodesic)
        .with(seeds.into_iter().map(|seed| vec![seed]), Stroke::Seed);
    voronaut_draw::draw_surface(&scene, &View { pixels: args.pixels, ..View::of(bounds) })
}
