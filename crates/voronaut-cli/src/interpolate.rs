//! `voronaut interpolate`: a solution carried from one mesh to another.

use crate::aside::say_aside;
use crate::files::{self, Miscounted};
use crate::options::Run;
use crate::stages::Stages;
use crate::summary;
use crate::world::World;
use clap::Args;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use voronaut::mesh::{Mesh, Solutions};
use voronaut::transfer::{Carried, Cover, Extent, Kind, Overshoot, Place, TransferOptions, carry};
use voronaut::{Error, Result};
use voronaut_io::{Document, Seconds};

pub(crate) const EXAMPLES: &str = "\
OLD and NEW are meshes of one planar domain or one surface: in files .mesh, .meshb, .msh, .su2, .vtu, .vtp, .obj, .off, .ply or .stl. FIELD is a .sol or .solb with any number of scalars, vectors and tensors,
at the vertices of OLD (SolAtVertices, linear between them) or on its triangles (SolAtTriangles); all of them are carried.

Without --conservative a vertex gets the value of the old field there, a triangle that of the old triangle below its centroid. With
it the integral over the domain is kept to rounding: vertices get the field that is nearest in L2, by exact integrals over the
intersections of old and new triangles; triangles get the mean. A symmetric tensor (type 3) is taken for a metric and interpolated by
its logarithm, conservative or not. Beyond OLD (another mesh has other chords along a curve) the nearest value goes on.

Examples:
  voronaut interpolate old.mesh new.mesh u.sol -o u-new.sol
  voronaut interpolate old.mesh new.mesh density.sol -o density-new.sol --conservative --report run.json
  voronaut interpolate old.mesh new.mesh stress.sol -o stress-new.sol --linear-tensors";

#[derive(Debug, Args)]
pub(crate) struct InterpolateArgs {
    /// The mesh that the field belongs to
    pub(crate) old: PathBuf,
    /// The mesh to carry it to
    pub(crate) new: PathBuf,
    /// The field: a .sol
    pub(crate) field: PathBuf,
    /// The field on NEW: a .sol
    #[arg(short, long, value_name = "OUT")]
    pub(crate) out: PathBuf,
    /// Keep the integral of every component over the domain
    #[arg(long)]
    pub(crate) conservative: bool,
    /// With --conservative: let values next to a front be beyond those on both its sides, for the least L2 distance
    #[arg(long, requires = "conservative")]
    pub(crate) overshoot: bool,
    /// Symmetric tensors are no metrics (stresses, Hessians): carry each entry for itself
    #[arg(long)]
    pub(crate) linear_tensors: bool,
    #[command(flatten)]
    pub(crate) run: Run,
}

/// Carries all fields of a file to another mesh.
pub(crate) fn run(args: &InterpolateArgs, world: &World) -> Result<()> {
    let mut stages = Stages::start(world);
    world.file(&args.out).map(|out| files::demand_solution(out, &args.run)).transpose()?;
    let (old, new) = (read(world, &args.old, args.run.quiet)?, read(world, &args.new, args.run.quiet)?);
    let given = world.solutions(&args.field)?;
    demand_counts(args, &given, &old, &new)?;
    stages.end("read");
    let overshoot = if args.overshoot { Overshoot::Kept } else { Overshoot::Spread };
    let options = TransferOptions { conservative: args.conservative, overshoot, linear_tensors: args.linear_tensors };
    let (solutions, carried, cover) = carry(&old, &new, &given, options)?;
    stages.end("carry");
    world.write_solutions(solutions, &args.out)?;
    stages.end("write");
    let told = Told { args, dimension: usize::from(given.dimension), carried: &carried, cover: &cover };
    world.write_report(format!("{:#}\n", told.report([&old, &new], &stages.seconds(Vec::new()))), &args.run)?;
    told.print();
    Ok(())
}

fn read(world: &World, path: &Path, is_quiet: bool) -> Result<Mesh> {
    let Document { mesh, notes, .. } = world.document(path)?;
    crate::summary::notes(&notes, is_quiet);
    Ok(mesh)
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

/// What there is to say.
struct Told<'a> {
    args: &'a InterpolateArgs,
    /// 2 or 3 of the file, which tells a vector from a tensor.
    dimension: usize,
    carried: &'a [Carried],
    cover: &'a Cover,
}

