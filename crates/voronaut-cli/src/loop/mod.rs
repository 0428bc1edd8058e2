//! `voronaut loop`: the mesh adapted to a formula or to what a solver finds, again and again.

mod solver;

use crate::account::ours;
use crate::options::{MetricChoices, Paired, Run, finite, not_negative, positive, refuse};
use crate::progress::Bar;
use crate::{files, summary};
use clap::{Args, value_parser};
use serde_json::{Value, json};
use solver::Shell;
use std::path::{Path, PathBuf};
use std::time::Instant;
use voronaut::manifold::surface::{FeatureOptions, RepairOptions};
use voronaut::mesh::Solutions;
use voronaut::metric::{Expression, Variables};
use voronaut::quality::{Meetings, validity, validity_on};
use voronaut::recipe::{self, Adaptive, Effort, Idle, LoopOptions, MeshOptions, Origin, Source, Step, Task};
use voronaut::transfer::{Carried, Extent, Kind, Overshoot, TransferOptions};
use voronaut::{Error, Result};
use voronaut_io::{Format, Given, metric_origin};

pub(crate) const EXAMPLES: &str = "\
With --metric hessian:EXPR, a function of x, y and t (on a surface of x, y, z and t), each mesh is made for the function at one time, exactly; times go evenly from
that of the first mesh to that of the last (--time). The .sol has the
function's values, and the solution of the first mesh as it was carried through all meshes since.

With --solver CMD the first mesh is even. In each step the shell runs CMD, in which {mesh} stands for the mesh file, {start} for a .sol
to start from (what the last step found, carried over; `-` in the first), {out} for the .sol that the solver has to write, and
{step} for the number. The next mesh is for the second derivatives, recovered, of the solution that --field chooses, or in the metric
that it is; all that the solver wrote is carried to it, and is in the .sol.

Every mesh is made from DOMAIN anew: boundaries, labels and features are its own, and vertices on straight sides are free to go.

Examples:
  voronaut loop rect:0,0,1,1 --metric 'hessian:tanh(40*(x - 0.2 - 0.6*t))' -n 3000 --iterations 10 -o front.mesh --every
  voronaut loop wing.mesh --solver './solve {mesh} {start} {out}' -n 20000 --iterations 8 --gradation 1.5 -o wing.adapted.mesh
  voronaut loop plate.mesh --solver 'python3 solve.py {mesh} {out}' --complexity 4000 --norm 4 --iterations 5 -o plate.vtu --report loop.json";

#[derive(Debug, Args)]
pub(crate) struct LoopArgs {
    /// The planar domain or the surface: a file or a shape, as for `mesh`
    pub(crate) domain: String,
    /// What the mesh is for: hessian:EXPR in x, y and t, on a surface in x, y, z and t
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
    pub(crate) time: [f64; 2],
    /// Which of the solver's solutions on vertices the mesh is for, from 1
    #[arg(long, value_name = "I", default_value_t = 1, value_parser = value_parser!(u32).range(1..))]
    pub(crate) field: u32,
    #[command(flatten)]
    transfer: TransferArgs,
    #[command(flatten)]
    pub(crate) metric_choices: MetricChoices,
    /// How far (Euclidean) edges may stray from the boundary [default: the domain's own tolerance]
    #[arg(long, value_name = "D", value_parser = not_negative)]
    pub(crate) hausd: Option<f64>,
    #[command(flatten)]
    pub(crate) paired: Paired,
    /// How much work is spent on what is left to gain: fast, normal or best
    #[arg(long, value_name = "HOW", default_value_t = MeshOptions::default().effort)]
    pub(crate) effort: Effort,
    /// Steps of Riemannian Lloyd relaxation of each mesh, at most
    #[arg(long, value_name = "STEPS", default_value_t = MeshOptions::default().lloyd)]
    pub(crate) lloyd: usize,
    /// Sweeps in which the error of linear interpolation itself is lowered, at most
    #[arg(long, value_name = "SWEEPS", default_value_t = MeshOptions::default().polish)]
    pub(crate) polish: usize,
    #[command(flatten)]
    pub(crate) run: Run,
}

#[derive(Debug, Args)]
struct TransferArgs {
    /// Carry solutions by interpolation, which is fast and lets integrals drift, instead of keeping them
    #[arg(long)]
    interpolate: bool,
    /// Let values carried next to a front be beyond those on both its sides, for the least L2 distance
    #[arg(long, conflicts_with = "interpolate")]
    overshoot: bool,
    /// Symmetric tensors are no metrics: carry each entry for itself
    #[arg(long)]
    linear_tensors: bool,
}

