//! `voronaut loop`: the mesh adapted to a formula or to what a solver finds, again and again.

mod args;
mod solver;
mod told;

pub(crate) use args::{EXAMPLES, LoopArgs};

use crate::account::ours;
use crate::files;
use crate::options::refuse;
use crate::progress::Bar;
use solver::Shell;
use std::path::{Path, PathBuf};
use std::time::Instant;
use told::Told;
use voronaut::mesh::Solutions;
use voronaut::metric::{Expression, Variables};
use voronaut::quality::validity;
use voronaut::recipe::{self, Source, Step};
use voronaut::{Error, Result};
use voronaut_io::{Format, Given};

/// Adapts, and writes the last mesh, or all.
pub(crate) fn run(args: &LoopArgs) -> Result<()> {
    let start = Instant::now();
    demand_writable(args)?;
    args.run.set_threads()?;
    args.metric_choices.bounds().check()?;
    let domain = match Given::read(&args.domain, None)? {
        Given::Plane(domain) => domain,
        Given::Surface(_) => {
            let help = "give a planar domain: Dimension 2, or a shape such as rect:0,0,1,1";
            return refuse([(true, "a loop on a surface", help)]);
        }
    };
    let bar = Bar::new(&args.run);
    let mut told = Told::new(args, start);
    let mut each = |step: &Step| {
        validity(&step.meshed.mesh).demand().map_err(ours)?;
        told.add(step);
        if args.every {
            write(&numbered(args, step.number), step)?;
        }
        if step.number == args.iterations as usize {
            write(&args.out, step)?;
        }
        Ok(())
    };
    let options = args.options();
    if let Some(command) = &args.solver {
        let shell = Shell::new(command)?;
        let mut solve = |number: usize, mesh: &_, start: Option<&Solutions>| shell.solve(number, mesh, start);
        recipe::adapt(&domain, Source::Solver(&mut solve), &options, &bar, &mut each)?;
    } else {
        let source = Source::Formula(function(args)?, args.time.0);
        recipe::adapt(&domain, source, &options, &bar, &mut each)?;
    }
    drop(bar);
    args.run.write_report(&format!("{:#}\n", told.report()))
}

/// The function that is followed.
fn function(args: &LoopArgs) -> Result<Expression> {
    let text = args.metric.as_deref().unwrap_or_default().trim();
    match text.strip_prefix("hessian:") {
        Some(function) if !function.trim().to_ascii_lowercase().ends_with(".sol") => {
            Expression::parse(function, Variables::Motion)
        }
        _ => {
            let help =
                "write hessian:EXPR, a function of x, y and t, or give a --solver; for one mesh use voronaut mesh";
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
