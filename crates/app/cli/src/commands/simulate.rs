//! `sistership simulate`: simulation of recorded trials with their rudder and revolutions.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use sistership_model::trial::Channel;
use sistership_model::{Law, Model, Zoo};
use sistership_simulation::error::standard_deviations;
use sistership_simulation::recorded::{ReplaySettings, TrialReplay};

use crate::commands::trial_simulation::{SimulatedTrial, TrialSimulator, total_errors};
use crate::failure::{Failure, combine_results};
use crate::output::{self, format_count, print_note};
use crate::table::{TextTable, format_number};
use crate::trials::{self, ReadTrial};
use crate::values::{IntegrationMethod, positive};
use crate::weights::CorrectionSummary;
use crate::{commands::model_line, resolve, track, track_files};

const EXAMPLES: &str = "\
Examples:
  sistership simulate --model mariner --trials turn.csv zigzag.csv
  sistership simulate --model my-model.yaml --trials trials.yaml --restart-s 100 --json
  sistership simulate --model sr108 --trials trials.yaml --out simulated

Errors are root mean squares; `std. MSE` adds up the squares of those of u, v, r, psi, x and y,
each divided by the standard deviation of the channel over the trials given. Exit status 1 when a
simulation leaves the physical range.";

/// Simulate recorded trials with a model and measure its errors.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct SimulateArguments {
    /// The model: a name in the zoo, a model file, or a vessel file with a model.
    #[arg(long)]
    model: String,
    /// Trial manifests, CSV or Parquet files.
    #[arg(long, value_name = "TRIALS", num_args = 1.., required = true)]
    trials: Vec<PathBuf>,
    /// Interval at which the simulation restarts from the recorded state; by default it never
    /// restarts.
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_negative_numbers = true)]
    restart_s: Option<f64>,
    /// Integration method.
    #[arg(long, value_enum, default_value_t)]
    method: IntegrationMethod,
    /// Longest integration step; sampling intervals are divided into equal steps no longer than
    /// this.
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_negative_numbers = true, default_value_t = 0.5)]
    step_s: f64,
    /// Write one CSV per trial of the simulated states at the recorded times into this folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct SimulateDocument<'a> {
    model: &'a str,
    law: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    branch: Option<CorrectionSummary<'a>>,
    trials: &'a [SimulatedTrial],
    all: Option<SimulatedTrial>,
}

/// Runs the command.
///
/// # Errors
/// Returns an error if the model or a trial is refused, if a channel is missing, or if a simulation
/// leaves the physical range.
pub fn run(zoo: &Zoo, simulate: &SimulateArguments) -> Result<(), Failure> {
    let asked = combine_results(
        resolve::resolve_model(zoo, &simulate.model),
        trials::read_trials(&simulate.trials),
    );
    let ((model, law), read) = asked?;
    trials::remark_other_ship(&read, &model.ship);
    // Output files are checked before the simulations.
    let files = track_files(simulate, &read)?;
    let runs = simulate_all(simulate, &model, &law, &read)?;
    let simulated = write_tracks(runs, files, &law, &read)?;
    let document = SimulateDocument {
        model: &model.name,
        law: &model.law,
        branch: model.branch.as_ref().map(CorrectionSummary::from_branch),
        trials: &simulated,
        all: total_errors(&simulated),
    };
    output::print_result(simulate.json, &document, || {
        format_simulation(simulate, &model, &law, &document)
    })?;
    if simulated.iter().any(|trial| trial.diverged) { Err(Failure::Told) } else { Ok(()) }
}

fn track_files(
    simulate: &SimulateArguments,
    read: &[ReadTrial],
) -> Result<Vec<track_files::TrackFile>, Failure> {
    let Some(out) = &simulate.out else { return Ok(Vec::new()) };
    let names: Vec<&str> = read.iter().map(|read| read.trial.name.as_str()).collect();
    track_files::prepare_files(out, &names, &trials::input_paths(read, &simulate.trials))
}

fn simulate_all(
    simulate: &SimulateArguments,
    model: &Model,
    law: &Law,
    read: &[ReadTrial],
) -> Result<Vec<(SimulatedTrial, TrialReplay)>, Failure> {
    let settings = ReplaySettings {
        restart_s: simulate.restart_s,
        method: simulate.method.into(),
        step_s: simulate.step_s,
    };
    // One scale for each channel over all trials, so that errors are comparable.
    let deviations = standard_deviations(&trials::trial_refs(read));
    let simulator = TrialSimulator { model, law, settings, deviations };
    print_note(&format!("simulating {} with {}", format_count(read.len(), "trial"), model.name));
    read.iter().map(|read| simulator.simulate_trial(read)).collect()
}

/// Writes the states of each trial, if an output folder is given.
fn write_tracks(
    runs: Vec<(SimulatedTrial, TrialReplay)>,
    files: Vec<track_files::TrackFile>,
    law: &Law,
    read: &[ReadTrial],
) -> Result<Vec<SimulatedTrial>, Failure> {
    let mut files = files.into_iter();
    // There is either one file for each trial or none.
    let one = |((mut simulated, run), read): ((SimulatedTrial, TrialReplay), &ReadTrial)| {
        if let Some(promised) = files.next() {
            promised.file.write(&track::track_csv(
                &run.track,
                law,
                read.trial.channel(Channel::N).is_some(),
            )?)?;
            simulated.out = Some(promised.shown);
        }
        Ok(simulated)
    };
    runs.into_iter().zip(read).map(one).collect()
}

fn format_simulation(
    simulate: &SimulateArguments,
    model: &Model,
    law: &Law,
    document: &SimulateDocument<'_>,
) -> String {
    let restart = simulate.restart_s.map_or("once, from the first sample".to_owned(), |s| {
        format!("every {} s, from the measured state", format_number(s))
    });
    let head =
        format!("{}\nstarted {restart}; root mean square errors\n\n", model_line(model, law));
    let mut table = TextTable::new([
        "trial", "s", "u m/s", "v m/s", "r deg/s", "psi deg", "x m", "y m", "std. MSE",
    ]);
    document
        .trials
        .iter()
        // For a single trial the total would repeat its row.
        .chain(document.all.as_ref().filter(|_| document.trials.len() > 1))
        .for_each(|trial| table.add_row(trial.table_cells()));
    let diverged = document.trials.iter().filter_map(|trial| {
        Some(format!("DIVERGED: {}: {}\n", trial.file, trial.reason.as_ref()?))
    });
    let outside = |trial: &SimulatedTrial| {
        Some(format!("OUTSIDE: {}: {}\n", trial.file, trial.outside.as_ref()?.describe()))
    };
    let outside: String = document.trials.iter().filter_map(outside).collect();
    let written = simulate
        .out
        .as_ref()
        .map_or(String::new(), |out| format!("simulated states written to {}\n", out.display()));
    let share = document.all.as_ref().and_then(|all| all.branch_share);
    let branch = document.branch.as_ref().map_or(String::new(), |branch| branch.to_line(share));
    format!("{head}{table}{}{outside}{branch}{written}", diverged.collect::<String>())
}
