//! `voronaut remesh`: meshes of planar domains and of surfaces for users of mmg2d and mmgs, by their options.

mod args;
mod spelling;

pub(crate) use args::{EXAMPLES, RemeshArgs};
pub(crate) use spelling::translated;

use crate::world::World;
use crate::{account, summary};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use voronaut::Result;
use voronaut::manifold::domain::{Keep, RemeshInput};
use voronaut::manifold::surface::Mended;
use voronaut::manifold::surface::metric::{Finer, Scaled, Sizing};
use voronaut::manifold::{Manifold, Riemannian};
use voronaut::mesh::{Mesh, Solution};
use voronaut::progress::Progress;
use voronaut::quality::fidelity;
use voronaut::recipe::{self, Asked, Effort, MeshOptions};
use voronaut_io::gmsh::Version;
use voronaut_io::{Format, Given, Report, Strayed, in_file, read_metric, read_pslg};

/// Remeshes a planar domain or a surface. Nothing is written unless the mesh is valid.
pub(crate) fn run(args: &RemeshArgs, world: &World) -> Result<()> {
    let start = world.seconds();
    let (run, out) = (args.run(), args.out());
    let format = match Format::from_path(&out)? {
        // mmg reads no other version.
        Format::Gmsh(_, form) => Format::Gmsh(Version::V2_2, form),
        other => other,
    };
    let sol_file = out.with_extension("sol");
    let files = [Some(&out), Some(&sol_file), run.report.as_ref()];
    let files = files.into_iter().flatten().filter_map(|path| world.file(path));
    files.into_iter().try_for_each(voronaut_io::demand_directory)?;
    let given = read(args, world)?;
    let is_planar = matches!(given, Read::Plane(..));
    args.warnings(is_planar).iter().for_each(|warning| world.say("warning", warning));
    let progress = world.progress(&run);
    let Made { mesh, mut report, solution } = match given {
        Read::Plane(input, notes) => in_plane(args, world, &input, notes, &*progress)?,
        Read::Surface(input, mended) => on_surface(args, world, input, &mended, &*progress)?,
    };
    drop(progress);
    report.seconds.total = world.seconds() - start;
    world.write_mesh_as(format, mesh, &out)?;
    world.write_solution(solution, &sol_file)?;
    world.write_report(report.to_json(), &run)?;
    summary::print(&out, &report, &run);
    Ok(())
}

/// What comes out.
struct Made {
    mesh: Mesh,
    report: Report,
    /// The metric that was used at the mesh's vertices.
    solution: Solution,
}

/// A valid mesh of a planar domain, as mmg2d does it; with what the reader left out.
fn in_plane(
    args: &RemeshArgs,
    world: &World,
    input: &RemeshInput,
    left_out: Vec<String>,
    bar: &dyn Progress,
) -> Result<Made> {
    let (metric_file, given) = asked(args, world)?.unzip();
    let asked = match given {
        Some(given) => Asked::Values(given.values),
        None if args.optim => Asked::Own,
        None => Asked::Nothing,
    };
    let sizing = sizing(args, args.hsiz.map_or_else(|| input.default_limits(&asked), |h| Ok([0.1 * h, h]))?);
    let sizes = input.sizes(&asked, &sizing)?;
    let field = sizes.field()?;
    let mut meshed = recipe::mesh(&input.domain, &field, &options(args, Effort::Fast), bar)?;
    input.mark(&mut meshed.mesh);
    let used = as_used(args, &sizing, metric_file.as_deref());
    let is_told = world.tells(&args.run());
    let (measured, (strayed, solution)) = rayon::join(
        || account::of(&meshed, Riemannian::from(&field), &Mended::default(), used, is_told),
        || (fidelity(&meshed.mesh, &input.domain.boundary()), sizes.solution(&field, &meshed.mesh.points)),
    );
    let (mut report, _) = measured?;
    report.fidelity = Some(Strayed::Boundary(strayed));
    if input.left_out > 0 {
        let why = "inside a region and not required (-opnbdy keeps them), or no triangle's";
        report.notes.push(format!("{} edges of the list are left out: {why}", input.left_out));
    }
    report.notes.extend(left_out);
    Ok(Made { mesh: meshed.mesh, report, solution })
}

/// A valid mesh of a surface, as mmgs does it.
fn on_surface(args: &RemeshArgs, world: &World, input: Manifold, mended: &Mended, bar: &dyn Progress) -> Result<Made> {
    /// Vertices slide less than with `mesh --fit`: lengths of edges count for more here.
    const STIFFNESS: f64 = 0.5;
    /// The least size, as a share of the diagonal or of the one size asked for: as with mmgs.
    const LEAST: [f64; 2] = [1e-3, 0.1];
    let input = input.cut(&args.features())?;
    let (metric_file, given) = asked(args, world)?.unzip();
    let given = given.map(|given| input.spread(&given)).transpose()?;
    let diagonal = input.diagonal();
    let sizing = sizing(args, [args.hsiz.map_or(LEAST[0] * diagonal, |h| LEAST[1] * h), diagonal]);
    let sizes = sizing.sizes(input.surface(), given.as_ref())?;
    let field = sizes.field(input.surface())?;
    let options = MeshOptions { fit: !args.no_fit, stiffness: STIFFNESS, ..options(args, Effort::Normal) };
    let meshed = recipe::mesh_surface(&input, &field, None, &options, bar)?;
    let used = as_used(args, &sizing, metric_file.as_deref());
    let field = Finer { field: &field, surface: input.surface(), logs: &meshed.finer };
    let scaled = Scaled { field: &field, factor: meshed.metric_scale };
    let (report, _) = account::of(&meshed, (&input, &scaled).into(), mended, used, world.tells(&args.run()))?;
    let solution = sizes.solution(&field, meshed.metric_scale, input.surface(), &meshed.mesh.points)?;
    Ok(Made { mesh: meshed.mesh, report, solution })
}

