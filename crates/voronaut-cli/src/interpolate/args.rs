//! What users type to carry a solution over.

use crate::options::Run;
use clap::Args;
use std::path::PathBuf;

pub(crate) const EXAMPLES: &str = "\
OLD and NEW are planar meshes of one domain: in files .mesh, .meshb, .msh, .vtu, .vtp, .obj, .off, .ply or .stl. FIELD is a .sol or .solb with any number of scalars, vectors and tensors,
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
