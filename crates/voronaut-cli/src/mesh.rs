//! `voronaut mesh`: from the command line to the library and back. All calls of the mesher are here.

use crate::args::MeshArgs;
use crate::files::{Drawn, MeshFile};
use crate::progress::Bar;
use crate::{files, metric, summary, surfaces};
use serde_json::{Value, json};
use std::time::Instant;
use voronaut::canvas::{Canvas, VERTICES_PER_SEED};
use voronaut::diagram::Diagram;
use voronaut::domain::Domain;
use voronaut::geometry::Point;
use voronaut::mesh::Mesh;
use voronaut::metric::MetricField;
use voronaut::output::Report;
use voronaut::output::report::{NetFigures, Seconds};
use voronaut::quality::{interpolation_error, metric_quality, unmet, validity};
use voronaut::recipe::{self, Aim, GradedAt, Meshed};
use voronaut::surface::Given;
use voronaut::{Error, Result};

/// Meshes a domain. Nothing is written unless the mesh is valid.
pub(crate) fn run(args: &MeshArgs) -> Result<()> {
    let start = Instant::now();
    files::demand_writable(Some(&args.out), None, &args.outputs)?;
    files::set_threads(&args.run)?;
    let bounds = args.metric_choices.bounds();
    bounds.check()?;
    let (given, mended) = Given::read_with(&args.domain, None, args.damage.options())?;
    let domain = match given {
        Given::Surface(input) => return surfaces::mesh(args, input, &mended, start),
        Given::Plane(domain) => domain,
    };
    demand_planar(args)?;
    let at = GradedAt::of(args.options().vertices, args.complexity);
    let made = metric::in_plane(&args.metric, &domain, &args.domain, &args.metric_choices, at)?;
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
    fill_in(&mut report, &meshed, options(args));
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

/// A mesh of ours that is not valid is our fault, not the user's.
pub(crate) fn ours(error: Error) -> Error {
    match error {
        Error::Mesh { what, place, .. } => {
            let help = "this is a fault of voronaut: nothing was written; please report it with the input";
            Error::Mesh { what, place, help: help.into() }
        }
        other => other,
    }
}

pub(crate) fn fill_in(report: &mut Report, meshed: &Meshed, options: Value) {
    report.star_set = meshed.star_set;
    if meshed.star_set.is_none() {
        report.dual = Some(meshed.dual.clone());
        report.relaxation = Some(meshed.relaxation.clone());
        report.polished.clone_from(&meshed.polished);
    }
    report.canvas.clone_from(&meshed.canvas);
    report.diagram.clone_from(&meshed.diagram);
    report.metric_scale = Some(meshed.metric_scale);
    report.net = meshed.net.as_ref().map(NetFigures::of);
    report.protection = meshed.protection;
    report.notes.clone_from(&meshed.notes);
    report.options = options;
}

/// All options, as used.
pub(crate) fn options(args: &MeshArgs) -> Value {
    let bounds = args.metric_choices.bounds();
    let mut options = json!(args.options());
    let more = json!({
        "domain": args.domain, "metric": args.metric, "out": args.out, "background": args.metric_choices.background,
        "smooth_metric": args.metric_choices.smooth_metric, "tensor_order": args.metric_choices.tensor_order, "gradation": args.metric_choices.gradation,
        "norm": args.metric_choices.norm.to_string(), "recovery": args.metric_choices.recovery,
        "ar": args.features().ar, "h_min": bounds.h_min, "h_max": bounds.h_max, "a_max": bounds.a_max,
        "picture": args.outputs.picture, "pixels": args.outputs.pixels, "histograms": args.outputs.histograms, "report": args.outputs.report, "threads": args.run.threads,
        "repair": args.damage.repair,
    });
    if let (Value::Object(options), Value::Object(more)) = (&mut options, more) {
        options.extend(more);
    }
    options
}
