//! `voronaut remesh`: meshes of planar domains and of surfaces for users of mmg2d and mmgs, by their options.

mod args;
mod plane;
mod spelling;
mod surface;

pub(crate) use args::{EXAMPLES, RemeshArgs};
pub(crate) use spelling::translated;

use crate::{files, mesh, summary};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::time::Instant;
use voronaut::Result;
use voronaut::mesh::{Mesh, Solution};
use voronaut::recipe::{Keep, MeshOptions, Meshed, RemeshInput};
use voronaut::surface::metric::Sizing;
use voronaut::surface::{Input, Mended};
use voronaut_io::gmsh::Version;
use voronaut_io::{Fields, Format, Given, of_document, read_metric, read_pslg};
use voronaut_io::{Report, Seconds};

/// mmg's exit code where it writes no mesh.
pub(crate) const FAILURE: u8 = 2;

/// Remeshes a planar domain or a surface. Nothing is written unless the mesh is valid.
pub(crate) fn run(args: &RemeshArgs) -> Result<()> {
    let start = Instant::now();
    let (run, out) = (args.run(), args.out());
    let format = match Format::from_path(&out)? {
        // mmg reads no other version.
        Format::Gmsh(_, form) => Format::Gmsh(Version::V2_2, form),
        other => other,
    };
    let sol_file = out.with_extension("sol");
    [Some(&out), Some(&sol_file), args.report.as_ref()]
        .into_iter()
        .flatten()
        .try_for_each(|path| voronaut_io::demand_directory(path))?;
    files::set_threads(&run)?;
    let given = read(args)?;
    let is_planar = matches!(given, Read::Plane(..));
    args.warnings(is_planar).iter().for_each(|warning| eprintln!("warning: {warning}"));
    let made = match given {
        Read::Plane(input, notes) => {
            let mut made = plane::remesh(args, &input)?;
            made.report.notes.extend(notes);
            made
        }
        Read::Surface(input, mended) => surface::remesh(args, input, &mended)?,
    };
    let Made { mesh, mut report, solution } = made;
    report.seconds.total = start.elapsed().as_secs_f64();
    voronaut_io::write_with(&out, |file| format.write(&mesh, &Fields::default(), file))?;
    voronaut_io::write_solution(&solution, &sol_file)?;
    args.report.as_deref().map_or(Ok(()), |path| voronaut_io::write(path, report.to_json().as_bytes()))?;
    summary::print(&out.display().to_string(), &report, &run);
    Ok(())
}

/// What comes out.
struct Made {
    mesh: Mesh,
    report: Report,
    /// The metric that was used at the mesh's vertices.
    solution: Solution,
}

/// What goes in.
#[expect(clippy::large_enum_variant, reason = "there is one, and not for long")]
enum Read {
    /// With what the reader left out.
    Plane(RemeshInput, Vec<String>),
    Surface(Input, Mended),
}

fn read(args: &RemeshArgs) -> Result<Read> {
    let path = args.input();
    let spec = path.to_string_lossy();
    if let Some(format) = Format::of_ending(&path) {
        let document = voronaut_io::read(&path)?;
        if format.may_be_planar() && (document.mesh.triangles.is_empty() || document.mesh.is_planar()) {
            let input = RemeshInput::of_mesh(document.mesh, keep(args)).map_err(|error| in_file(&spec, error))?;
            return Ok(Read::Plane(input, document.notes));
        }
        let (surface, mended) = of_document(&spec, &document, args.damage.options())?;
        return Ok(Read::Surface(Input::new(surface, None), mended));
    }
    match Given::read_with(&spec, None, args.damage.options())? {
        (Given::Surface(input), mended) => Ok(Read::Surface(input, mended)),
        (Given::Plane(_), _) => Ok(Read::Plane(RemeshInput::of_graph(read_pslg(&spec)?, keep(args))?, Vec::new())),
    }
}

/// Adds the file to the place of an error of its domain.
fn in_file(file: &str, error: voronaut::Error) -> voronaut::Error {
    match error {
        voronaut::Error::Domain { what, place, help } => {
            voronaut::Error::Domain { what, place: format!("{file}, {place}"), help }
        }
        other => other,
    }
}

fn keep(args: &RemeshArgs) -> Keep {
    Keep { features: args.features(), curves: args.nosurf, inner_edges: args.opnbdy, plain_sizes: args.nosizreq }
}

/// The values of the metric: of the file named, else of the one next to the input, if there is one. What is named and not there is
/// no metric, as mmg has it, with a warning.
fn asked(args: &RemeshArgs) -> Result<Option<(PathBuf, Solution)>> {
    let with =
        |path: &Path| ["sol", "solb"].map(|ending| path.with_extension(ending)).into_iter().find(|own| own.is_file());
    let own = with(&args.input());
    // The ending may be left out.
    let named = args.sol.clone().map(|path| if path.is_file() { path } else { with(&path).unwrap_or(path) });
    let is_there = |path: &PathBuf| {
        let is_there = path.is_file();
        if !is_there && args.sol.is_some() {
            eprintln!("warning: {} not found: sizes are the default ones, as mmg has it", path.display());
        }
        is_there
    };
    // What is next to an outline belongs to another file.
    let has_sizes = args.hsiz.is_some() || args.optim || Format::of_ending(&args.input()).is_none();
    let Some(path) = named.or(own.filter(|_| !has_sizes)).filter(is_there) else { return Ok(None) };
    let read = read_metric(&path, args.tensor_order)?;
    Ok(Some((path, read)))
}

/// Limits that are not given: of two numbers, the least and greatest size there is; one that is given comes first.
fn limits(args: &RemeshArgs, [least, most]: [f64; 2]) -> [f64; 2] {
    let h_max = args.hsiz.or(args.hmax).unwrap_or_else(|| most.max(args.hmin.unwrap_or(0.0)));
    let h_min = args.hmin.unwrap_or_else(|| least.min(h_max));
    [h_min, h_max]
}

fn options(args: &RemeshArgs) -> MeshOptions {
    /// Bytes of a megabyte, as mmg counts.
    const MEGABYTE: f64 = 1_048_576.0;
    let default = MeshOptions::default();
    let memory_limit = args.memory.map_or(default.memory_limit, |megabytes| (megabytes * MEGABYTE) as u64);
    MeshOptions { hausd: Some(args.hausd), memory_limit, ..default }
}

/// The report's parts that are the same for plane and surface.
fn fill_in(report: &mut Report, meshed: &Meshed, args: &RemeshArgs, sizing: &Sizing, metric_file: Option<&Path>) {
    mesh::fill_in(report, meshed, as_used(args, sizing, metric_file));
    report.seconds = Seconds { stages: meshed.seconds.clone(), total: 0.0 };
}

fn as_used(args: &RemeshArgs, sizing: &Sizing, metric_file: Option<&Path>) -> Value {
    json!({
        "in": args.input(), "out": args.out(), "sol": metric_file, "hausd": sizing.hausd, "hmin": sizing.h_min,
        "hmax": sizing.h_max, "ar": args.features().ar, "repair": args.damage.repair, "hsiz": args.hsiz, "hgrad": sizing.hgrad,
        "anisotropic": sizing.anisotropic, "optim": args.optim, "nosurf": args.nosurf, "opnbdy": args.opnbdy, "nosizreq": args.nosizreq,
        "fit": !args.no_fit, "memory": args.memory, "report": args.report, "threads": args.run().threads,
    })
}