impl Told<'_> {
    /// The report. Of metrics there is no `mass`: they are no densities.
    fn report(&self, meshes: [&Mesh; 2], seconds: &Seconds) -> Value {
        let args = self.args;
        let [old, new] = meshes.map(|mesh| json!({ "vertices": mesh.points.len(), "triangles": mesh.triangles.len() }));
        json!({
            "old": old, "new": new, "method": self.method(), "cover": self.cover,
            "fields": self.carried.iter().map(|carried| self.field(carried)).collect::<Vec<Value>>(),
            "seconds": seconds, "peak_memory_bytes": voronaut_io::peak_memory_bytes(), "version": env!("CARGO_PKG_VERSION"),
            "options": {
                "old": args.old, "new": args.new, "field": args.field, "out": args.out, "conservative": args.conservative,
                "overshoot": args.overshoot, "linear_tensors": args.linear_tensors, "report": args.run.report,
                "threads": args.run.threads,
            },
        })
    }

    /// Says on stdout what became of every field, and on stderr what is odd, unless told to be quiet.
    fn print(&self) {
        if self.args.run.quiet {
            return;
        }
        let mut lines = Vec::new();
        for (carried, number) in self.carried.iter().zip(1..) {
            let name = format!("{number}: {} at {}", self.kind(carried), place(carried));
            let names = std::iter::once(name).chain(std::iter::repeat(String::new()));
            let all = carried.before.iter().zip(&carried.after).map(|(before, after)| line(carried, before, after));
            lines.extend(names.zip(all));
        }
        summary::say(&format!("{} ({})", self.args.out.display(), self.method()), 24, lines);
        if self.cover.outside > 0 {
            let (count, farthest) = (self.cover.outside, self.cover.farthest);
            say_aside(&format!(
                "note: {count} vertices are outside the old mesh, by up to {farthest:.3e}: they have the nearest value"
            ));
        }
        let moved = self.cover.areas.map_or(0.0, |shares| shares.uncovered.max(shares.left));
        if moved > 0.0 {
            say_aside(&format!(
                "note: a share of {moved:.1e} of the area is in one mesh only; masses are kept all the same"
            ));
        }
    }

    fn method(&self) -> &'static str {
        match (self.args.conservative, self.args.overshoot) {
            (false, _) => "interpolation",
            (true, false) => "conservative",
            (true, true) => "conservative, overshooting",
        }
    }

    fn field(&self, carried: &Carried) -> Value {
        let extents = |all: &[Extent]| match carried.field.kind {
            Kind::Metric | Kind::SpaceMetric => {
                all.iter().map(|extent| json!({ "min": extent.min, "max": extent.max })).collect()
            }
            Kind::Linear(_) => json!(all),
        };
        json!({
            "at": place(carried), "kind": self.kind(carried), "components": carried.field.components(),
            "before": extents(&carried.before), "after": extents(&carried.after),
        })
    }

    fn kind(&self, carried: &Carried) -> &'static str {
        match carried.field.kind {
            Kind::Metric | Kind::SpaceMetric => "metric",
            Kind::Linear(1) => "scalar",
            Kind::Linear(components) if components == self.dimension => "vector",
            Kind::Linear(_) => "tensor",
        }
    }
}

fn place(carried: &Carried) -> &'static str {
    match carried.field.place {
        Place::Vertices => "vertices",
        Place::Triangles => "triangles",
    }
}

fn line(carried: &Carried, before: &Extent, after: &Extent) -> String {
    let range = |extent: &Extent| format!("{:.6} to {:.6}", extent.min, extent.max);
    let ranges = format!("{} -> {}", range(before), range(after));
    match carried.field.kind {
        Kind::Metric | Kind::SpaceMetric => ranges,
        Kind::Linear(_) => format!("{ranges}   mass {:.12e} -> {:.12e}", before.mass, after.mass),
    }
}
