//! `voronaut completions`: scripts for shells.

use crate::common::{Place, stderr};
use std::process::{Command, Stdio};

const COMMANDS: [&str; 10] =
    ["mesh", "dual", "distance", "check", "metric", "remesh", "interpolate", "loop", "convert", "view"];

fn script(place: &Place, shell: &str) -> String {
    let output = place.run(&["completions", shell]);
    assert!(output.status.success(), "{}", stderr(&output));
    String::from_utf8(output.stdout).expect("UTF-8")
}

#[test]
fn every_shell_knows_the_commands_and_their_options() {
    let place = Place::new();
    for shell in ["bash", "zsh", "fish"] {
        let script = script(&place, shell);
        for name in COMMANDS.iter().chain(&["metric-scale", "h-min", "picture"]) {
            assert!(script.contains(name), "{shell}: {name}");
        }
    }
    assert_eq!(place.run(&["completions", "csh"]).status.code(), Some(2));
}

/// Where there is a bash: what it is given, and what it then offers behind `voronaut`, `voronaut mesh --h-` and `voronaut completions z`.
#[test]
fn bash_completes() {
    let place = Place::new();
    let has_bash = Command::new("bash").arg("--version").stdout(Stdio::null()).status().is_ok();
    if !has_bash {
        return;
    }
    place.put("voronaut.bash", script(&place, "bash"));
    let bash = |words: &[&str]| Command::new("bash").args(words).current_dir(place.path()).output().expect("it runs");
    let checked = bash(&["-n", "voronaut.bash"]);
    assert!(checked.status.success() && checked.stderr.is_empty(), "{}", stderr(&checked));
    let offered = |words: &str| {
        let asked = format!(
            "source ./voronaut.bash; COMP_WORDS=({words}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); \
             _voronaut voronaut \"${{COMP_WORDS[COMP_CWORD]}}\" \"${{COMP_WORDS[COMP_CWORD-1]}}\"; echo \"${{COMPREPLY[@]}}\""
        );
        let output = bash(&["--norc", "-c", &asked]);
        assert!(output.status.success(), "{}", stderr(&output));
        String::from_utf8(output.stdout).expect("UTF-8").split_whitespace().map(str::to_owned).collect::<Vec<_>>()
    };
    let all = offered("voronaut ''");
    assert!(COMMANDS.iter().all(|name| all.iter().any(|word| word == name)), "{all:?}");
    assert_eq!(offered("voronaut mesh --h-"), ["--h-min", "--h-max"]);
    assert_eq!(offered("voronaut completions z"), ["zsh"]);
}
