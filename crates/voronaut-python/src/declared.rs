//! What the commands' options are, for who writes the package's functions from it.

use serde_json::{Value, json};

/// By the names of commands, the options in their order.
pub(crate) fn commands() -> Value {
    let all = voronaut_cli::commands();
    let command = |command: &clap::Command| {
        let options: Vec<Value> = command.get_arguments().map(option).collect();
        let about = command.get_about().map(ToString::to_string);
        (command.get_name().to_owned(), json!({ "about": about, "options": options }))
    };
    all.get_subcommands().map(command).collect()
}

fn option(argument: &clap::Arg) -> Value {
    let defaults: Vec<String> =
        argument.get_default_values().iter().map(|it| it.to_string_lossy().into_owned()).collect();
    let choices: Vec<String> = argument.get_possible_values().iter().map(|it| it.get_name().to_owned()).collect();
    json!({
        "name": argument.get_id().as_str(),
        "is_flag": !argument.get_action().takes_values(),
        "is_positional": argument.is_positional(),
        "default": defaults.first(),
        "choices": choices,
        "value": argument.get_value_names().and_then(|names| names.first()).map(ToString::to_string),
        "help": argument.get_long_help().or(argument.get_help()).map(ToString::to_string),
    })
}
