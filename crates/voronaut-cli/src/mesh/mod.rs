//! `voronaut mesh`: from the command line to the library and back. All calls of the mesher are here.

mod account;
mod args;
mod on_surface;

pub(crate) use account::{fill_in, ours};
pub(crate) use args::{EXAMPLES, MeshArgs};

use crate::files::{Drawn, MeshFile};
use crate::progress::Bar;
use crate::{fields, files, summary};
use std::time::Instant;
use voronaut::canvas::{Canvas, VERTICES_PER_SEED};
use voronaut::diagram::Diagram;
use voronaut::domain::Domain;
use voronaut::geometry::Point;
use voronaut::mesh::Mesh;
use voronaut::metric::MetricField;
use voronaut::quality::{interpolation_error, metric_quality, unmet, validity};
use voronaut::recipe::{self, Aim, GradedAt};
use voronaut::{Error, Result};
use voronaut_io::{Given, Report, Seconds};

/// Meshes a domain. Nothing is written unless the mesh is valid.
pub(crate) fn run(args: &MeshArgs) -> Result<()> {
    let start = Instant::now();
    files::demand_writable(Some(&args.out), None, &args.outputs)?;
    files::set_threads(&args.run)?;
    let bounds = args.metric_choices.bounds();
    bounds.check()?;
    let (given, mended) = Given::read_with(&args.domain, None, args.damage.options())?;
    let domain = match given {
        Given::Surface(input) => return on_surface::run(args, input, &mended, start),
        Given::Plane(domain) => domain,
    };
    demand_planar(args)?;
    let at = GradedAt::of(args.options().vertices, args.complexity);
    let made = fields::in_plane(&args.metric, &domain, &args.domain, &args.metric_choices, at)?;
    let (metric, aim) = (made.field.as_ref(), made.aim(args.metric_choices.norm));
    let meshed = {
        let bar = Bar::new(args.run.quiet, args.run.verbose);
        recipe::mesh_for(&domain, metric, aim, &args.options(), &bar)?
    };
    let found = validity(&meshed.mesh);
    found.demand().map_err(ours)?;
    let scaled = |p: Point| metric.at(p) * meshed.metric_scale;
    let figures = metric_quality(&meshed.mesh, &scaled)?;
    let mut report = Report::new(found, meshed.mesh.points.len(), meshed.mesh.triangles.len()).with_quality(&figures);
    fill_in(&mut report, &meshed, args.as_used());
    report.notes.extend(mended.sentences());
    let unmet = unmet(&meshed.mesh, &scaled)?;
    report.unmet = Some(unmet.figures());
    report.histograms = files::histograms(&args.outputs, &meshed.mesh, &scaled)?;
    let error = |aim: Aim| interpolation_error(&meshed.mesh, aim.function, aim.norm);
    report.interpolation = aim.map(error).transpose()?;
    report.seconds = Seconds { stages: meshed.seconds.clone(), total: start.elapsed().as_secs_f64() };
    let drawn = drawn(args, &domain, &meshed.mesh, &scaled)?;
    let drawn =
        drawn.with_net(&args.outputs, meshed.net.as_ref(), args.protection).with_unmet(&args.outputs, Some(unmet));
    files::write(&MeshFile::Straight(&args.out), &args.outputs, &meshed.mesh, Some(&scaled), &report, &drawn)?;
    summary::print(&args.out.display().to_string(), &report, &args.run);
    Ok(())
}

/// The diagram of the mesh's vertices, made only to be drawn.
fn drawn(args: &MeshArgs, domain: &Domain, mesh: &Mesh, metric: &dyn MetricField) -> Result<Drawn> {
    if !Drawn::is_wanted(&args.outputs) {
        return Ok(Drawn::default());
    }
    let seeds: Vec<Point> = mesh.points.iter().map(|p| Point::new(p[0], p[1])).collect();
    let size = (VERTICES_PER_SEED as usize).saturating_mul(seeds.len());
    let canvas = Canvas::new(args.canvas, domain, metric, size)?;
    Ok(Drawn::from_diagram(&args.outputs, &Diagram::new(&canvas, metric, &seeds)?, mesh, metric, None))
}

/// Refuses what is for surfaces.
fn demand_planar(args: &MeshArgs) -> Result<()> {
    if args.fit {
        let what = "--fit in the plane".into();
        return Err(Error::Unsupported { what, help: "leave out --fit: it is for surfaces".into() });
    }
    Ok(())
}
