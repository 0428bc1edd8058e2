//! `voronaut remesh`: meshes of surfaces for users of mmgs, by its options.

mod args;
mod spelling;

pub(crate) use args::{EXAMPLES, RemeshArgs};
pub(crate) use spelling::translated;

use crate::metric::Scaled;
use crate::progress::Bar;
use crate::{files, mesh, summary};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::time::Instant;
use voronaut::formats::{self, Format, Solution};
use voronaut::output::report::{Seconds, Strayed};
use voronaut::output::{self, Report};
use voronaut::quality::{surface_quality, surface_unmet, validity};
use voronaut::recipe::{self, MeshOptions};
use voronaut::surface::metric::{Sizes, Sizing};
use voronaut::surface::{Given, Input, Mended};
use voronaut::{Error, Result};

/// Remeshes a surface. Nothing is written unless the mesh is valid.
pub(crate) fn run(args: &RemeshArgs) -> Result<()> {
    let start = Instant::now();
    let (run, out) = (args.run(), args.out());
    Format::from_path(&out)?;
    let sol_file = out.with_extension("sol");
    [Some(&out), Some(&sol_file), args.report.as_ref()]
        .into_iter()
        .flatten()
        .try_for_each(|path| output::demand_directory(path))?;
    files::set_threads(&run)?;
    args.unused.warnings().iter().for_each(|warning| eprintln!("warning: {warning}"));
    let (input, mended) = surface(args)?;
    let input = input.cut(&args.features())?;
    let metric_file = metric_file(args);
    let given = metric_file.as_deref().map(|path| input.spread(&read_solution(path)?)).transpose()?;
    let sizing = sizing(args, &input);
    let sizes = sizing.sizes(&input.surface, given.as_ref())?;
    if matches!(sizes, Sizes::Anisotropic(_)) && args.hgrad > 1.0 && !run.quiet {
        eprintln!("note: sizes that depend on the direction are not graded: -hgrad would make them alike in all");
    }
    let field = sizes.field(&input.surface)?;
    let meshed = {
        let bar = Bar::new(run.quiet, run.verbose);
        recipe::mesh_surface(&input, &field, &options(args), &bar)?
    };
    let found = validity(&meshed.mesh);
    found.demand().map_err(mesh::ours)?;
    let scaled = Scaled { field: &field, factor: meshed.metric_scale };
    let figures = surface_quality(&meshed.mesh, &input.surface, &scaled)?;
    let mut report = Report::new(found, meshed.mesh.points.len(), meshed.mesh.triangles.len()).with_quality(&figures);
    mesh::fill_in(&mut report, &meshed, as_used(args, &sizing, metric_file.as_deref()));
    report.unmet = Some(surface_unmet(&meshed.mesh, &input.surface, &scaled)?.figures());
    report.notes.extend(mended.sentences());
    report.fidelity = meshed.fidelity.map(|found| Strayed::Surface(found.into()));
    report.seconds = Seconds { stages: meshed.seconds.clone(), total: start.elapsed().as_secs_f64() };
    let solution = sizes.solution(&field, meshed.metric_scale, &input.surface, &meshed.mesh.points)?;
    output::write_mesh(&meshed.mesh, &out)?;
    output::write_solution(&solution, &sol_file)?;
    args.report.as_deref().map_or(Ok(()), |path| output::write(path, report.to_json().as_bytes()))?;
    summary::print(&out.display().to_string(), &report, &run);
    Ok(())
}

fn surface(args: &RemeshArgs) -> Result<(Input, Mended)> {
    let path = args.input();
    let (given, mended) = Given::read_with(&path.to_string_lossy(), None, args.damage.options())?;
    match given {
        Given::Surface(input) => Ok((input, mended)),
        Given::Plane(_) => {
            let help = "voronaut mesh IN --metric SIZES.sol meshes it; remesh is for surfaces (mmgs), not yet for the plane (mmg2d)";
            Err(Error::Unsupported { what: format!("remesh of a planar mesh ({})", path.display()), help: help.into() })
        }
    }
}

/// The file of the metric: the one named, else the one next to the surface, if there is one.
fn metric_file(args: &RemeshArgs) -> Option<PathBuf> {
    let own = Some(args.input().with_extension("sol")).filter(|own| args.hsiz.is_none() && own.is_file());
    args.sol.clone().or(own)
}

fn read_solution(path: &Path) -> Result<Solution> {
    formats::read_solution(path)
}

fn sizing(args: &RemeshArgs, input: &Input) -> Sizing {
    /// The least size, as a share of the diagonal or of the one size asked for: as with mmgs.
    const LEAST: [f64; 2] = [1e-3, 0.1];
    let diagonal = input.diagonal();
    let h_max = args.hsiz.or(args.hmax).unwrap_or_else(|| diagonal.max(args.hmin.unwrap_or(0.0)));
    let least = args.hsiz.map_or(LEAST[0] * diagonal, |h| LEAST[1] * h);
    let h_min = args.hmin.unwrap_or_else(|| least.min(h_max));
    Sizing { hausd: args.hausd, h_min, h_max, hgrad: args.gradation(), anisotropic: args.anisotropic }
}

fn options(args: &RemeshArgs) -> MeshOptions {
    /// Bytes of a megabyte, as mmgs counts.
    const MEGABYTE: f64 = 1_048_576.0;
    /// Vertices slide less than with `mesh --fit`: lengths of edges count for more here.
    const STIFFNESS: f64 = 0.5;
    let default = MeshOptions::default();
    let memory_limit = args.memory.map_or(default.memory_limit, |megabytes| (megabytes * MEGABYTE) as u64);
    MeshOptions { hausd: Some(args.hausd), fit: !args.no_fit, stiffness: STIFFNESS, memory_limit, ..default }
}

fn as_used(args: &RemeshArgs, sizing: &Sizing, metric_file: Option<&Path>) -> Value {
    json!({
        "in": args.input(), "out": args.out(), "sol": metric_file, "hausd": sizing.hausd, "hmin": sizing.h_min,
        "hmax": sizing.h_max, "ar": args.features().ar, "repair": args.damage.repair, "hsiz": args.hsiz, "hgrad": sizing.hgrad, "anisotropic": sizing.anisotropic, "fit": !args.no_fit,
        "memory": args.memory, "report": args.report, "threads": args.run().threads,
    })
}
