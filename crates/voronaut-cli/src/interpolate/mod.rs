//! `voronaut interpolate`: a solution carried from one mesh to another.

mod args;
mod told;

pub(crate) use args::{EXAMPLES, InterpolateArgs};

use crate::files;
use std::path::Path;
use std::time::Instant;
use voronaut::mesh::{Mesh, SolutionValues, Solutions};
use voronaut::transfer::{Overshoot, TransferOptions, carry};
use voronaut::{Error, Result};
use voronaut_io::Document;

/// Carries all fields of a file to another mesh.
pub(crate) fn run(args: &InterpolateArgs) -> Result<()> {
    let start = Instant::now();
    demand_writable(args)?;
    files::set_threads(&args.run)?;
    let (old, new) = (planar(&args.old, args.run.quiet)?, planar(&args.new, args.run.quiet)?);
    let given = voronaut_io::read_solutions(&args.field)?;
    demand_counts(args, &given, &old, &new)?;
    let read = start.elapsed().as_secs_f64();
    let overshoot = if args.overshoot { Overshoot::Kept } else { Overshoot::Spread };
    let options = TransferOptions { conservative: args.conservative, overshoot, linear_tensors: args.linear_tensors };
    let (solutions, carried, cover) = carry(&old, &new, &given, options)?;
    let done = start.elapsed().as_secs_f64();
    voronaut_io::write_solutions(&solutions, &args.out)?;
    let dimension = usize::from(given.dimension);
    let seconds = [read, done - read, start.elapsed().as_secs_f64() - done];
    if let Some(file) = &args.report {
        let told = told::report(args, [&old, &new], dimension, &carried, &cover, seconds);
        voronaut_io::write(file, format!("{told:#}\n").as_bytes())?;
    }
    told::print(args, dimension, &carried, &cover);
    Ok(())
}

/// Refuses, before any work, outputs that could not be written.
fn demand_writable(args: &InterpolateArgs) -> Result<()> {
    let ending = args.out.extension().map(std::ffi::OsStr::to_ascii_lowercase);
    if ending.is_none_or(|ending| ending != "sol" && ending != "solb") {
        let what = format!("{} does not end like a solution file", args.out.display());
        return Err(Error::Unsupported { what, help: "end the name of OUT in .sol or .solb".into() });
    }
    let out = voronaut_io::place(&args.out)?;
    let report = args.report.as_deref().map(voronaut_io::place).transpose()?;
    if report.is_some_and(|report| report == out) {
        let what = "two outputs have the same name";
        return Err(Error::parse(args.out.display().to_string(), what, "give each output a name of its own"));
    }
    Ok(())
}

fn planar(path: &Path, is_quiet: bool) -> Result<Mesh> {
    let Document { mesh, notes, .. } = voronaut_io::read(path)?;
    crate::summary::notes(&notes, is_quiet);
    if mesh.is_planar() {
        return Ok(mesh);
    }
    let what = format!("interpolate on a surface ({})", path.display());
    Err(Error::Unsupported { what, help: "give planar meshes: Dimension 2, or z = 0 at every vertex".into() })
}

fn demand_counts(args: &InterpolateArgs, given: &Solutions, old: &Mesh, new: &Mesh) -> Result<()> {
    let sections = [
        ("SolAtVertices", &given.vertices, [old.points.len(), new.points.len()], "vertices"),
        ("SolAtTriangles", &given.triangles, [old.triangles.len(), new.triangles.len()], "triangles"),
    ];
    for (section, solutions, [needed, there], places) in sections {
        let Some(found) = solutions.first().map(SolutionValues::count).filter(|&found| found != needed) else {
            continue;
        };
        let (field, old, new) = (args.field.display(), args.old.display(), args.new.display());
        let what = format!("{section} has {found} entries, and {old} has {needed} {places}");
        let help = if found == there {
            format!("{new} has {there}: give the meshes in the other order, OLD first")
        } else {
            "give as OLD the mesh that the field was computed on".into()
        };
        return Err(Error::parse(field.to_string(), what, help));
    }
    Ok(())
}
