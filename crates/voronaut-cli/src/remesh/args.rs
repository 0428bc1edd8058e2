//! What users of mmg2d and mmgs type.

use crate::options::{Damage, Limits, Run, not_negative, positive};
use clap::Args;
use std::path::PathBuf;
use voronaut::manifold::surface::{FeatureOptions, RepairOptions};
use voronaut::mesh::TensorOrder;
use voronaut::recipe::Effort;

pub(crate) const EXAMPLES: &str = "\
Options are spelt as mmg2d's and mmgs's, with one dash or two. IN.sol next to IN.mesh is the metric if no other is named, as mmg has
it: sizes h or tensors 1/h^2 at the vertices of IN, kept where the distance to curves or surface does not ask for less. OUT is
IN.o.mesh if not given; the metric that was used is written next to it, OUT.sol, with its values at the vertices of OUT.

A .mesh of dimension 2, or with z = 0 everywhere, is a planar mesh, as for mmg2d; one without triangles is the boundary of a domain.
Labels of triangles and edges are kept, and with them the boundary, interfaces between labels, and what is required.

Lengths are those of the file: 0.01, the default of -hausd, is a hundredth of its unit, whatever the size of the part.

Examples:
  voronaut remesh square.mesh -sol error.sol -hmin 0.001 -hmax 0.2 -hgrad 1.3 out.mesh
  voronaut remesh square.mesh -hsiz 0.05
  voronaut remesh square.mesh -optim -nosurf
  voronaut remesh part.mesh
  voronaut remesh part.mesh -hausd 0.001 -hmax 0.1 -out fine.mesh
  voronaut remesh part.mesh thin.mesh -A -hausd 0.001
  voronaut remesh -in part.mesh -sol error.sol -hmin 0.01 -hgrad 1.2 -o adapted.mesh --report run.json";

/// Where mmg's defaults are the user's expectation.
const HAUSD: f64 = 0.01;
const HGRAD: f64 = 1.3;

