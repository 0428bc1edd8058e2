//! The commands of voronaut: for a terminal ([`run`]), and for callers that hold arrays ([`Job`]).

// They panic where what they write to is closed.
#![deny(clippy::print_stderr, clippy::print_stdout)]

mod account;
mod aside;
mod check;
mod completions;
mod convert;
mod curves;
mod distance;
mod dual;
mod fields;
mod files;
mod flags;
mod interpolate;
mod job;
mod r#loop;
mod mesh;
mod metric;
mod options;
mod pages;
mod parts;
mod pictures;
#[cfg_attr(target_family = "wasm", path = "no_progress.rs")]
mod progress;
mod remesh;
mod seeds;
mod stages;
mod summary;
mod view;
mod watch;
mod world;

pub use flags::{as_keywords, flagged};
pub use job::{Job, Usage, commands};
pub use world::{Held, HeldMetric, Made, PartsMaker, World};

use aside::say_aside;
use clap::{Parser, Subcommand};
use options::Run;
use std::borrow::Cow;
use std::ffi::OsString;
use voronaut::Result;

/// Runs the program with these words, and returns its exit code: 0: done; 1: the input or the result is not what was
/// asked, for which `remesh` has 2, as mmg has; 2: wrong usage. Limits and signals end the process. `program` are the words that start it
/// again, for parts of a mesh.
pub fn run(program: Vec<OsString>, words: impl IntoIterator<Item = OsString>) -> u8 {
    let words: Vec<OsString> = std::iter::once("voronaut".into()).chain(words).collect();
    watch::fail_as(words.get(1).is_some_and(|word| word == "remesh"));
    let again = [program, words[1..].to_vec()].concat();
    let done = remesh::translated(words).and_then(|words| obey(&Arguments::parse_from(words).command, again));
    let Err(error) = done else { return 0 };
    say_aside(&format!("error: {}", flags::flagged(&error.to_string())));
    if !error.help().is_empty() {
        say_aside(&format!("  help: {}", flags::flagged(error.help())));
    }
    watch::failure()
}

fn obey(command: &Command, again: Vec<OsString>) -> Result<()> {
    let run = command.run();
    watch::begin(run.limits)?;
    run.set_threads()?;
    command.perform(&World::of_files(again))
}

/// Anisotropic triangle meshes from a Riemannian metric field.
#[derive(Debug, Parser)]
#[command(name = "voronaut", version, propagate_version = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Mesh a domain: valid, with edges of length one in a metric
    #[command(after_help = mesh::EXAMPLES)]
    Mesh(mesh::MeshArgs),
    /// Voronoi diagram and dual of the seeds given: none is added or moved
    #[command(after_help = dual::EXAMPLES)]
    Dual(dual::DualArgs),
    /// Distances in a metric from given points to everywhere, and the shortest path to one
    #[command(after_help = distance::EXAMPLES)]
    Distance(distance::DistanceArgs),
    /// Mesh a surface or a planar mesh anew, with the options and files of mmgs and mmg2d
    #[command(after_help = remesh::EXAMPLES)]
    Remesh(remesh::RemeshArgs),
    /// Carry a solution from one mesh of a domain or a surface to another
    #[command(after_help = interpolate::EXAMPLES)]
    Interpolate(interpolate::InterpolateArgs),
    /// Make a metric at the vertices of a mesh: from solutions, combined, limited, graded, of a complexity
    #[command(after_help = metric::EXAMPLES)]
    Metric(metric::MetricArgs),
    /// Adapt the mesh of a domain or a surface to a formula or a solver, again and again
    #[command(after_help = r#loop::EXAMPLES)]
    Loop(Box<r#loop::LoopArgs>),
    /// Read a file in one format and write it in another
    #[command(after_help = convert::EXAMPLES, visible_alias = "translate")]
    Convert(convert::ConvertArgs),
    /// Examine a mesh: validity, quality in a metric, distance to its domain
    #[command(after_help = check::EXAMPLES)]
    Check(check::CheckArgs),
    /// Write a page to look at meshes with, in any browser
    #[command(after_help = view::EXAMPLES)]
    View(view::ViewArgs),
    /// Write a script by which a shell completes commands and options
    #[command(after_help = completions::EXAMPLES)]
    Completions(completions::CompletionsArgs),
}

