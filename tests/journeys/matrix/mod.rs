//! Every command on the result of every kind of refinement. A command or a kind of model enters by
//! a line in its table: `commands::MODEL` and `kinds::KINDS` on files, `served::STEPS` on a server.

mod commands;
mod kinds;
mod place;
mod served;

use std::collections::BTreeSet;

use rayon::prelude::*;
use sistership_tests::binary;

use commands::{ELSEWHERE, MODEL};
use kinds::{KINDS, Kind};
use place::Place;

/// What fails of one kind: the command, and what it said.
fn failures(place: &Place, kind: &Kind) -> Vec<String> {
    let model = match kind.made(place) {
        Ok(model) => model,
        Err(said) => return vec![format!("{}: it is not made: {said}", kind.name)],
    };
    let mut failed = Vec::new();
    for command in MODEL {
        for arguments in (command.calls)(place, &model, kind) {
            let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
            let output = binary::run(&arguments);
            let said = String::from_utf8_lossy(&output.stderr);
            if !output.status.success() {
                failed.push(format!("{}: {}: {said}", kind.name, arguments.join(" ")));
            }
        }
    }
    failed
}

#[test]
fn every_command_takes_every_kind_of_model() {
    let place = Place::new();
    let failed: Vec<String> =
        KINDS.par_iter().flat_map_iter(|kind| failures(&place, kind)).collect();
    assert!(failed.is_empty(), "{} calls fail:\n{}", failed.len(), failed.join("\n"));
}

/// The names in the section of commands of the program's help.
fn subcommands() -> BTreeSet<String> {
    let help = binary::run(&["--help"]);
    let text = String::from_utf8_lossy(&help.stdout).into_owned();
    let section = text.split("Commands:").nth(1).and_then(|rest| rest.split("\n\n").next());
    let lines = section.unwrap_or_default().lines();
    let named = lines.filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let first = |line: &str| line.split_whitespace().next().map(str::to_owned);
    named.filter_map(first).filter(|name| name != "help").collect()
}

#[test]
fn the_tables_name_every_command_of_the_program() {
    let listed: BTreeSet<String> = MODEL
        .iter()
        .map(|command| command.name)
        .chain(ELSEWHERE.iter().map(|(name, _)| *name))
        .map(str::to_owned)
        .collect();
    let there = subcommands();
    assert!(there.len() > 20, "{there:?}");
    assert_eq!(listed, there, "a command is listed in `commands`, with a model or without");
}
