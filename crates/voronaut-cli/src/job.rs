//! A command with options by their names, for callers that are no terminal.

use super::{Arguments, Command};
use crate::flags::as_keywords;
use crate::world::{Held, Made, World};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, FromArgMatches};
use std::error::Error as _;
use voronaut::Result;
use voronaut::progress::Progress;

/// A command, ready to be performed.
pub struct Job(Command);

/// What is wrong with the options of a command.
#[derive(Debug)]
pub struct Usage {
    /// Whether there is no option of that name.
    pub is_unknown: bool,
    /// What is wrong, with the option's name.
    pub what: String,
}

/// All commands with their options: names, defaults, help.
pub fn commands() -> clap::Command {
    Arguments::command()
}

impl Job {
    /// A command by its name, and options by theirs, with underscores, each with its values: none of one that is a flag.
    ///
    /// # Errors
    /// There is no such option, it has another value than it may have, or options contradict each other.
    pub fn new(name: &str, options: &[(String, Vec<String>)]) -> std::result::Result<Self, Usage> {
        let mut all = commands();
        let Some(command) = all.find_subcommand(name) else { return Err(unknown(name)) };
        let (mut words, mut positional) = (vec!["voronaut".into(), name.to_owned(), "--quiet".into()], Vec::new());
        for (option, values) in options {
            let found = command.get_arguments().enumerate().find(|(_, argument)| argument.get_id() == option);
            let Some((place, argument)) = found else { return Err(unknown(option)) };
            if argument.is_positional() {
                positional.push((place, values));
                continue;
            }
            let flag = match (argument.get_long(), argument.get_short()) {
                (Some(long), _) => format!("--{long}"),
                (None, short) => format!("-{}", short.unwrap_or_default()),
            };
            words.extend(values.is_empty().then(|| flag.clone()));
            words.extend(values.iter().map(|value| format!("{flag}={value}")));
        }
        positional.sort_unstable();
        words.push("--".into());
        words.extend(positional.into_iter().flat_map(|(_, values)| values).cloned());
        let matches = all.try_get_matches_from_mut(words).map_err(|error| usage(&error))?;
        Arguments::from_arg_matches(&matches).map(|arguments| Self(arguments.command)).map_err(|error| usage(&error))
    }

    /// Seconds after which the caller should tell it to stop.
    pub fn time_limit(&self) -> Option<f64> {
        self.0.run().limits.time_limit
    }

    /// Threads to use; `None` for as many as there are cores.
    pub fn threads(&self) -> Option<usize> {
        self.0.run().threads.map(usize::from)
    }

    /// Performs the command on what the caller holds.
    ///
    /// # Errors
    /// As of the command; [`Stopped`](voronaut::Error::Stopped) where progress says so.
    pub fn perform(&self, held: Held, progress: &dyn Progress) -> Result<Made> {
        let world = World::of_caller(held, progress);
        self.0.perform(&world)?;
        Ok(world.into_made())
    }
}

fn unknown(option: &str) -> Usage {
    Usage { is_unknown: true, what: format!("there is no option '{option}'") }
}

/// What the parser has to say, by the names of keywords.
fn usage(error: &clap::Error) -> Usage {
    let text = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.clone()),
        Some(ContextValue::Strings(texts)) => Some(texts.join(", ")),
        _ => None,
    };
    let option = text(ContextKind::InvalidArg).map(|named| {
        let name = named.split(' ').next().unwrap_or_default();
        as_keywords(name).trim_matches(['<', '>', '[', ']']).to_lowercase()
    });
    let what = match (error.kind(), option, text(ContextKind::InvalidValue)) {
        (ErrorKind::ArgumentConflict, Some(option), _) => {
            let prior = as_keywords(&text(ContextKind::PriorArg).unwrap_or_default());
            format!("{option} cannot be used with {}", prior.split(' ').next().unwrap_or_default())
        }
        (ErrorKind::MissingRequiredArgument, Some(option), _) => format!("{option} is missing"),
        (ErrorKind::TooManyValues, Some(option), Some(value)) => format!("{option} is true or false, not '{value}'"),
        (_, Some(option), Some(value)) => {
            let valid = text(ContextKind::ValidValue).filter(|valid| !valid.is_empty());
            let expected =
                valid.map(|valid| format!("one of {valid}")).or_else(|| error.source().map(ToString::to_string));
            format!("{option}='{value}': {}", expected.unwrap_or_else(|| "not what is expected".into()))
        }
        _ => as_keywords(error.render().to_string().lines().next().unwrap_or_default().trim_start_matches("error: ")),
    };
    Usage { is_unknown: false, what }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(options: &[(&str, &str)]) -> Usage {
        let needed = ["domain", "metric", "out"].map(|name| (name, name));
        let all: Vec<_> =
            needed.iter().chain(options).map(|&(name, value)| (name.into(), vec![value.into()])).collect();
        Job::new("mesh", &all).err().expect("a fault")
    }

    #[test]
    fn faults_are_named_by_keywords() {
        assert!(fault(&[("colour", "red")]).is_unknown);
        for (options, expected) in [
            (vec![("h_min", "nan")], "h_min='nan': not a positive number"),
            (vec![("canvas", "grid")], "canvas='grid': "),
            (vec![("vertices", "2")], "vertices='2': 2 is not in 3.."),
            (vec![("vertices", "20"), ("complexity", "3")], "vertices cannot be used with complexity"),
            (vec![("net", "3")], "net is true or false, not '3'"),
        ] {
            let fault = fault(&options);
            assert!(fault.what.starts_with(expected) && !fault.is_unknown, "{}", fault.what);
        }
    }

    #[test]
    fn what_a_caller_holds_is_meshed() {
        let text = r#"{"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]]}"#;
        let held = Held { polygons: [("domain".into(), text.into())].into(), ..Held::default() };
        let options = [("domain", "domain"), ("metric", "uniform"), ("vertices", "50"), ("out", "mesh")];
        let options = options.map(|(name, value)| (name.to_owned(), vec![value.to_owned()]));
        let job = Job::new("mesh", &options).map_err(|usage| usage.what).unwrap();
        let made = job.perform(held, &voronaut::progress::Silent).unwrap();
        assert_eq!(made.mesh.unwrap().points.len(), 50);
        assert!(made.report.unwrap().contains("\"valid\": true"));
    }
}
