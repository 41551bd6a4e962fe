//! Command line of Sistership: the functions of the server, on files.
//!
//! Exit status: 0 success, 1 the data or the model was refused (with the reason), 2 the call is
//! wrong. With `--json` one JSON document goes to standard output and nothing else; progress,
//! warnings and errors go to standard error.

mod allocator;
mod arguments;
mod commands;
mod demo;
mod failure;
mod files;
mod output;
mod resolve;
mod suggestions;
mod table;
mod track;
mod track_files;
mod trials;
mod values;
mod weights;
mod zoo;

pub use sistership_jobs::example::sea_trials;

use std::process::ExitCode;

use clap::{CommandFactory, Parser};

use crate::arguments::{Arguments, Command};
use crate::failure::Failure;

/// Runs the command of the process' arguments.
pub fn run() -> ExitCode {
    // First of all, before any thread is started.
    allocator::configure_allocator();
    let arguments = Arguments::parse();
    match dispatch(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            if let Some(message) = failure.message() {
                output::print_note(&format!("error: {}", output::shorten_lines(message)));
            }
            ExitCode::from(failure.exit_status())
        }
    }
}

fn dispatch(arguments: &Arguments) -> Result<(), Failure> {
    let zoo = || zoo::load_zoo(&arguments.zoo);
    match &arguments.command {
        Command::Similar(similar) => commands::similar::run(&zoo()?, similar),
        Command::Init(init) => commands::init::run(init),
        Command::Check(check) => commands::check::run(check),
        Command::Import(import) => commands::import::run(&zoo()?, import),
        Command::Refine(refine) => commands::refine::run(&zoo()?, refine),
        Command::Simulate(simulate) => commands::simulate::run(&zoo()?, simulate),
        Command::Diagnose(diagnose) => commands::diagnose::run(&zoo()?, diagnose),
        Command::Manoeuvre(manoeuvre) => commands::manoeuvre::run(&zoo()?, manoeuvre),
        Command::Predict(asked) => commands::predict::run(&zoo()?, asked),
        Command::Plan(asked) => commands::plan::run(&zoo()?, asked),
        Command::Compare(compare) => commands::compare::run(&zoo()?, compare),
        Command::Derive(derive) => commands::derive::run(&zoo()?, derive),
        Command::Export(export) => commands::export::run(&zoo()?, export),
        Command::Estimate(asked) => commands::estimate::run(&zoo()?, asked),
        Command::Zoo(asked) => commands::zoo::run(&zoo()?, asked),
        Command::Demo(demo) => demo::run(demo, &zoo()?),
        Command::Serve(serve) => commands::serve::run(serve, &arguments.zoo),
        Command::Work(work) => commands::work::run(work),
        Command::Health(health) => commands::health::run(health),
        Command::Ships(ships) => commands::ships::run(ships),
        Command::Branch(branch) => commands::branch::run(&zoo()?, branch),
        Command::Validate(validate) => commands::validate::run(&zoo()?, validate),
        Command::Verify(verify) => commands::verify::run(verify),
        Command::Family(family) => commands::family::run(family),
        Command::Users(users) => commands::users::run(users),
        Command::Keys(keys) => commands::keys::run(keys),
        Command::Fsck(fsck) => commands::fsck::run(fsck),
        Command::Gc(gc) => commands::gc::run(gc),
        Command::Backup(backup) => commands::backup::run_backup(backup),
        Command::Restore(restore) => commands::backup::run_restore(restore),
        Command::Completions(completions) => {
            commands::completions::run(completions, Arguments::command())
        }
        Command::Manual(manual) => commands::manual::run(manual, Arguments::command()),
    }
}
