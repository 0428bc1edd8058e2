//! A user's solver, run by the shell on files of its own directory.

use crate::files::{self, Miscounted};
use std::path::{Path, PathBuf};
use std::process::Command;
use voronaut::mesh::{Mesh, Solutions};
use voronaut::{Error, Result};
use voronaut_io::sol;

/// A command and the directory of the files that it reads and writes, which goes when the loop ends.
pub(super) struct Shell {
    command: String,
    directory: PathBuf,
}

impl Shell {
    /// # Errors
    /// [`Error::Parse`] of a command that names no file to write; [`Error::Io`] where no directory can be made.
    pub(super) fn new(command: &str) -> Result<Self> {
        for needed in ["{mesh}", "{out}"] {
            if !command.contains(needed) {
                let help = "write it where the solver takes the file's name, as in './solve {mesh} {out}'";
                return Err(Error::parse("solver", format!("{needed} is missing in `{command}`"), help));
            }
        }
        let place = std::path::absolute(std::env::temp_dir()).unwrap_or_else(|_| std::env::temp_dir());
        let directory = place.join(format!("voronaut-loop-{}", std::process::id()));
        std::fs::create_dir(&directory).map_err(|error| {
            let what = format!("cannot be made: {error}");
            Error::parse(directory.display().to_string(), what, "set TMPDIR to a directory to write to")
        })?;
        Ok(Self { command: command.into(), directory })
    }

    /// One run.
    ///
    /// # Errors
    /// [`Error::Parse`] where the command fails or writes no file, or one that is none; [`Error::Io`] of files.
    pub(super) fn solve(&self, step: usize, mesh: &Mesh, start: Option<&Solutions>) -> Result<Solutions> {
        let file = |name: &str| self.directory.join(name);
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
        let text = names.iter().fold(self.command.clone(), |text, (name, value)| text.replace(name, value));
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

impl Drop for Shell {
    fn drop(&mut self) {
        // Files left behind in a temporary directory are no failure.
        let _ = std::fs::remove_dir_all(&self.directory);
    }
}

fn run(step: usize, text: &str) -> Result<()> {
    let (shell, flag) = if cfg!(windows) { ("cmd", "/C") } else { ("sh", "-c") };
    let status = Command::new(shell).arg(flag).arg(text).status();
    let what = match status {
        Ok(status) if status.success() => return Ok(()),
        Ok(status) => format!("step {step}: `{text}` ended with {status}"),
        Err(error) => format!("step {step}: `{text}` cannot be run: {error}"),
    };
    Err(Error::parse("solver", what, "run the command by hand on a mesh of its own; its messages are above"))
}
