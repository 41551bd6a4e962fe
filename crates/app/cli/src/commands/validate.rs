//! `sistership validate`: validation of a model against trials of its ship, by ITTC 7.5-02-06-03.

use std::path::PathBuf;

use clap::Args;
use sistership_assessment::uncertainty::{Sampling, draw_from_posterior};
use sistership_assessment::validation::{TrialOfShip, Validation, validate};
use sistership_model::Zoo;
use sistership_report::render_validation;

use crate::failure::{Failure, combine_results};
use crate::files::OutputFile;
use crate::table::{TextTable, format_number, format_optional};
use crate::{output, resolve, trials};

const EXAMPLES: &str = "\
Examples:
  sistership validate --model kvlcc2 --ship kvlcc2
  sistership validate --model my-model.yaml --ship my-ship.yaml --trials kept-out.yaml
  sistership validate --model my-model.yaml --ship my-ship.yaml --trials kept-out.yaml --report validation.html

Give trials that the model was not fitted on. Repeated manoeuvres give the uncertainty of the data.
The exit status is 0 even if a quantity is not validated.";

/// Validate a model against trials of its ship by ITTC 7.5-02-06-03.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct ValidateArguments {
    /// The model: a name in the zoo, a model file, or a vessel file with a model.
    #[arg(long)]
    model: String,
    /// The ship, with its published free-running trials: a name in the zoo or a vessel file.
    #[arg(long)]
    ship: String,
    /// Trials that the model was not fitted on: manifests, CSV or Parquet files.
    #[arg(long, value_name = "TRIALS", num_args = 1..)]
    trials: Vec<PathBuf>,
    /// Number of draws from the posterior of a refined model.
    #[arg(long, value_name = "DRAWS", default_value_t = 40)]
    draws: usize,
    /// Write the report as a page.
    #[arg(long, value_name = "HTML")]
    report: Option<PathBuf>,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
/// Returns an error if the model, the ship or a trial is refused.
pub fn run(zoo: &Zoo, asked: &ValidateArguments) -> Result<(), Failure> {
    let refused = |error: &dyn std::fmt::Display| Failure::Refused(error.to_string());
    let inputs: Vec<PathBuf> = [&asked.model, &asked.ship].map(PathBuf::from).to_vec();
    let page = asked.report.as_ref().map(|path| OutputFile::new(path, &inputs)).transpose();
    let sampling = Sampling { samples: asked.draws, ..Sampling::default() };
    let checked = sampling.check().map_err(|message| Failure::Call(format!("--draws: {message}")));
    let model = combine_results(
        resolve::resolve_model(zoo, &asked.model),
        resolve::resolve_ship(zoo, &asked.ship),
    );
    let given = combine_results(combine_results(page, checked), trials::read_trials(&asked.trials));
    let (((model, law), vessel), ((page, ()), read)) = combine_results(model, given)?;
    let of_ship: Vec<TrialOfShip<'_>> = read
        .iter()
        // The call asserts that the model was not fitted on these trials, as the help text says.
        .map(|read| TrialOfShip { name: &read.trial.name, trial: &read.trial, fitted: false })
        .collect();
    // A model without posterior is validated without the uncertainty of its parameters.
    let drawn = draw_from_posterior(&model, sampling).unwrap_or_default();
    let done = validate(&vessel, &model, &law, &drawn, &of_ship).map_err(|e| refused(&e))?;
    if let Some(file) = page {
        file.write(render_validation(&done).map_err(|e| refused(&e))?.html.as_bytes())?;
    }
    output::print_result(asked.json, &done, || format_validation(&done))
}

fn format_validation(done: &Validation) -> String {
    let head =
        format!("{}, law {}: validation according to {}\n", done.model, done.law, done.procedure);
    let table = if done.quantities.is_empty() {
        String::new()
    } else {
        format!("\n{}", quantity_table(done))
    };
    let remarks: String = done.remarks.iter().map(|remark| format!("remark: {remark}\n")).collect();
    format!("{head}{table}{}{remarks}", if remarks.is_empty() { "" } else { "\n" })
}

fn quantity_table(done: &Validation) -> TextTable {
    let mut table = TextTable::new([
        "quantity", "unit", "D", "S", "E % D", "U_V % D", "U_D", "U_SN", "U_input", "verdict",
    ]);
    for one in &done.quantities {
        table.add_row([
            one.quantity.clone(),
            one.unit.clone(),
            format_number(one.data),
            format_optional(one.simulated),
            format_optional(one.comparison_error_percent),
            format_optional(one.validation_uncertainty_percent),
            format_optional(one.data_uncertainty),
            format_optional(one.step_uncertainty),
            format_optional(one.input_uncertainty),
            one.verdict.as_words().to_owned(),
        ]);
    }
    table
}
