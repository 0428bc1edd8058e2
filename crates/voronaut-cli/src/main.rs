//! The program `voronaut`.

use std::process::ExitCode;

fn main() -> ExitCode {
    let mut words = std::env::args_os();
    let name = words.next();
    let program = std::env::current_exe().map(Into::into).ok().or(name).into_iter().collect();
    voronaut_cli::run(program, words).into()
}
