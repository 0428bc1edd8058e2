//! A user's solver, run by the shell on files of its own directory.

use crate::files::{self, Miscounted};
use crate::watch;
use std::path::Path;
use std::process::Command;
use voronaut::mesh::{Mesh, Solutions};
use voronaut::{Error, Result};
use voronaut_io::{Scratch, sol};

/// A command and the directory of the files that it reads and writes, which goes when the loop ends.
pub(super) struct Shell {
    command: String,
    directory: Scratch,
}

impl Shell {
    /// # Errors
    /// [`Error::Parse`] of a command that names no file to write; [`Error::Io`] where there is no place for temporary files.
    pub(super) fn new(command: &str) -> Result<Self> {
        for needed in ["{mesh}", "{out}"] {
            if !command.contains(needed) {
                let help = "write it where the solver takes the file's name, as in './solve {mesh} {out}'";
                return Err(Error::parse("solver", format!("{needed} is missing in `{command}`"), help));
            }
        }
        Ok(Self { command: command.into(), directory: Scratch::new()? })
    }

    /// One run.
    ///
    /// # Errors
    /// [`Error::Parse`] where the command fails or writes no file, or one that is none; [`Error::Io`] of files.
    pub(super) fn solve(&self, step: usize, mesh: &Mesh, start: Option<&Solutions>) -> Result<Solutions> {
        let scratch = self.directory.as_ref();
        let directory = std::path::absolute(scratch).map_err(|source| Error::io(scratch, source))?;
        let file = |name: &str| directory.join(name);
        let (mesh_file, start_file, out_file) = (file("mesh.mesh"), file("start.sol"), file("out.sol"));
        voronaut_io::write_mesh(mesh, &mesh_file)?;
        if let Some(start) = start {
            voronaut_io::write_solutions(start, &start_file)?;
        }
        let _ = std::fs::remove_file(&out_file);
        let start = start.map_or(Path::new("-"), |_| start_file.as_path());
        let names = [
            ("{mesh}", mesh_file.display().to_string()),
            ("{start}", start.display().to_string()),
            ("{out}", out_file.display().to_string()),
            ("{step}", step.to_string()),
        ];
        let text = put(&self.command, &names);
        run(step, &text)?;
        if !out_file.exists() {
            let help = "it has to write its solution to the file that {out} stands for";
            return Err(Error::parse("solver", format!("step {step}: `{text}` wrote no solution"), help));
        }
        let found = sol::read_all(voronaut_io::open(&out_file)?, &format!("the solver's {{out}} of step {step}"))?;
        if let Some(Miscounted { section, found, needed, places }) = files::miscounted(&found, mesh) {
            let what = format!("step {step}: {section} has {found} entries, and the mesh {needed} {places}");
            return Err(Error::parse("solver", what, "write one entry for each, in the order of the mesh file"));
        }
        Ok(found)
    }
}

/// One word for the shell.
fn quoted(value: &str) -> String {
    if cfg!(windows) { format!("\"{value}\"") } else { format!("'{}'", value.replace('\'', "'\\''")) }
}

/// A command with values in place of their names, each as one word for the shell, in quotes or not.
fn put(command: &str, names: &[(&str, String)]) -> String {
    let is_plain = |value: &str| value.chars().all(|c| c.is_alphanumeric() || "/._-:\\~+@%".contains(c));
    let (mut text, mut quote, mut rest) = (String::new(), None, command);
    while let Some(c) = rest.chars().next() {
        if let Some((name, value)) = names.iter().find(|(name, _)| rest.starts_with(name)) {
            text.push_str(&if quote.is_none() && !is_plain(value) { quoted(value) } else { value.clone() });
            rest = &rest[name.len()..];
            continue;
        }
        quote = match quote {
            None if c == '\'' || c == '"' => Some(c),
            Some(open) if open == c => None,
            other => other,
        };
        text.push(c);
        rest = &rest[c.len_utf8()..];
    }
    text
}

fn run(step: usize, text: &str) -> Result<()> {
    let (shell, flag) = if cfg!(windows) { ("cmd", "/C") } else { ("sh", "-c") };
    let status = watch::run(Command::new(shell).arg(flag).arg(text));
    let what = match status {
        Ok(status) if status.success() => return Ok(()),
        Ok(status) => format!("step {step}: `{text}` ended with {status}"),
        Err(error) => format!("step {step}: `{text}` cannot be run: {error}"),
    };
    Err(Error::parse("solver", what, "run the command by hand on a mesh of its own; its messages are above"))
}
