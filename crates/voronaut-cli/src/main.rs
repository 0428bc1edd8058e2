//! The command line of voronaut. Exit code 0: done; 1: the input or the result is not what was asked; 2: wrong usage.

mod args;
mod certify;
mod check;
mod distance;
mod dual;
mod files;
mod mesh;
mod metric;
mod progress;
mod seeds;
mod summary;
mod surfaces;

use args::{Arguments, Command};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let done = match Arguments::parse().command {
        Command::Mesh(args) => mesh::run(&args),
        Command::Dual(args) => dual::run(&args),
        Command::Distance(args) => distance::run(&args),
        Command::Check(args) => check::run(&args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            if !error.help().is_empty() {
                eprintln!("  help: {}", error.help());
            }
            ExitCode::FAILURE
        }
    }
}
