//! `sistership compare`: comparison of models.

use std::path::PathBuf;

use clap::Args;
use sistership_jobs::comparison::{
    ComparedTrial, Comparison, ComparisonModel, TrialError, check_names, compare,
};
use sistership_model::Zoo;
use sistership_model::trial::{Channel, Trial};

use crate::failure::{Failure, collect_results, combine_results};
use crate::table::{TextTable, format_number, format_optional};
use crate::{output, resolve, trials};

const EXAMPLES: &str = "\
Examples:
  sistership compare kvlcc2 my-tanker.yaml
  sistership compare my-model.yaml source.yaml --trials trials.yaml --json

Errors are root mean squares of simulations that start once from the first sample. The exit status
is 0 even if an IMO criterion is not met.";

/// Compare two to five models: coefficients, errors on the same trials, standard manoeuvres.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct CompareArguments {
    /// Models: names in the zoo, model files, or vessel files with a model.
    #[arg(required = true, num_args = 2..=5, value_name = "MODEL")]
    models: Vec<String>,
    /// Trial manifests, CSV or Parquet files.
    #[arg(long, value_name = "TRIALS", num_args = 1..)]
    trials: Vec<PathBuf>,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
/// Returns an error if a model or a trial is refused.
pub fn run(zoo: &Zoo, asked: &CompareArguments) -> Result<(), Failure> {
    let refused = |error: &dyn std::fmt::Display| Failure::Refused(error.to_string());
    let names: Vec<&str> = asked.models.iter().map(String::as_str).collect();
    check_names(&names).map_err(|error| Failure::Call(error.to_string()))?;
    // All unknown names and faulty trials are reported together.
    let models = collect_results(names.iter().map(|name| resolve::resolve_model(zoo, name)));
    let (models, read) = combine_results(models, trials::read_trials(&asked.trials))?;
    let compared: Vec<ComparisonModel<'_>> = names
        .iter()
        .zip(&models)
        .map(|(name, (model, law))| ComparisonModel { name, model, law })
        .collect();
    let on: Vec<(&str, &Trial)> =
        read.iter().map(|read| (read.file.as_str(), &read.trial)).collect();
    let comparison = compare(&compared, &on).map_err(|error| refused(&error))?;
    output::print_result(asked.json, &comparison, || format_comparison(&comparison))
}

fn format_comparison(comparison: &Comparison) -> String {
    let mut parts = vec![format_models(comparison), format_coefficients(comparison)];
    if !comparison.trials.is_empty() {
        // Without trials there is no table of errors.
        parts.push(format_errors(comparison));
    }
    parts.push(format_figures(comparison));
    let failures = comparison.models.iter().flat_map(|model| {
        model.failures.iter().map(|failure| format!("{}: {failure}\n", model.name))
    });
    parts.push(failures.collect());
    parts.join("\n")
}

/// Creates a table with a column for each model.
fn model_table(comparison: &Comparison, first: &[&str]) -> TextTable {
    let names = comparison.models.iter().map(|model| model.name.as_str());
    TextTable::with_columns(first.iter().copied().chain(names))
}

fn format_models(comparison: &Comparison) -> String {
    let mut table = TextTable::new(["model", "law", "ship", "Lpp m", "speed m/s"]);
    for model in &comparison.models {
        let (name, law, ship) = (model.name.clone(), model.law.clone(), model.ship.clone());
        table.add_row(vec![
            name,
            law,
            ship,
            format_number(model.lpp_m),
            format_number(model.speed_m_s),
        ]);
    }
    table.to_string()
}

fn format_coefficients(comparison: &Comparison) -> String {
    let mut table = model_table(comparison, &["coefficient"]);
    for row in &comparison.coefficients {
        let cell = |value: &Option<sistership_jobs::comparison::Estimate>| match value {
            // The model does not have this coefficient.
            None => "-".to_owned(),
            Some(estimate) => {
                let error = estimate.standard_error;
                let error = error.map_or(String::new(), |error| format!(" +- {error:.1e}"));
                format!("{:.5e}{error}", estimate.value)
            }
        };
        table.add_row(std::iter::once(row.name.clone()).chain(row.values.iter().map(cell)));
    }
    table.to_string()
}

/// Channels of the table of errors, with unit and factor from SI to that unit.
const ERROR_CHANNELS: [(Channel, &str, f64); 6] = [
    (Channel::U, "u m/s", 1.0),
    (Channel::V, "v m/s", 1.0),
    (Channel::R, "r deg/s", 180.0 / std::f64::consts::PI),
    (Channel::Psi, "psi deg", 180.0 / std::f64::consts::PI),
    (Channel::X, "x m", 1.0),
    (Channel::Y, "y m", 1.0),
];

fn format_errors(comparison: &Comparison) -> String {
    let mut table = model_table(comparison, &["trial", "error"]);
    for trial in &comparison.trials {
        for (channel, unit, factor) in ERROR_CHANNELS {
            let of = |error: &TrialError| {
                format_optional(error.rmse.get(channel.name()).map(|rmse| rmse * factor))
            };
            table.add_row(error_row(trial, unit, of));
        }
        table
            .add_row(error_row(trial, "std. MSE", |error| format_optional(error.standardised_mse)));
    }
    // For a single trial the total would repeat its row.
    if comparison.trials.len() > 1 {
        let all = comparison.models.iter().map(|model| format_optional(model.standardised_mse));
        table.add_row(["all".to_owned(), "std. MSE".to_owned()].into_iter().chain(all));
    }
    // A missing error has a reason, which follows the table.
    let reasons = comparison.trials.iter().flat_map(|trial| {
        let models = comparison.models.iter().zip(&trial.errors);
        models.filter_map(|(model, error)| {
            Some(format!("{}: {}: {}\n", trial.trial, model.name, error.reason.as_ref()?))
        })
    });
    format!("{table}{}", reasons.collect::<String>())
}

fn error_row(trial: &ComparedTrial, what: &str, of: impl Fn(&TrialError) -> String) -> Vec<String> {
    let head = [trial.trial.clone(), what.to_owned()];
    head.into_iter().chain(trial.errors.iter().map(of)).collect()
}

fn format_figures(comparison: &Comparison) -> String {
    let mut table = model_table(comparison, &["figure", "unit"]);
    for row in &comparison.figures {
        let cell = |value: &Option<sistership_jobs::comparison::FigureValue>| match value {
            None => "-".to_owned(),
            Some(figure) => {
                // Only criteria have a verdict; other figures are values.
                let met = match figure.pass {
                    Some(true) => " met",
                    Some(false) => " NOT met",
                    None => "",
                };
                format!("{}{met}", format_optional(figure.value))
            }
        };
        let head = [row.name.clone(), row.unit.clone()];
        table.add_row(head.into_iter().chain(row.values.iter().map(cell)));
    }
    table.to_string()
}
