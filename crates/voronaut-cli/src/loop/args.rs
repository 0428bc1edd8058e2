//! What users of `voronaut loop` type.

use crate::options::{Memory, MetricChoices, Run, finite, not_negative, positive};
use clap::{Args, value_parser};
use std::path::PathBuf;
use voronaut::recipe::{LoopOptions, MeshOptions};
use voronaut::transfer::{Overshoot, TransferOptions};

pub(crate) const EXAMPLES: &str = "\
With --metric hessian:EXPR, a function of x, y and t, each mesh is made for the function at one time, exactly; times go evenly from
that of the first mesh to that of the last (--time). The .sol has the
function's values, and the solution of the first mesh as it was carried through all meshes since.

With --solver CMD the first mesh is even. In each step the shell runs CMD, in which {mesh} stands for the mesh file, {start} for a .sol
to start from (what the last step found, carried over; `-` in the first), {out} for the .sol that the solver has to write, and
{step} for the number; put quotes around them if your directory for temporary files has spaces. The next mesh is for the second derivatives, recovered, of the solution that --field chooses, or in the metric
that it is; all that the solver wrote is carried to it, and is in the .sol.

Every mesh is made from DOMAIN anew: boundaries, labels and features are its own, and vertices on straight sides are free to go.

Examples:
  voronaut loop rect:0,0,1,1 --metric 'hessian:tanh(40*(x - 0.2 - 0.6*t))' -n 3000 --iterations 10 -o front.mesh --every
  voronaut loop wing.mesh --solver './solve {mesh} {start} {out}' -n 20000 --iterations 8 --gradation 1.5 -o wing.adapted.mesh
  voronaut loop plate.mesh --solver 'python3 solve.py {mesh} {out}' --complexity 4000 --norm 4 --iterations 5 -o plate.vtu --report loop.json";

#[derive(Debug, Args)]
pub(crate) struct LoopArgs {
    /// The planar domain: a file or a shape, as for `mesh`
    pub(crate) domain: String,
    /// What the mesh is for: hessian:EXPR in x, y and t
    #[arg(long, required_unless_present = "solver", conflicts_with = "solver")]
    pub(crate) metric: Option<String>,
    /// The solver: a command with {mesh}, {start}, {out} and {step} (see below)
    #[arg(long, value_name = "CMD")]
    pub(crate) solver: Option<String>,
    /// How often the mesh is adapted
    #[arg(long, value_name = "K", value_parser = value_parser!(u32).range(1..))]
    pub(crate) iterations: u32,
    /// Vertices of each mesh
    #[arg(short = 'n', long, value_name = "N", value_parser = value_parser!(u32).range(3..), conflicts_with = "complexity", required_unless_present = "complexity")]
    pub(crate) vertices: Option<u32>,
    /// Integral of sqrt(det M) over the domain
    #[arg(long, value_name = "C", value_parser = positive)]
    pub(crate) complexity: Option<f64>,
    /// The last mesh; its solutions are next to it, in a .sol of the same name
    #[arg(short, long, value_name = "OUT")]
    pub(crate) out: PathBuf,
    /// Write the mesh of every step, too: OUT with .01, .02, ... before its ending
    #[arg(long)]
    pub(crate) every: bool,
    /// The time of the first and of the last mesh
    #[arg(long, value_name = "T0,T1", value_parser = times, default_value = "0,1", allow_hyphen_values = true, conflicts_with = "solver")]
    pub(crate) time: Times,
    /// Which of the solver's solutions on vertices the mesh is for, from 1
    #[arg(long, value_name = "I", default_value_t = 1, value_parser = value_parser!(u32).range(1..))]
    pub(crate) field: u32,
    #[command(flatten)]
    pub(crate) transfer: TransferArgs,
    #[command(flatten)]
    pub(crate) metric_choices: MetricChoices,
    /// How far (Euclidean) edges may stray from the boundary [default: the domain's own tolerance]
    #[arg(long, value_name = "D", value_parser = not_negative)]
    pub(crate) hausd: Option<f64>,
    /// Steps of Riemannian Lloyd relaxation of each mesh
    #[arg(long, value_name = "STEPS", default_value_t = MeshOptions::default().lloyd)]
    pub(crate) lloyd: usize,
    /// Sweeps in which the error of linear interpolation itself is lowered, at most
    #[arg(long, value_name = "SWEEPS", default_value_t = MeshOptions::default().polish)]
    pub(crate) polish: usize,
    #[command(flatten)]
    pub(crate) memory: Memory,
    #[command(flatten)]
    pub(crate) run: Run,
}

#[derive(Debug, Args)]
pub(crate) struct TransferArgs {
    /// Carry solutions by interpolation, which is fast and lets integrals drift, instead of keeping them
    #[arg(long)]
    pub(crate) interpolate: bool,
    /// Let values carried next to a front be beyond those on both its sides, for the least L2 distance
    #[arg(long, conflicts_with = "interpolate")]
    pub(crate) overshoot: bool,
    /// Symmetric tensors are no metrics: carry each entry for itself
    #[arg(long)]
    pub(crate) linear_tensors: bool,
}

impl TransferArgs {
    fn options(&self) -> TransferOptions {
        let overshoot = if self.overshoot { Overshoot::Kept } else { Overshoot::Spread };
        TransferOptions { conservative: !self.interpolate, overshoot, linear_tensors: self.linear_tensors }
    }
}

/// The time of the first and of the last mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Times(pub(crate) [f64; 2]);

fn times(text: &str) -> Result<Times, String> {
    let times = finite(text).and_then(|numbers| numbers.try_into().ok());
    times.map(Times).ok_or_else(|| "not two times T0,T1".into())
}

impl LoopArgs {
    pub(crate) fn options(&self) -> LoopOptions {
        LoopOptions {
            iterations: self.iterations as usize,
            field: self.field as usize,
            metric: self.metric_choices.options(),
            mesh: MeshOptions {
                vertices: self.vertices.map(|vertices| vertices as usize),
                complexity: self.complexity,
                hausd: self.hausd,
                lloyd: self.lloyd,
                polish: self.polish,
                memory_limit: self.memory.bytes(),
                ..MeshOptions::default()
            },
            transfer: self.transfer.options(),
        }
    }
}