fn times(text: &str) -> std::result::Result<[f64; 2], String> {
    finite(text).and_then(|numbers| numbers.try_into().ok()).ok_or_else(|| "not two times T0,T1".into())
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
                periodic: self.paired.pairs(),
                effort: self.effort,
                lloyd: self.lloyd,
                polish: self.polish,
                memory_limit: self.run.limits.memory(),
                ..MeshOptions::default()
            },
            transfer: TransferOptions {
                conservative: !self.transfer.interpolate,
                overshoot: if self.transfer.overshoot { Overshoot::Kept } else { Overshoot::Spread },
                linear_tensors: self.transfer.linear_tensors,
            },
        }
    }
}

/// Adapts, and writes the last mesh, or all.
pub(crate) fn run(args: &LoopArgs) -> Result<()> {
    let start = Instant::now();
    demand_writable(args)?;
    args.metric_choices.bounds().check()?;
    let given = match Given::read(&args.domain, RepairOptions::default())?.0 {
        Given::Surface(input) => Given::Surface(input.cut(&FeatureOptions::default())?),
        plane @ Given::Plane(_) => plane,
    };
    let (on, meetings): (&dyn Adaptive, _) = match &given {
        Given::Plane(domain) => (domain, None),
        Given::Surface(input) => (input, Some(Meetings::of(input.whole_mesh()))),
    };
    let options = args.options();
    demand_idle(args, &options, meetings.is_some())?;
    let bar = Bar::new(&args.run);
    let mut told = Told::new(args, start);
    let mut each = |step: &Step| {
        let mesh = &step.meshed.mesh;
        let found = meetings.as_ref().map_or_else(|| validity(mesh), |meetings| validity_on(mesh, meetings));
        found.demand().map_err(ours)?;
        told.add(step, found.area);
        if args.every {
            write(&numbered(args, step.number), step)?;
        }
        if step.number == args.iterations as usize {
            write(&args.out, step)?;
        }
        Ok(())
    };
    if let Some(command) = &args.solver {
        let shell = Shell::new(command)?;
        let mut solve = |number: usize, mesh: &_, start: Option<&Solutions>| shell.solve(number, mesh, start);
        recipe::adapt(on, Source::Solver(&mut solve), &options, &bar, &mut each)?;
    } else {
        let variables = if meetings.is_some() { Variables::SpaceMotion } else { Variables::Motion };
        let source = Source::Formula(function(args, variables)?, args.time);
        recipe::adapt(on, source, &options, &bar, &mut each)?;
    }
    drop(bar);
    args.run.write_report(&format!("{:#}\n", told.report()))
}

/// Refuses options that have no say.
fn demand_idle(args: &LoopArgs, options: &LoopOptions, on_surface: bool) -> Result<()> {
    if !on_surface {
        return Ok(());
    }
    let origin = if args.solver.is_some() { Origin::Values } else { Origin::Function };
    let task = Task { on_surface, origin, ..Task::default() };
    let idle = [options.mesh.idle(task), options.metric.idle(task)].concat();
    idle.iter().try_for_each(Idle::demand_unset)
}

/// The function that is followed.
fn function(args: &LoopArgs, variables: Variables) -> Result<Expression> {
    let text = args.metric.as_deref().unwrap_or_default().trim();
    match text.strip_prefix("hessian:") {
        Some(function) if metric_origin(text) == Origin::Function => Expression::parse(function, variables),
        _ => {
            let help = "write hessian:EXPR, a function of x, y and t (on a surface of x, y, z and t), or give a --solver; for one mesh use voronaut mesh";
            Err(Error::parse("metric", format!("`{text}` changes with nothing"), help))
        }
    }
}

/// Refuses, before any work, outputs that could not be written.
fn demand_writable(args: &LoopArgs) -> Result<()> {
    Format::from_path(&args.out)?;
    let help = "leave out --background: each mesh is the next one's";
    refuse([(args.metric_choices.background.is_some(), "a background mesh for a loop", help)])?;
    files::demand_apart([Some(args.out.as_path()), Some(&args.out.with_extension("sol")), args.run.report.as_deref()])
}

