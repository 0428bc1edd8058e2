//! Planar meshes made anew, as mmg2d does it.

use super::{Made, RemeshArgs, asked, fill_in, limits, options};
use crate::mesh;
use crate::progress::Bar;
use voronaut::Result;
use voronaut::quality::{fidelity, metric_quality, unmet, validity};
use voronaut::recipe::{self, Asked, RemeshInput};
use voronaut::surface::metric::Sizing;
use voronaut_io::{Report, Strayed};

/// A valid mesh of the domain.
pub(super) fn remesh(args: &RemeshArgs, input: &RemeshInput) -> Result<Made> {
    let run = args.run();
    let (metric_file, given) = asked(args)?.unzip();
    let asked = match given {
        Some(given) => Asked::Values(given.values),
        None if args.optim => Asked::Own,
        None => Asked::Nothing,
    };
    let [h_min, h_max] = limits(args, args.hsiz.map_or_else(|| input.default_limits(&asked), |h| Ok([0.1 * h, h]))?);
    let sizing = Sizing { hausd: args.hausd, h_min, h_max, hgrad: args.gradation(), anisotropic: args.anisotropic };
    let sizes = input.sizes(&asked, &sizing)?;
    let field = sizes.field()?;
    let mut meshed = recipe::mesh(&input.domain, &field, &options(args), &Bar::new(run.quiet, run.verbose))?;
    input.mark(&mut meshed.mesh);
    let found = validity(&meshed.mesh);
    found.demand().map_err(mesh::ours)?;
    let figures = metric_quality(&meshed.mesh, &field)?;
    let mut report = Report::new(found, meshed.mesh.points.len(), meshed.mesh.triangles.len()).with_quality(&figures);
    fill_in(&mut report, &meshed, args, &sizing, metric_file.as_deref());
    report.unmet = Some(unmet(&meshed.mesh, &field)?.figures());
    report.fidelity = Some(Strayed::Boundary(fidelity(&meshed.mesh, &input.domain.boundary())));
    if input.left_out > 0 {
        let why = "inside a region and not required (-opnbdy keeps them), or no triangle's";
        report.notes.push(format!("{} edges of the list are left out: {why}", input.left_out));
    }
    let solution = sizes.solution(&field, &meshed.mesh.points);
    Ok(Made { mesh: meshed.mesh, report, solution })
}
