//! `voronaut mesh`: from the command line to the library and back. All calls of the mesher are here.

mod args;

pub(crate) use args::{EXAMPLES, MeshArgs};

use crate::options::{Show, refuse};
use crate::progress::Bar;
use crate::{account, fields, files, pictures};
use std::time::Instant;
use voronaut::Result;
use voronaut::canvas::{self, Canvas, VERTICES_PER_SEED};
use voronaut::diagram::{Diagram, SurfaceDiagram};
use voronaut::domain::Domain;
use voronaut::geodesic::Method;
use voronaut::geometry::Point;
use voronaut::mesh::Mesh;
use voronaut::metric::MetricField;
use voronaut::quality::interpolation_error;
use voronaut::realisation::Realisation;
use voronaut::recipe::{self, Aim, GradedAt};
use voronaut::surface::{Input, Mended};
use voronaut_draw::Layers;
use voronaut_io::{Given, Report};

/// What is written of a valid mesh.
struct Made {
    mesh: Mesh,
    report: Report,
    picture: Option<String>,
}

/// Meshes a domain. Nothing is written unless the mesh is valid.
pub(crate) fn run(args: &MeshArgs) -> Result<()> {
    let start = Instant::now();
    files::demand_writable(Some(&args.out), None, &args.outputs, &args.run)?;
    args.run.set_threads()?;
    args.metric_choices.bounds().check()?;
    let (given, mended) = Given::read_with(&args.domain, None, args.damage.options())?;
    let Made { mesh, report, picture } = match given {
        Given::Surface(input) => on_surface(args, input, &mended, start)?,
        Given::Plane(domain) => in_plane(args, &domain, &mended, start)?,
    };
    voronaut_io::write_mesh(&mesh, &args.out)?;
    files::finish(&args.out, &args.outputs, picture, &report, &args.run)
}

fn in_plane(args: &MeshArgs, domain: &Domain, mended: &Mended, start: Instant) -> Result<Made> {
    refuse([(args.fit, "--fit in the plane", "leave out --fit: it is for surfaces")])?;
    let (outputs, options) = (&args.outputs, args.options());
    let at = GradedAt::of(options.vertices, args.complexity);
    let made = fields::in_plane(&args.metric, domain, &args.domain, &args.metric_choices, at)?;
    let (metric, aim) = (made.field.as_ref(), made.aim(args.metric_choices.norm));
    let meshed = recipe::mesh_for(domain, metric, aim, &options, &Bar::new(&args.run))?;
    let mesh = &meshed.mesh;
    let scaled = |p: Point| metric.at(p) * meshed.metric_scale;
    let (mut report, unmet) = account::in_plane(&meshed, &scaled, args.as_used())?;
    report.notes.extend(mended.sentences());
    report.histograms = files::histograms(outputs, mesh, &scaled)?;
    let error = |aim: Aim| interpolation_error(mesh, aim.function, aim.norm);
    report.interpolation = aim.map(error).transpose()?;
    report.seconds.total = start.elapsed().as_secs_f64();
    let layers = Layers {
        protection: pictures::protection(outputs, meshed.net.as_ref(), args.protection),
        unmet: Some(unmet).filter(|_| outputs.shows(Show::Unmet)),
        ..cells(args, domain, mesh, &scaled)?
    };
    let picture = pictures::in_plane(outputs, mesh, Some(&scaled), &layers)?;
    Ok(Made { mesh: meshed.mesh, report, picture })
}

/// The diagram of the mesh's vertices, made only to be drawn.
fn cells(args: &MeshArgs, domain: &Domain, mesh: &Mesh, metric: &dyn MetricField) -> Result<Layers> {
    if !args.outputs.need_diagram() {
        return Ok(Layers::default());
    }
    let seeds: Vec<Point> = mesh.points.iter().map(|p| Point::new(p[0], p[1])).collect();
    let size = (VERTICES_PER_SEED as usize).saturating_mul(seeds.len());
    let canvas = Canvas::new(args.canvas, domain, metric, size)?;
    let diagram = Diagram::new(&canvas, metric, &seeds)?;
    let curved = args.outputs.have_geodesics().then(|| Realisation::new(&diagram, metric, &mesh.triangles));
    Ok(pictures::layers(&args.outputs, &diagram, metric, curved.as_ref()))
}

fn on_surface(args: &MeshArgs, input: Input, mended: &Mended, start: Instant) -> Result<Made> {
    pictures::demand_of_surfaces(&args.outputs, &[])?;
    let whole = args.outputs.picture.is_some().then(|| Input::new(input.surface.clone(), input.implicit.clone()));
    let input = &input.cut(&args.features())?;
    let metric = fields::on_surface(&args.metric, input, &args.metric_choices)?;
    let meshed = recipe::mesh_surface(input, metric.as_ref(), &args.options(), &Bar::new(&args.run))?;
    let mut report = account::on_surface(&meshed, input, mended, metric.as_ref(), args.as_used())?;
    report.seconds.total = start.elapsed().as_secs_f64();
    let picture = whole.map(|whole| drawn_on(args, &whole, &meshed.mesh)).transpose()?;
    Ok(Made { mesh: meshed.mesh, report, picture })
}

/// The mesh of a surface that is whole: cells are drawn across creases.
fn drawn_on(args: &MeshArgs, whole: &Input, mesh: &Mesh) -> Result<String> {
    let metric = fields::on_surface(&args.metric, whole, &args.metric_choices)?;
    let places = mesh.points.iter().map(|&p| whole.closest(p.into())).collect::<Result<Vec<_>>>()?;
    let size = canvas::size_for(places.len(), args.canvas_size);
    let (canvas, at) = Canvas::on_surface(args.canvas, whole, metric.as_ref(), size, &places)?;
    pictures::on_surface(&args.outputs, &SurfaceDiagram::on_surface(&canvas, &at, Method::March)?, mesh)
}