#[derive(Debug, Args)]
#[expect(clippy::struct_excessive_bools, reason = "one per option of mmg")]
pub(crate) struct RemeshArgs {
    /// The planar mesh, or the surface: .mesh, .meshb, .msh, .su2, .vtu, .vtp, .obj, .off, .ply or .stl; without an ending .meshb if that is there, else .mesh
    #[arg(value_name = "IN", required_unless_present = "input")]
    pub(crate) first: Option<PathBuf>,
    /// The mesh [default: IN.o.mesh]
    #[arg(value_name = "OUT", conflicts_with = "out")]
    pub(crate) second: Option<PathBuf>,
    /// The input, named
    #[arg(long = "in", value_name = "IN")]
    input: Option<PathBuf>,
    /// The mesh, named: .mesh, .meshb, .msh, .su2, .vtu, .vtp, .obj, .off, .ply or .stl
    #[arg(short, long, value_name = "OUT")]
    out: Option<PathBuf>,
    /// Sizes or tensors at the vertices of IN, as -sol or -met
    #[arg(long, visible_alias = "met", value_name = "FILE")]
    pub(crate) sol: Option<PathBuf>,
    /// In which order tensors of -sol have their entries: disk (m11 m12 m22 m13 m23 m33, as mmg's files have), upper (m11 m12 m13 m22 m23
    /// m33) or diagonal (m11 m22 m33 m12 m23 m13)
    #[arg(long, value_name = "ORDER", default_value_t = TensorOrder::default())]
    pub(crate) tensor_order: TensorOrder,
    /// How far the mesh may be from the surface, or from the curves of a planar domain
    #[arg(long, value_name = "D", value_parser = positive, default_value_t = HAUSD)]
    pub(crate) hausd: f64,
    /// No size is less [default: a thousandth of the extent; of a planar mesh with a metric a tenth of its least]
    #[arg(long, value_name = "H", value_parser = positive)]
    pub(crate) hmin: Option<f64>,
    /// No size is more [default: the bounding box's diagonal; of a planar mesh twice its extent, or ten times a metric's greatest]
    #[arg(long, value_name = "H", value_parser = positive)]
    pub(crate) hmax: Option<f64>,
    /// The same size everywhere, but where the distance to surface or curves asks for less
    #[arg(long, value_name = "H", value_parser = positive, conflicts_with_all = ["sol", "hmax", "optim"])]
    pub(crate) hsiz: Option<f64>,
    /// Edges where the normal turns by more than this angle (degrees) are creases, and curves that do have a corner; both are kept
    #[arg(long, value_name = "DEGREES", value_parser = not_negative, default_value_t = FeatureOptions::DEFAULT_ANGLE)]
    ar: f64,
    /// Look for no creases and corners by angles
    #[arg(long)]
    nr: bool,
    #[command(flatten)]
    pub(crate) damage: Damage,
    /// Sizes grow from edge to edge by this factor at most; -1: as they will
    #[arg(long, value_name = "G", allow_negative_numbers = true, default_value_t = HGRAD)]
    pub(crate) hgrad: f64,
    /// Sizes that follow the directions of curvature and curves, or of the planar mesh's own triangles (-optim)
    #[arg(short = 'A')]
    pub(crate) anisotropic: bool,
    /// The sizes that a planar mesh has
    #[arg(long, conflicts_with = "sol")]
    pub(crate) optim: bool,
    /// Leave the edges of a planar mesh's boundary and interfaces as they are
    #[arg(long)]
    pub(crate) nosurf: bool,
    /// Keep listed edges inside a region of a planar mesh, required or not
    #[arg(long)]
    pub(crate) opnbdy: bool,
    /// Sizes at required edges of a planar mesh as elsewhere, even where these are shorter
    #[arg(long)]
    pub(crate) nosizreq: bool,
    /// Vertices on the surface, instead of where mesh and surface are closest in the sense of least squares
    #[arg(long)]
    pub(crate) no_fit: bool,
    /// How much work is spent on what is left to gain: fast, normal or best [default: fast in the plane, normal on a surface]
    #[arg(long, value_name = "HOW")]
    pub(crate) effort: Option<Effort>,
    /// --memory-limit in megabytes
    #[arg(short, long, value_name = "MB", value_parser = positive, conflicts_with = "memory_limit")]
    pub(crate) memory: Option<f64>,
    /// How much is said, as mmg's -v N: nothing from 0 down, more from 5 up
    #[arg(long, value_name = "N", allow_negative_numbers = true, conflicts_with_all = ["quiet", "verbose"])]
    pub(crate) verbosity: Option<i32>,
    #[command(flatten)]
    run: Run,
    #[command(flatten)]
    unused: Unused,
}

/// Options of mmg that change nothing here.
#[derive(Debug, Args)]
#[expect(
    clippy::struct_excessive_bools,
    clippy::option_option,
    reason = "one per option of mmg, some with a value or none"
)]
#[command(next_help_heading = "Options of mmg that are accepted, and change nothing")]
struct Unused {
    #[arg(long, value_name = "G", allow_negative_numbers = true)]
    hgradreq: Option<f64>,
    #[arg(long)]
    noinsert: bool,
    #[arg(long)]
    noswap: bool,
    #[arg(long)]
    nomove: bool,
    #[arg(long)]
    nreg: bool,
    #[arg(long, value_name = "X", num_args = 0..=1)]
    xreg: Option<Option<f64>>,
    #[arg(long, value_name = "X", num_args = 0..=1)]
    rmc: Option<Option<f64>>,
    #[arg(long)]
    nofem: bool,
    #[arg(long = "keep-ref")]
    keep_ref: bool,
    #[arg(long = "3dMedit", value_name = "N")]
    medit: Option<i32>,
    #[arg(short)]
    debug: bool,
}

