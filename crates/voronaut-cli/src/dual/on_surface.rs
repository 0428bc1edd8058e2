//! Duals of seeds on surfaces.

use super::args::DualArgs;
use crate::options::{CanvasSize, EdgesOut};
use crate::progress::Bar;
use crate::seeds::SeedFile;
use crate::{fields, files, summary, surfaces};
use std::time::Instant;
use voronaut::Result;
use voronaut::canvas::{self, Canvas};
use voronaut::diagram::{Kind, SurfaceDiagram};
use voronaut::figures;
use voronaut::quality::{Meetings, surface_quality, validity_on};
use voronaut::recipe::{self, SeedDual};
use voronaut::sampling;
use voronaut::surface::{Input, Mended};
use voronaut_io::{Report, Seconds};

/// The dual of seeds on a surface.
pub(super) fn run(args: &DualArgs, input: &Input, mended: &Mended, start: Instant) -> Result<()> {
    surfaces::demand_supported(&args.outputs)?;
    demand_dual(args)?;
    let metric = fields::on_surface(&args.metric, input, &args.metric_choices)?;
    let (file, seeds) = SeedFile::read_in_space(&args.seeds)?;
    let places = file.on_surface(input, &seeds)?;
    let mut stages = vec![("read", start.elapsed().as_secs_f64())];
    let mut begin = Instant::now();
    let mut stage = |stages: &mut Vec<_>, name: &'static str| {
        stages.push((name, begin.elapsed().as_secs_f64()));
        begin = Instant::now();
    };
    let CanvasSize::PerSeed(per_seed) = args.canvas_size else {
        return Err(surfaces::unsupported("--canvas-size certified"));
    };
    let size = canvas::size_for(places.len(), per_seed);
    sampling::demand_memory(places.len() as f64, size as f64, args.memory_limit())?;
    let (canvas, at) = Canvas::on_surface(args.canvas, input, metric.as_ref(), size, &places)?;
    stage(&mut stages, "canvas");
    let diagram = SurfaceDiagram::on_surface(&canvas, &at, args.geodesic)?;
    stage(&mut stages, "diagram");
    let SeedDual { triangles, account, seconds, raw_nerve, .. } =
        recipe::surface_dual(&diagram, args.dual, &Bar::new(args.run.quiet, args.run.verbose));
    let mesh = recipe::surface_mesh(input, &places, triangles);
    stage(&mut stages, "dual");
    stages.extend(seconds);
    let found = validity_on(&mesh, &Meetings::of(input.whole_mesh()));
    let meets = found.meetings.note();
    let is_valid = found.valid;
    let mut report = Report::new(found, mesh.points.len(), mesh.triangles.len());
    if is_valid {
        report = report.with_quality(&surface_quality(&mesh, &input.surface, metric.as_ref())?);
    }
    report.dual = Some(account);
    report.canvas = Some(canvas.figures());
    report.diagram = Some(figures::Diagram { raw_nerve: Some(raw_nerve), ..figures::Diagram::of(&diagram) });
    report.notes.extend(mended.sentences().chain(meets));
    if !is_valid {
        report.notes.push("straight triangles of the dual do not make a valid mesh of these seeds".into());
    }
    report.options = args.as_used();
    report.seconds = Seconds { stages, total: start.elapsed().as_secs_f64() };
    if args.strict {
        report.validity.demand().or_else(|fault| files::write_report(&args.outputs, &report).and(Err(fault)))?;
    }
    let picture =
        args.outputs.picture.as_deref().map(|path| Ok((path, surfaces::drawn(&args.outputs, &diagram, &mesh)?)));
    let picture = picture.transpose()?;
    let written = if args.edges == EdgesOut::Geodesic { surfaces::with_geodesics(&diagram, &mesh) } else { mesh };
    surfaces::write(picture, &args.outputs, &written, &args.out, &report)?;
    if let Some(path) = &args.diagram {
        let (canvas, distances) = diagram.to_coloured_canvas();
        voronaut_io::write_diagram(&canvas, &distances, path)?;
    }
    summary::print(&args.out.display().to_string(), &report, &args.run);
    Ok(())
}

fn demand_dual(args: &DualArgs) -> Result<()> {
    let refused = [
        (args.voronoi != Kind::Riemannian, "--voronoi"),
        (args.certify, "--certify"),
        (matches!(args.canvas_size, CanvasSize::Certified), "--canvas-size certified"),
    ];
    refused.into_iter().find(|refused| refused.0).map_or(Ok(()), |(_, what)| Err(surfaces::unsupported(what)))
}
