//! Surfaces made anew, as mmgs does it.

use super::{Made, RemeshArgs, asked, fill_in, limits, options};
use crate::fields::Scaled;
use crate::mesh;
use crate::progress::Bar;
use voronaut::Result;
use voronaut::quality::{Meetings, surface_quality, surface_unmet, validity_on};
use voronaut::recipe::{self, MeshOptions};
use voronaut::surface::metric::{Sizes, Sizing};
use voronaut::surface::{Input, Mended};
use voronaut_io::{Report, Strayed};

/// A valid mesh of the surface.
pub(super) fn remesh(args: &RemeshArgs, input: Input, mended: &Mended) -> Result<Made> {
    /// Vertices slide less than with `mesh --fit`: lengths of edges count for more here.
    const STIFFNESS: f64 = 0.5;
    let run = args.run();
    let input = input.cut(&args.features())?;
    let (metric_file, given) = asked(args)?.unzip();
    let given = given.map(|given| input.spread(&given)).transpose()?;
    let sizing = sizing(args, &input);
    let sizes = sizing.sizes(&input.surface, given.as_ref())?;
    if matches!(sizes, Sizes::Anisotropic(_)) && args.hgrad > 1.0 && !run.quiet {
        eprintln!("note: sizes that depend on the direction are not graded: -hgrad would make them alike in all");
    }
    let field = sizes.field(&input.surface)?;
    let options = MeshOptions { fit: !args.no_fit, stiffness: STIFFNESS, ..options(args) };
    let meshed = recipe::mesh_surface(&input, &field, &options, &Bar::new(run.quiet, run.verbose))?;
    let found = validity_on(&meshed.mesh, &Meetings::of(input.whole_mesh()));
    found.demand().map_err(mesh::ours)?;
    let meets = found.meetings.note();
    let scaled = Scaled { field: &field, factor: meshed.metric_scale };
    let figures = surface_quality(&meshed.mesh, &input.surface, &scaled)?;
    let mut report = Report::new(found, meshed.mesh.points.len(), meshed.mesh.triangles.len()).with_quality(&figures);
    fill_in(&mut report, &meshed, args, &sizing, metric_file.as_deref());
    report.unmet = Some(surface_unmet(&meshed.mesh, &input.surface, &scaled)?.figures());
    report.notes.extend(mended.sentences().chain(meets));
    report.fidelity = meshed.fidelity.map(|found| Strayed::Surface(found.into()));
    let solution = sizes.solution(&field, meshed.metric_scale, &input.surface, &meshed.mesh.points)?;
    Ok(Made { mesh: meshed.mesh, report, solution })
}

fn sizing(args: &RemeshArgs, input: &Input) -> Sizing {
    /// The least size, as a share of the diagonal or of the one size asked for: as with mmgs.
    const LEAST: [f64; 2] = [1e-3, 0.1];
    let diagonal = input.diagonal();
    let least = args.hsiz.map_or(LEAST[0] * diagonal, |h| LEAST[1] * h);
    let [h_min, h_max] = limits(args, [least, diagonal]);
    Sizing { hausd: args.hausd, h_min, h_max, hgrad: args.gradation(), anisotropic: args.anisotropic }
}
