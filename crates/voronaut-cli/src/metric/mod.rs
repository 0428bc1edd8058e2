//! `voronaut metric`: metrics at the vertices of a mesh, from solutions and other metrics.

mod sources;

use crate::options::{Run, positive, refuse};
use crate::{files, summary};
use clap::{Args, ValueEnum};
use serde::Serialize;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::str::FromStr;
use std::time::Instant;
use voronaut::manifold::Manifold;
use voronaut::mesh::{Mesh, Solution, SolutionValues, TensorOrder};
use voronaut::metric::nodal::{COMPLEXITY_PER_VERTEX, Combination, Outcome, Pipeline};
use voronaut::metric::{Norm, Recovery};
use voronaut::recipe::metric_at_vertices;
use voronaut::{Error, Result};
use voronaut_io::Document;

pub(crate) const EXAMPLES: &str = "\
METRIC  as for `mesh` (uniform, shock, swirl, boundary:h0=, 'formula:m11; m12; m22', FILE.sol with tensors or sizes), or
        hessian:FILE.sol    second derivatives of a solution on MESH, recovered
        'hessian:EXPR'      those of an expression in x and y, exact; with --recovery, recovered from its values
        implied             the metric in which MESH is as even as can be
On the mesh of a surface (some z is not 0) METRIC is as for `mesh` there (uniform, curvature, shock, formulas of six entries in x, y and z,
hessian:EXPR in x, y and z, FILE.sol with one size or tensor per vertex), hessian:FILE.sol or implied: tensors are made in the tangent planes,
on each side of a crease for itself; a vertex of several sides gets a tensor that is as fine in each as that asks for.

What is done, in this order: absolute values of Hessians and their weights for the norm; one complexity for all metrics, if one is
asked for; combination; limits on sizes, then on the anisotropy; gradation; and last the factor that makes the complexity of what
comes out the one asked for.

A unit mesh has about 1.15 vertices for each unit of complexity.

Examples:
  voronaut metric wing.mesh --metric hessian:mach.sol --complexity 5000 --h-min 1e-5 --gradation 1.5 -o wing.sol
  voronaut metric wing.mesh --metric hessian:mach.sol --metric hessian:density.sol --norm 4 --complexity 5000 -o wing.sol
  voronaut metric plate.mesh --metric 'hessian:tanh(40*(y - x))' --complexity 2000 -o plate.sol --report plate.json
  voronaut metric plate.mesh --metric implied --metric sizes.sol --combine average --weights 1,3 -o plate.sol
  voronaut metric spot.obj --metric curvature --metric hessian:heat.sol --complexity 5000 --gradation 1.3 -o spot.sol
  voronaut mesh wing.mesh --metric wing.sol -o adapted.mesh";

#[derive(Debug, Args)]
pub(crate) struct MetricArgs {
    /// The mesh, planar or of a surface, at whose vertices the metric is made: .mesh, .meshb, .msh, .su2, .vtu, .vtp, .obj, .off, .ply or .stl
    pub(crate) mesh: PathBuf,
    /// Where the metric comes from (see below); may be given more than once
    #[arg(long, value_name = "METRIC", required = true)]
    pub(crate) metric: Vec<String>,
    /// The metric, one tensor per vertex, m11 m12 m22 or of a surface m11 m12 m22 m13 m23 m33: .sol
    #[arg(short, long, value_name = "OUT")]
    pub(crate) out: PathBuf,
    /// What several metrics become: one as fine as each, or their log-Euclidean mean
    #[arg(long, value_enum, value_name = "HOW", default_value_t = Combine::Intersect)]
    pub(crate) combine: Combine,
    /// With --combine average: a weight for each metric [default: all the same]
    #[arg(long, value_name = "W,W", value_delimiter = ',')]
    pub(crate) weights: Vec<f64>,
    /// The L^p norm in which the interpolation error of Hessians' functions is to be least: 1, 2, 4, inf
    #[arg(long, value_name = "P", default_value_t = Norm::default())]
    pub(crate) norm: Norm,
    /// Integral of sqrt(det M) over the mesh [default: metrics are not scaled]
    #[arg(long, value_name = "C", value_parser = positive)]
    pub(crate) complexity: Option<f64>,
    /// Least Euclidean size: a number, or one for each vertex
    #[arg(long, value_name = "H|FILE.sol")]
    pub(crate) h_min: Option<LimitText>,
    /// Greatest Euclidean size
    #[arg(long, value_name = "H|FILE.sol")]
    pub(crate) h_max: Option<LimitText>,
    /// Greatest ratio of the two sizes at a point, at least 1
    #[arg(long, value_name = "RATIO|FILE.sol")]
    pub(crate) a_max: Option<LimitText>,
    /// Sizes of neighbouring edges differ by about this factor at most, such as 1.3 [default: no gradation]
    #[arg(long, value_name = "FACTOR", value_parser = positive)]
    pub(crate) gradation: Option<f64>,
    /// How second derivatives are recovered from values: fit (a quadratic around each vertex) or l2 (a double projection)
    #[arg(long, value_name = "HOW")]
    pub(crate) recovery: Option<Recovery>,
    /// In which order tensors in files have their entries: disk (m11 m12 m22, as .sol files have) or diagonal (m11 m22 m12)
    #[arg(long, value_name = "ORDER", default_value_t = TensorOrder::default())]
    pub(crate) tensor_order: TensorOrder,
    /// The mesh on which a .sol metric is given, if that is not MESH
    #[arg(long, value_name = "MESH")]
    pub(crate) background: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) run: Run,
}

