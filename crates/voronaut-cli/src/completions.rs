//! `voronaut completions`: what a shell needs to complete commands and options.

use crate::summary;
use clap::Args;
use clap_complete::{Shell, generate};
use voronaut::{Error, Result};

pub(crate) const EXAMPLES: &str = "\
zsh reads what stands in its fpath: in ~/.zshrc `fpath+=~/.zfunc`, before `compinit`.

Examples:
  voronaut completions bash > ~/.local/share/bash-completion/completions/voronaut
  voronaut completions zsh > ~/.zfunc/_voronaut
  voronaut completions fish > ~/.config/fish/completions/voronaut.fish";

#[derive(Debug, Args)]
pub(crate) struct CompletionsArgs {
    /// The shell to write for
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

/// Writes the script for a shell to stdout, for these commands.
pub(crate) fn run(args: &CompletionsArgs, mut commands: clap::Command) -> Result<()> {
    let mut script = Vec::new();
    generate(args.shell, &mut commands, "voronaut", &mut script);
    let text = String::from_utf8(script).map_err(|error| Error::unsupported(error.to_string(), ""))?;
    summary::out(&text);
    Ok(())
}
