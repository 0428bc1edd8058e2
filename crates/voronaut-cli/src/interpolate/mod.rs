//! `voronaut interpolate`: a solution carried from one mesh to another.

mod args;
mod told;

pub(crate) use args::{EXAMPLES, InterpolateArgs};

use crate::files::{self, Miscounted};
use crate::progress::Stages;
use std::path::Path;
use voronaut::mesh::{Mesh, Solutions};
use voronaut::transfer::{Overshoot, TransferOptions, carry};
use voronaut::{Error, Result};
use voronaut_io::Document;

/// Carries all fields of a file to another mesh.
pub(crate) fn run(args: &InterpolateArgs) -> Result<()> {
    let mut stages = Stages::start();
    files::demand_solution(&args.out, &args.run)?;
    args.run.set_threads()?;
    let (old, new) = (planar(&args.old, args.run.quiet)?, planar(&args.new, args.run.quiet)?);
    let given = voronaut_io::read_solutions(&args.field)?;
    demand_counts(args, &given, &old, &new)?;
    stages.end("read");
    let overshoot = if args.overshoot { Overshoot::Kept } else { Overshoot::Spread };
    let options = TransferOptions { conservative: args.conservative, overshoot, linear_tensors: args.linear_tensors };
    let (solutions, carried, cover) = carry(&old, &new, &given, options)?;
    stages.end("carry");
    voronaut_io::write_solutions(&solutions, &args.out)?;
    stages.end("write");
    let told = told::Told { args, dimension: usize::from(given.dimension), carried: &carried, cover: &cover };
    args.run.write_report(&format!("{:#}\n", told.report([&old, &new], &stages.seconds(Vec::new()))))?;
    told.print();
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
    let Some(Miscounted { section, found, needed, places }) = files::miscounted(given, old) else { return Ok(()) };
    let (field, old, other) = (args.field.display(), args.old.display(), args.new.display());
    let what = format!("{section} has {found} entries, and {old} has {needed} {places}");
    let there = if places == "vertices" { new.points.len() } else { new.triangles.len() };
    let help = if found == there {
        format!("{other} has {there}: give the meshes in the other order, OLD first")
    } else {
        "give as OLD the mesh that the field was computed on".into()
    };
    Err(Error::parse(field.to_string(), what, help))
}
