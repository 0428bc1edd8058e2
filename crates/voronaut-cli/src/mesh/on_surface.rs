//! Meshes of surfaces.

use super::account::{fill_in, ours};
use super::args::MeshArgs;
use crate::fields::{self, Scaled};
use crate::progress::Bar;
use crate::{summary, surfaces};
use std::time::Instant;
use voronaut::canvas::{self, Canvas};
use voronaut::diagram::SurfaceDiagram;
use voronaut::geodesic::Method;
use voronaut::quality::{Meetings, surface_quality, surface_unmet, validity_on};
use voronaut::recipe;
use voronaut::surface::{Input, Mended};
use voronaut::{Error, Result};
use voronaut_io::{Report, Seconds, Strayed};

/// Meshes a surface. Nothing is written unless the mesh is valid.
pub(super) fn run(args: &MeshArgs, input: Input, mended: &Mended, start: Instant) -> Result<()> {
    surfaces::demand_supported(&args.outputs)?;
    let whole = args.outputs.picture.is_some().then(|| Input::new(input.surface.clone(), input.implicit.clone()));
    let input = &input.cut(&args.features())?;
    let metric = fields::on_surface(&args.metric, input, &args.metric_choices)?;
    let meshed = {
        let bar = Bar::new(args.run.quiet, args.run.verbose);
        recipe::mesh_surface(input, metric.as_ref(), &args.options(), &bar)?
    };
    let found = validity_on(&meshed.mesh, &Meetings::of(input.whole_mesh()));
    found.demand().map_err(ours)?;
    let meets = found.meetings.note();
    let scaled = Scaled { field: metric.as_ref(), factor: meshed.metric_scale };
    let figures = surface_quality(&meshed.mesh, &input.surface, &scaled)?;
    let mut report = Report::new(found, meshed.mesh.points.len(), meshed.mesh.triangles.len()).with_quality(&figures);
    fill_in(&mut report, &meshed, args.as_used());
    report.curvature = metric.curvature_figures();
    report.unmet = Some(surface_unmet(&meshed.mesh, &input.surface, &scaled)?.figures());
    report.notes.extend(mended.sentences().chain(meets));
    report.fidelity = meshed.fidelity.map(|found| Strayed::Surface(found.into()));
    report.seconds = Seconds { stages: meshed.seconds.clone(), total: start.elapsed().as_secs_f64() };
    // Cells are drawn across creases.
    let picture = args.outputs.picture.as_deref().zip(whole.as_ref()).map(|(path, whole)| {
        let metric = fields::on_surface(&args.metric, whole, &args.metric_choices)?;
        let places = surfaces::places(whole, &meshed.mesh)?;
        let size = canvas::size_for(places.len(), args.canvas_size);
        let (canvas, at) = Canvas::on_surface(args.canvas, whole, metric.as_ref(), size, &places)?;
        let diagram = SurfaceDiagram::on_surface(&canvas, &at, Method::March)?;
        Ok::<_, Error>((path, surfaces::drawn(&args.outputs, &diagram, &meshed.mesh)?))
    });
    surfaces::write(picture.transpose()?, &args.outputs, &meshed.mesh, &args.out, &report)?;
    summary::print(&args.out.display().to_string(), &report, &args.run);
    Ok(())
}
