//! `voronaut metric`: metrics at the vertices of a mesh, from solutions and other metrics.

mod args;
mod sources;

pub(crate) use args::{EXAMPLES, MetricArgs};

use crate::files;
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
    demand_writable(args)?;
    files::set_threads(&args.run)?;
    let pipeline = Pipeline {
        norm: args.norm,
        target_complexity: args.complexity,
        combination: combination(args)?,
        limits: sources::limits(args)?,
        gradation_factor: args.gradation,
    };
    let Document { mesh, notes, .. } = voronaut_io::read(&args.mesh)?;
    crate::summary::notes(&notes, args.run.quiet);
    mesh.check_numbers()?;
    let sources = args.metric.iter().map(|text| sources::source(text, &mesh, args)).collect::<Result<Vec<_>>>()?;
    let made = pipeline.run(&mesh, &sources)?;
    let figures = Figures::of(&made);
    let values = SolutionValues::Tensor(made.tensors.iter().map(|m| [m.xx, m.xy, m.yy]).collect());
    voronaut_io::write_solution(&Solution { dimension: 2, values }, &args.out)?;
    let told = told(args, &mesh, &made, &figures, start.elapsed().as_secs_f64());
    if let Some(file) = &args.report {
        voronaut_io::write(file, format!("{told:#}\n").as_bytes())?;
    }
    crate::summary::print_metric(&args.out.display().to_string(), &told, &args.run);
    Ok(())
}

fn demand_writable(args: &MetricArgs) -> Result<()> {
    let ending = args.out.extension().map(std::ffi::OsStr::to_ascii_lowercase);
    if ending.is_none_or(|ending| ending != "sol" && ending != "solb") {
        let what = "the name does not end in .sol or .solb";
        return Err(Error::parse(
            args.out.display().to_string(),
            what,
            "metrics at vertices are written to a file .sol or .solb",
        ));
    }
    let own = voronaut_io::place(&args.out)?;
    if let Some(file) = &args.report
        && voronaut_io::place(file)? == own
    {
        let what = "two outputs have the same name";
        return Err(Error::parse(file.display().to_string(), what, "give each output a name of its own"));
    }
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

/// Sizes of a metric at its vertices.
struct Figures {
    least: f64,
    greatest: f64,
    anisotropy: f64,
}

impl Figures {
    fn of(made: &Outcome) -> Self {
        let none = Self { least: f64::INFINITY, greatest: 0.0, anisotropy: 1.0 };
        made.tensors.iter().fold(none, |found, tensor| {
            let e = tensor.eigen();
            Self {
                least: found.least.min(e.large.powf(-0.5)),
                greatest: found.greatest.max(e.small.powf(-0.5)),
                anisotropy: found.anisotropy.max(tensor.anisotropy()),
            }
        })
    }
}

fn told(args: &MetricArgs, mesh: &Mesh, made: &Outcome, figures: &Figures, seconds: f64) -> Value {
    let limit = |text: &Option<LimitText>| text.as_ref().map(LimitText::as_used);
    json!({
        "vertices": mesh.points.len(), "triangles": mesh.triangles.len(),
        "complexity": made.complexity, "expected_vertices": (made.complexity / COMPLEXITY_PER_VERTEX).round() as u64,
        "size": { "min": figures.least, "max": figures.greatest }, "anisotropy": { "max": figures.anisotropy },
        "factor": made.factor, "touched": made.touched,
        "seconds": { "total": seconds }, "peak_memory_bytes": voronaut_io::peak_memory_bytes(), "version": env!("CARGO_PKG_VERSION"),
        "options": {
            "mesh": args.mesh, "metric": args.metric, "out": args.out, "norm": args.norm.to_string(),
            "combine": format!("{:?}", args.combine).to_lowercase(), "weights": args.weights, "complexity": args.complexity,
            "h_min": limit(&args.h_min), "h_max": limit(&args.h_max), "a_max": limit(&args.a_max),
            "gradation": args.gradation, "recovery": args.recovery, "background": args.background, "report": args.report,
            "threads": args.run.threads,
        },
    })
}