/// The file of a step's mesh.
fn numbered(args: &LoopArgs, number: usize) -> PathBuf {
    let digits = args.iterations.to_string().len().max(2);
    let ending = args.out.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    args.out.with_extension(format!("{number:0digits$}.{ending}"))
}

fn write(file: &Path, step: &Step) -> Result<()> {
    voronaut_io::write_mesh(&step.meshed.mesh, file)?;
    if step.solutions.vertices.is_empty() && step.solutions.triangles.is_empty() {
        return Ok(());
    }
    voronaut_io::write_solutions(&step.solutions, &file.with_extension("sol"))
}

/// Says each step in a line of stdout, unless told to be quiet, and keeps all figures for the report.
struct Told<'a> {
    args: &'a LoopArgs,
    steps: Vec<Value>,
    start: Instant,
    last: Instant,
}

impl<'a> Told<'a> {
    fn new(args: &'a LoopArgs, start: Instant) -> Self {
        Self { args, steps: Vec::new(), start, last: start }
    }

    fn add(&mut self, step: &Step, area: f64) {
        let seconds = self.last.elapsed().as_secs_f64();
        self.last = Instant::now();
        let mesh = &step.meshed.mesh;
        let drift = step.transfer.as_ref().map(|(carried, _)| drift(carried, area));
        let error = step.meshed.polished.as_ref().and_then(|polished| polished.error.last().copied());
        if !self.args.run.quiet {
            let time = step.time.map_or(String::new(), |time| format!("t {time:.4}, "));
            let error = error.map_or(String::new(), |error| format!(", error {error:.3e}"));
            let drift = drift.map_or(String::new(), |drift| format!(", masses kept to {drift:.1e}"));
            let (count, border) = (mesh.points.len(), step.boundary_vertices);
            summary::out(&format!(
                "step {:>3}: {time}{count} vertices, {border} on the boundary{error}{drift}, {seconds:.2} s\n",
                step.number
            ));
            summary::notes(step.meshed.notes.iter().map(|note| format!("step {}: {note}", step.number)), false);
        }
        self.steps.push(json!({
            "step": step.number, "time": step.time, "vertices": mesh.points.len(), "triangles": mesh.triangles.len(),
            "boundary_vertices": step.boundary_vertices, "valid": true, "metric_scale": step.meshed.metric_scale,
            "polished_error": error, "mass_drift": drift,
            "fields": step.transfer.as_ref().map(|(carried, _)| carried.iter().map(field).collect::<Vec<Value>>()),
            "cover": step.transfer.as_ref().map(|(_, cover)| cover), "notes": step.meshed.notes, "seconds": seconds,
        }));
    }

    fn report(&self) -> Value {
        let args = self.args;
        let options = args.options();
        let (metric, transfer) = (&options.metric, &options.transfer);
        json!({
            "steps": self.steps, "seconds": { "total": self.start.elapsed().as_secs_f64() },
            "peak_memory_bytes": voronaut_io::peak_memory_bytes(), "version": env!("CARGO_PKG_VERSION"),
            "options": {
                "domain": args.domain, "metric": args.metric, "solver": args.solver, "iterations": args.iterations,
                "out": args.out, "every": args.every, "time": args.time, "field": args.field,
                "norm": metric.norm.to_string(), "recovery": metric.recovery, "h_min": metric.bounds.h_min,
                "h_max": metric.bounds.h_max, "a_max": metric.bounds.a_max, "smooth_metric": metric.smooth_metric,
                "gradation": metric.gradation, "conservative": transfer.conservative, "overshoot": args.transfer.overshoot,
                "linear_tensors": transfer.linear_tensors, "mesh": options.mesh, "threads": args.run.threads,
            },
        })
    }
}

fn field(carried: &Carried) -> Value {
    json!({ "components": carried.field.components(), "before": carried.before, "after": carried.after })
}

/// The greatest change of a mass, as a share of what the field would weigh with its greatest magnitude everywhere.
fn drift(carried: &[Carried], area: f64) -> f64 {
    let of = |(before, after): (&Extent, &Extent)| {
        let scale = before.max.abs().max(before.min.abs()) * area;
        if scale > 0.0 { (after.mass - before.mass).abs() / scale } else { 0.0 }
    };
    let densities = carried.iter().filter(|carried| matches!(carried.field.kind, Kind::Linear(_)));
    densities.flat_map(|carried| carried.before.iter().zip(&carried.after)).map(of).fold(0.0, f64::max)
}