impl RemeshArgs {
    /// What was given and changes nothing for a planar mesh, or for a surface, and why.
    pub(crate) fn warnings(&self, is_planar: bool) -> Vec<String> {
        const LOCAL: &str = "the mesh is made anew, not by local changes";
        const REQUIRED: &str = "sizes at what is required are as those elsewhere";
        const AS_GIVEN: &str = "curves and surfaces are meshed as they are given";
        const LEVEL: &str = "it is for level sets";
        const SURFACES: &str = "it does not concern surfaces";
        const PLANE: &str = "it does not concern planar meshes";
        let unused = &self.unused;
        let all = [
            ("-hgradreq", unused.hgradreq.is_some(), if is_planar { "-hgrad is for all sizes" } else { REQUIRED }),
            ("-nosizreq", self.nosizreq && !is_planar, REQUIRED),
            ("-noinsert", unused.noinsert, LOCAL),
            ("-noswap", unused.noswap, LOCAL),
            ("-nomove", unused.nomove, LOCAL),
            ("-nreg", unused.nreg, AS_GIVEN),
            ("-xreg", unused.xreg.is_some(), AS_GIVEN),
            ("-rmc", unused.rmc.is_some(), LEVEL),
            ("-keep-ref", unused.keep_ref, LEVEL),
            ("-nofem", unused.nofem, if is_planar { LOCAL } else { SURFACES }),
            ("-3dMedit", unused.medit.is_some(), "planar meshes are read in dimension 2 and 3, and written in 2"),
            ("-d", unused.debug, "--report has the figures"),
            ("-nosurf", self.nosurf && !is_planar, SURFACES),
            ("-opnbdy", self.opnbdy && !is_planar, SURFACES),
            ("-optim", self.optim && !is_planar, LOCAL),
            ("--no-fit", self.no_fit && is_planar, PLANE),
            ("--repair", self.damage.options() != RepairOptions::default() && is_planar, PLANE),
        ];
        let given = all.into_iter().filter(|(_, is_given, _)| *is_given);
        given.map(|(name, _, why)| format!("{name} changes nothing: {why}")).collect()
    }

    /// The input's file; without an ending that of Medit, as mmg has it.
    pub(crate) fn input(&self) -> PathBuf {
        let named = self.input.as_ref().or(self.first.as_ref()).cloned().unwrap_or_default();
        let binary = named.with_extension("meshb");
        if named.extension().is_none() && binary.is_file() { binary } else { with_ending(named) }
    }

    /// The mesh's file. With -in the first word without an option is OUT.
    pub(crate) fn out(&self) -> PathBuf {
        let first = self.first.as_ref().filter(|_| self.input.is_some());
        let named = self.out.as_ref().or(self.second.as_ref()).or(first);
        let input = self.input();
        let is_binary = input.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("meshb"));
        let ending = if is_binary { "o.meshb" } else { "o.mesh" };
        match named {
            Some(out) if out.extension().is_none() && is_binary => out.with_extension("meshb"),
            Some(out) => with_ending(out.clone()),
            None => input.with_extension(ending),
        }
    }

    /// What is kept as creases.
    pub(crate) fn features(&self) -> FeatureOptions {
        FeatureOptions { ar: (!self.nr).then_some(self.ar) }
    }

    /// Threads, and how much is said.
    pub(crate) fn run(&self) -> Run {
        /// Megabytes of a gibibyte, as mmg counts.
        const MEGABYTES: f64 = 1024.0;
        let memory_limit = self.memory.map_or(self.run.limits.memory_limit, |megabytes| megabytes / MEGABYTES);
        Run {
            limits: Limits { memory_limit, ..self.run.limits },
            report: self.run.report.clone(),
            threads: self.run.threads,
            quiet: self.run.quiet || self.verbosity.is_some_and(|n| n <= 0),
            verbose: self.run.verbose || self.verbosity.is_some_and(|n| n >= 5),
        }
    }

    /// `None` where sizes may grow as they will.
    pub(crate) fn gradation(&self) -> Option<f64> {
        (self.hgrad >= 0.0).then_some(self.hgrad)
    }
}

fn with_ending(path: PathBuf) -> PathBuf {
    if path.extension().is_some() { path } else { path.with_extension("mesh") }
}
