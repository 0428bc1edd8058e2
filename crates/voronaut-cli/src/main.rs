//! The program `voronaut`.

use std::process::ExitCode;

fn main() -> ExitCode {
    voronaut_cli::run(std::env::args_os()).into()
}