/// What goes in.
#[expect(clippy::large_enum_variant, reason = "there is one, and not for long")]
enum Read {
    /// With what the reader left out.
    Plane(RemeshInput, Vec<String>),
    Surface(Manifold, Mended),
}

fn read(args: &RemeshArgs, world: &World) -> Result<Read> {
    let path = args.input();
    let spec = path.to_string_lossy();
    let given = if let Some(format) = Format::of_ending(&path) {
        let document = world.document(&path)?;
        if format.may_be_planar() && (document.mesh.triangles.is_empty() || document.mesh.is_planar()) {
            let input = RemeshInput::of_mesh(document.mesh, keep(args)).map_err(|error| in_file(&spec, error))?;
            return Ok(Read::Plane(input, document.notes));
        }
        Given::of_document(&spec, &document, false, args.damage.options())?
    } else {
        world.given(&spec, args.damage.options())?
    };
    match given {
        (Given::Surface(input), mended) => Ok(Read::Surface(input, mended)),
        (Given::Plane(_), _) => Ok(Read::Plane(RemeshInput::of_graph(read_pslg(&spec)?, keep(args))?, Vec::new())),
    }
}

fn keep(args: &RemeshArgs) -> Keep {
    Keep { features: args.features(), curves: args.nosurf, inner_edges: args.opnbdy, plain_sizes: args.nosizreq }
}

/// The values of the metric: of the file named, else of the one next to the input, if there is one. What is named and not there is
/// no metric, as mmg has it, with a warning.
fn asked(args: &RemeshArgs, world: &World) -> Result<Option<(PathBuf, Solution)>> {
    if !world.is_files() {
        let named = args.sol.as_ref().map(|path| world.solution(path));
        return Ok(named.transpose()?.map(|solution| (args.sol.clone().unwrap_or_default(), solution)));
    }
    let with =
        |path: &Path| ["sol", "solb"].map(|ending| path.with_extension(ending)).into_iter().find(|own| own.is_file());
    let own = with(&args.input());
    // The ending may be left out.
    let named = args.sol.clone().map(|path| if path.is_file() { path } else { with(&path).unwrap_or(path) });
    let is_there = |path: &PathBuf| {
        let is_there = path.is_file();
        if !is_there && args.sol.is_some() {
            world.say("warning", &format!("{} not found: sizes are the default ones, as mmg has it", path.display()));
        }
        is_there
    };
    // What is next to an outline belongs to another file.
    let has_sizes = args.hsiz.is_some() || args.optim || Format::of_ending(&args.input()).is_none();
    let Some(path) = named.or(own.filter(|_| !has_sizes)).filter(is_there) else { return Ok(None) };
    let read = read_metric(&path, args.tensor_order)?;
    Ok(Some((path, read)))
}

/// Sizes as they are asked for. Limits that are not given are the least and greatest size there is; one that is given comes first.
fn sizing(args: &RemeshArgs, [least, most]: [f64; 2]) -> Sizing {
    let h_max = args.hsiz.or(args.hmax).unwrap_or_else(|| most.max(args.hmin.unwrap_or(0.0)));
    let h_min = args.hmin.unwrap_or_else(|| least.min(h_max));
    Sizing { hausd: args.hausd, h_min, h_max, hgrad: args.gradation(), anisotropic: args.anisotropic }
}

fn options(args: &RemeshArgs, usual: Effort) -> MeshOptions {
    MeshOptions {
        hausd: Some(args.hausd),
        effort: args.effort.unwrap_or(usual),
        memory_limit: args.run().limits.memory(),
        ..MeshOptions::default()
    }
}

fn as_used(args: &RemeshArgs, sizing: &Sizing, metric_file: Option<&Path>) -> Value {
    json!({
        "in": args.input(), "out": args.out(), "sol": metric_file, "hausd": sizing.hausd, "hmin": sizing.h_min,
        "hmax": sizing.h_max, "ar": args.features().ar, "repair": args.damage.repair, "hsiz": args.hsiz, "hgrad": sizing.hgrad,
        "anisotropic": sizing.anisotropic, "optim": args.optim, "nosurf": args.nosurf, "opnbdy": args.opnbdy, "nosizreq": args.nosizreq,
        "fit": !args.no_fit, "memory": args.memory, "report": args.run().report, "threads": args.run().threads,
    })
}