/// How metrics are combined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Combine {
    /// As fine as each
    Intersect,
    /// The log-Euclidean mean
    Average,
}

/// A limit as it is typed, and as reports have it.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub(crate) enum LimitText {
    /// The same everywhere.
    Number(f64),
    /// In a file.
    File(PathBuf),
}

impl FromStr for LimitText {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        if text.to_ascii_lowercase().ends_with(".sol") {
            return Ok(LimitText::File(text.into()));
        }
        positive(text).map(LimitText::Number).map_err(|_| "neither a positive number nor a file .sol".into())
    }
}

/// Makes the metric and writes it.
pub(crate) fn run(args: &MetricArgs) -> Result<()> {
    let start = Instant::now();
    files::demand_solution(&args.out, &args.run)?;
    let pipeline = Pipeline {
        norm: args.norm,
        target_complexity: args.complexity,
        combination: combination(args)?,
        limits: sources::limits(args)?,
        gradation_factor: args.gradation,
    };
    let Document { mesh, notes, .. } = voronaut_io::read(&args.mesh)?;
    summary::notes(&notes, args.run.quiet);
    mesh.check_numbers()?;
    refuse([(mesh.curved.is_some(), "a metric on curved triangles", "convert the mesh with --order 1")])?;
    let (made, solution) =
        if mesh.is_planar() { in_plane(args, &pipeline, &mesh)? } else { on_surface(args, &pipeline, &mesh)? };
    voronaut_io::write_solution(&solution, &args.out)?;
    let told = told(args, &mesh, &made, start.elapsed().as_secs_f64());
    args.run.write_report(&format!("{told:#}\n"))?;
    summary::print_metric(&args.out, &told, &args.run);
    Ok(())
}

fn in_plane(args: &MetricArgs, pipeline: &Pipeline, mesh: &Mesh) -> Result<(Outcome, Solution)> {
    let sources = args.metric.iter().map(|text| sources::source(text, mesh, args)).collect::<Result<Vec<_>>>()?;
    let made = pipeline.run(mesh, &sources)?;
    let values = SolutionValues::Tensor(made.tensors.iter().map(|m| [m.xx, m.xy, m.yy]).collect());
    Ok((made, Solution { dimension: 2, values }))
}

fn on_surface(args: &MetricArgs, pipeline: &Pipeline, mesh: &Mesh) -> Result<(Outcome, Solution)> {
    sources::demand_for_surfaces(args)?;
    let read = |text: &String| sources::OnSurface::read(text, mesh, args);
    let read = args.metric.iter().map(read).collect::<Result<Vec<_>>>()?;
    metric_at_vertices(pipeline, Manifold::of(mesh)?, read.iter().map(sources::OnSurface::source).collect())
}

fn combination(args: &MetricArgs) -> Result<Combination> {
    match args.combine {
        Combine::Average if args.weights.is_empty() => Ok(Combination::Average(vec![1.0; args.metric.len()])),
        Combine::Average => Ok(Combination::Average(args.weights.clone())),
        Combine::Intersect if args.weights.is_empty() => Ok(Combination::Intersect),
        Combine::Intersect => {
            let help = "add --combine average, or leave out --weights";
            Err(Error::parse("weights", "an intersection has no weights", help))
        }
    }
}

fn told(args: &MetricArgs, mesh: &Mesh, made: &Outcome, seconds: f64) -> Value {
    let eigen = || made.tensors.iter().map(|m| m.eigen());
    let least = eigen().map(|e| e.large.powf(-0.5)).fold(f64::INFINITY, f64::min);
    let greatest = eigen().map(|e| e.small.powf(-0.5)).fold(0.0, f64::max);
    let anisotropy = made.tensors.iter().map(|m| m.anisotropy()).fold(1.0, f64::max);
    json!({
        "vertices": mesh.points.len(), "triangles": mesh.triangles.len(),
        "complexity": made.complexity, "expected_vertices": (made.complexity / COMPLEXITY_PER_VERTEX).round() as u64,
        "size": { "min": least, "max": greatest }, "anisotropy": { "max": anisotropy },
        "factor": made.factor, "touched": made.touched,
        "seconds": { "total": seconds }, "peak_memory_bytes": voronaut_io::peak_memory_bytes(), "version": env!("CARGO_PKG_VERSION"),
        "options": {
            "mesh": args.mesh, "metric": args.metric, "out": args.out, "norm": args.norm.to_string(),
            "combine": args.combine, "weights": args.weights, "complexity": args.complexity,
            "h_min": args.h_min, "h_max": args.h_max, "a_max": args.a_max,
            "gradation": args.gradation, "recovery": args.recovery, "background": args.background, "report": args.run.report,
            "threads": args.run.threads,
        },
    })
}
