//! The command line of voronaut. Exit code 0: done; 1: the input or the result is not what was asked, for which `remesh` has 2, as mmg
//! has; 2: wrong usage.

mod adapt;
mod args;
mod certify;
mod check;
mod convert;
mod distance;
mod dual;
mod files;
mod interpolate;
mod mesh;
mod metric;
mod nodal;
mod progress;
mod remesh;
mod seeds;
mod summary;
mod surfaces;

use args::{Arguments, Command};
use clap::Parser;
use std::process::ExitCode;
use voronaut::Result;

fn main() -> ExitCode {
    let is_remesh = std::env::args_os().nth(1).is_some_and(|word| word == "remesh");
    let done = remesh::translated(std::env::args_os()).and_then(|words| run(Arguments::parse_from(words)));
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            if !error.help().is_empty() {
                eprintln!("  help: {}", error.help());
            }
            if is_remesh { ExitCode::from(remesh::FAILURE) } else { ExitCode::FAILURE }
        }
    }
}

fn run(arguments: Arguments) -> Result<()> {
    match arguments.command {
        Command::Mesh(args) => mesh::run(&args),
        Command::Dual(args) => dual::run(&args),
        Command::Distance(args) => distance::run(&args),
        Command::Interpolate(args) => interpolate::run(&args),
        Command::Remesh(args) => remesh::run(&args),
        Command::Metric(args) => nodal::run(&args),
        Command::Loop(args) => adapt::run(&args),
        Command::Convert(args) => convert::run(&args),
        Command::Check(args) => check::run(&args),
    }
}
