//! `voronaut metric`: metrics at the vertices of a mesh, from solutions and other metrics.

mod args;
mod sources;

pub(crate) use args::{EXAMPLES, MetricArgs};

use crate::{files, summary};
use args::{Combine, LimitText};
use serde_json::{Value, json};
use std::time::Instant;
use voronaut::mesh::{Mesh, Solution, SolutionValues};
use voronaut::metric::nodal::{COMPLEXITY_PER_VERTEX, Combination, Outcome, Pipeline};
use voronaut::{Error, Result};
use voronaut_io::Document;

/// Makes the metric and writes it.
pub(crate) fn run(args: &MetricArgs) -> Result<()> {
    let start = Instant::now();
    files::demand_solution(&args.out, &args.run)?;
    args.run.set_threads()?;
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
    let sources = args.metric.iter().map(|text| sources::source(text, &mesh, args)).collect::<Result<Vec<_>>>()?;
    let made = pipeline.run(&mesh, &sources)?;
    let values = SolutionValues::Tensor(made.tensors.iter().map(|m| [m.xx, m.xy, m.yy]).collect());
    voronaut_io::write_solution(&Solution { dimension: 2, values }, &args.out)?;
    let told = told(args, &mesh, &made, start.elapsed().as_secs_f64());
    args.run.write_report(&format!("{told:#}\n"))?;
    summary::print_metric(&args.out, &told, &args.run);
    Ok(())
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
    let limit = |text: &Option<LimitText>| text.as_ref().map(LimitText::as_used);
    json!({
        "vertices": mesh.points.len(), "triangles": mesh.triangles.len(),
        "complexity": made.complexity, "expected_vertices": (made.complexity / COMPLEXITY_PER_VERTEX).round() as u64,
        "size": { "min": least, "max": greatest }, "anisotropy": { "max": anisotropy },
        "factor": made.factor, "touched": made.touched,
        "seconds": { "total": seconds }, "peak_memory_bytes": voronaut_io::peak_memory_bytes(), "version": env!("CARGO_PKG_VERSION"),
        "options": {
            "mesh": args.mesh, "metric": args.metric, "out": args.out, "norm": args.norm.to_string(),
            "combine": format!("{:?}", args.combine).to_lowercase(), "weights": args.weights, "complexity": args.complexity,
            "h_min": limit(&args.h_min), "h_max": limit(&args.h_max), "a_max": limit(&args.a_max),
            "gradation": args.gradation, "recovery": args.recovery, "background": args.background, "report": args.run.report,
            "threads": args.run.threads,
        },
    })
}