impl Command {
    /// Reads, works and writes.
    fn perform(&self, world: &World) -> Result<()> {
        match self {
            Command::Mesh(args) => mesh::run(args, world),
            Command::Dual(args) => dual::run(args, world),
            Command::Distance(args) => distance::run(args, world),
            Command::Interpolate(args) => interpolate::run(args, world),
            Command::Remesh(args) => remesh::run(args, world),
            Command::Metric(args) => metric::run(args),
            Command::Loop(args) => r#loop::run(args),
            Command::Convert(args) => convert::run(args),
            Command::Check(args) => check::run(args, world),
            Command::View(args) => view::run(args, world),
            Command::Completions(args) => completions::run(args, commands()),
        }
    }

    /// Threads, limits, and how much is said.
    fn run(&self) -> Cow<'_, Run> {
        Cow::Borrowed(match self {
            Command::Mesh(args) => return args.run(),
            Command::Dual(args) => &args.run,
            Command::Distance(args) => &args.run,
            Command::Interpolate(args) => &args.run,
            Command::Metric(args) => &args.run,
            Command::Loop(args) => &args.run,
            Command::Check(args) => &args.run,
            Command::View(args) => &args.run,
            Command::Remesh(args) => return Cow::Owned(args.run()),
            Command::Convert(args) => return Cow::Owned(args.run()),
            Command::Completions(_) => return Cow::Owned(Run::default()),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;
    use voronaut::recipe::MeshOptions;

    #[test]
    fn what_libraries_speak_of_are_flags() {
        let program = Arguments::command();
        let flags: Vec<_> = program.get_subcommands().flat_map(clap::Command::get_arguments).collect();
        for name in flags::PARAMETERS {
            let is_it = |argument: &&clap::Arg| argument.get_long() == Some(&name.replace('_', "-"));
            assert!(flags.iter().any(is_it), "{name}");
        }
    }

    #[test]
    fn definitions_are_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn defaults_are_the_library_s() {
        let words = ["voronaut", "mesh", "rect:0,0,1,1", "--metric", "uniform", "-o", "a.mesh"];
        let Command::Mesh(args) = Arguments::try_parse_from(words).unwrap().command else { unreachable!() };
        let (ours, theirs) = (args.options(), MeshOptions::default());
        assert_eq!(format!("{ours:?}"), format!("{theirs:?}"));
    }

    #[test]
    fn nonsense_is_wrong_usage() {
        let base = ["voronaut", "mesh", "rect:0,0,1,1", "--metric", "uniform", "-o", "a.mesh"];
        for more in [
            &["-n", "2"][..],
            &["-n", "100", "--complexity", "3"],
            &["--h-min", "nan"],
            &["--hausd", "-1"],
            &["--threads", "0"],
            &["--seeding", "nearest"],
            &["--protection", "-0.1"],
            &["--picking-radius", "nan"],
            &["--canvas", "grid"],
            &["--mesher", "grid"],
            &["--canvas-size", "0"],
            &["--smooth-metric", "-1"],
            &["--smooth-metric", "10001"],
            &["--smooth-metric", "1.5"],
            &["--show", "mesh"],
            &["--pixels", "800"],
            &["--window", "0,0,1,1"],
            &["--window", "0,0,1", "--picture", "a.svg"],
            &["--window", "0,0,1,nan", "--picture", "a.svg"],
            &["--window", "0,1,1,1", "--picture", "a.svg"],
            &["--pixels", "8", "--picture", "a.svg"],
            &["--show", "stars", "--picture", "a.svg"],
            &["-q", "-v"],
        ] {
            let error = Arguments::try_parse_from(base.iter().chain(more)).unwrap_err();
            assert_eq!(error.exit_code(), 2, "{more:?}");
        }
    }
}
