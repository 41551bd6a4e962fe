//! `sistership diagnose`: physical effects that a model lacks, from trials that it was not fitted
//! on.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use serde::Serialize;
use serde_json::Value;
use sistership_diagnosis::{Diagnosis, DiagnosisInputs, EffectHistory, Settings, diagnose};
use sistership_model::{Effect, Law, Model, Zoo};
use sistership_report::{DiagnosisInput, render_diagnosis};

use super::diagnose_text;
use super::written_files::{WrittenFiles, check_outputs, model_file, output_file};
use crate::failure::{Failure, combine_results};
use crate::files::OutputFile;
use crate::output::{self, format_count, print_note};
use crate::resolve;
use crate::trials::{self, ReadTrial};
use crate::values::{odds, positive};
use crate::weights;

const EXAMPLES: &str = "\
Examples:
  sistership diagnose --model my-model.yaml --trials new-trials.yaml --report diagnosis.html
  sistership diagnose --model my-model.yaml --trials a.csv b.csv c.csv --out with-effects.yaml --json
  sistership diagnose --model my-model.yaml --trials tuesday.csv --after monday.json --json
  sistership diagnose --zoo my-effects --model kvlcc2 --trials trials.yaml

Give several trials that the model was not fitted on, on several headings: on a single heading
current and wind cannot be distinguished. The verdict is `complete`, `effects` or `unexplained`;
the exit status is 0 for all three.";

/// Find the physical effects that a model lacks, from trials that it was not fitted on.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct DiagnoseArguments {
    /// The model: a name in the zoo, a model file, or a vessel file with a model.
    #[arg(long)]
    model: String,
    /// Trial manifests, CSV or Parquet files.
    #[arg(long, value_name = "TRIALS", num_args = 1.., required = true)]
    trials: Vec<PathBuf>,
    /// Interval at which held-out simulations restart from the measured state; the default is ten
    /// ship lengths.
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_negative_numbers = true)]
    restart_s: Option<f64>,
    /// Shortest interval between samples; the default is the time to travel a fiftieth of a ship
    /// length.
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_negative_numbers = true)]
    least_step_s: Option<f64>,
    /// Relative standard deviation of coefficients of a model without a posterior.
    #[arg(long, value_name = "SHARE", value_parser = positive, allow_negative_numbers = true)]
    slack: Option<f64>,
    /// Smallest log evidence (natural logarithm) of a reported effect.
    #[arg(long, value_name = "EVIDENCE", allow_negative_numbers = true)]
    least_evidence: Option<f64>,
    /// Largest number of effects in a combination.
    #[arg(long, value_name = "N")]
    most_effects: Option<usize>,
    /// Prior odds of an effect against its absence; the defaults are those of the effect library;
    /// repeatable.
    #[arg(long, value_name = "EFFECT=ODDS", value_parser = odds)]
    prior_odds: Vec<(String, f64)>,
    /// Answer of the previous diagnosis of the model (`--json`), on other trials of the ship: what
    /// these say on its effects counts.
    #[arg(long, value_name = "ANSWER.json")]
    after: Option<PathBuf>,
    /// Write the model with the effects found.
    #[arg(long, value_name = "MODEL.yaml")]
    out: Option<PathBuf>,
    /// Write a report with plots.
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct DiagnoseDocument<'a> {
    #[serde(flatten)]
    diagnosis: Value,
    #[serde(flatten)]
    files: WrittenFiles<'a>,
}

/// Runs the command.
///
/// # Errors
/// Returns an error if the model, a trial or a setting is refused, or if a file cannot be written.
pub fn run(zoo: &Zoo, arguments: &DiagnoseArguments) -> Result<(), Failure> {
    let named: Vec<PathBuf> =
        arguments.trials.iter().cloned().chain([PathBuf::from(&arguments.model)]).collect();
    let beside = arguments.out.as_deref().map(weights::weights_path);
    // Output files are checked before the work, and all faults of the call are reported together.
    let files = combine_results(
        combine_results(
            output_file(arguments.out.as_deref(), &named),
            output_file(beside.as_deref(), &named),
        ),
        output_file(arguments.report.as_deref(), &named),
    );
    let asked = combine_results(
        diagnosis_settings(zoo, arguments),
        resolve::resolve_model(zoo, &arguments.model),
    );
    let read = combine_results(files, trials::read_trials(&arguments.trials));
    let ((settings, (model, law)), (((out, beside), report), read)) = combine_results(asked, read)?;
    trials::remark_other_ship(&read, &model.ship);
    print_note(&format!("{}: {} read", model.name, format_count(read.len(), "trial")));
    let mut files =
        WrittenFiles { out: arguments.out.as_deref(), report: arguments.report.as_deref() };
    check_outputs(&files, &read)?;
    let diagnosis = run_diagnosis(zoo, &model, &law, &settings, &read)?;
    if let (Some(found), Some(_), Some(file)) = (&diagnosis.model, &out, beside) {
        // Weights first, so that a model that exists has its weights.
        let kept = weights::read_weights(Path::new(&arguments.model), found)?;
        kept.map_or(Ok(()), |bytes| file.write(&bytes))?;
    }
    let kept = write_model(zoo, out, &diagnosis)?;
    if let Some(report) = report {
        report.write(&report_html(&model, &law, &diagnosis, &read)?)?;
    }
    // The output names only files that were written.
    files.out = files.out.filter(|_| kept);
    let document = DiagnoseDocument { diagnosis: output_document(&diagnosis)?, files };
    output::print_result(arguments.json, &document, || {
        diagnose_text::format_diagnosis(&diagnosis, &model, &files)
    })
}

/// Returns the settings. A setting that is wrong regardless of the data is an error of the call.
fn diagnosis_settings(zoo: &Zoo, arguments: &DiagnoseArguments) -> Result<Settings, Failure> {
    // The zoo of the call counts: it may have effects of the folders in --zoo.
    let unknown = |(name, _): &&(String, f64)| zoo.effect(name).is_none();
    if let Some((name, _)) = arguments.prior_odds.iter().find(unknown) {
        let known: Vec<&str> = zoo.effects().map(|effect| effect.name.as_str()).collect();
        let message = format!(
            "--prior-odds: there is no effect `{name}`; choose one of {}",
            known.join(", ")
        );
        return Err(Failure::Call(message));
    }
    let default = Settings::default();
    let settings = Settings {
        restart_s: arguments.restart_s,
        least_step_s: arguments.least_step_s,
        slack: arguments.slack.unwrap_or(default.slack),
        least_evidence: arguments.least_evidence.unwrap_or(default.least_evidence),
        most_effects: arguments.most_effects.unwrap_or(default.most_effects),
        prior_odds: arguments.prior_odds.iter().cloned().collect(),
        earlier: arguments.after.as_deref().map(read_history).transpose()?,
    };
    // The setting holds what the file of the flag says.
    let flag = |field: String| match field.as_str() {
        "earlier" => "after".to_owned(),
        _ => field.replace('_', "-"),
    };
    settings
        .check_values()
        .map_err(|(field, message)| Failure::Call(format!("--{}: {message}", flag(field))))?;
    Ok(settings)
}

/// Reason for the refusal of an answer without information on effects.
const NO_HISTORY: &str =
    "has no `history`, as where something is unexplained, or where it is no answer of a diagnosis";

/// Reads what the answer of an earlier diagnosis says on the effects of the ship.
fn read_history(path: &Path) -> Result<EffectHistory, Failure> {
    let refuse = |reason: String| {
        Failure::Refused(format!(
            "{}: {reason}; give an answer that `sistership diagnose --json` has printed",
            path.display()
        ))
    };
    let text = std::fs::read_to_string(path).map_err(|error| refuse(error.to_string()))?;
    let mut answer: Value =
        serde_json::from_str(&text).map_err(|error| refuse(error.to_string()))?;
    let history = answer.get_mut("history").map(Value::take);
    let history = history.ok_or_else(|| refuse(NO_HISTORY.to_owned()))?;
    serde_json::from_value(history).map_err(|error| refuse(format!("history: {error}")))
}

fn run_diagnosis(
    zoo: &Zoo,
    model: &Model,
    law: &Law,
    settings: &Settings,
    read: &[ReadTrial],
) -> Result<Diagnosis, Failure> {
    let effects: Vec<Arc<Effect>> = zoo.effects().cloned().collect();
    let trials = trials::trial_refs(read);
    let request = DiagnosisInputs { model, law, effects: &effects, trials: &trials, settings };
    let told = |fraction: f64, what: &str| {
        print_note(&format!("{:3.0} % {what}", 100.0 * fraction));
        true
    };
    diagnose(&request, &told).map_err(|error| Failure::Refused(error.to_string()))
}

/// Writes the model with the effects; returns true if there was one to write.
fn write_model(zoo: &Zoo, out: Option<OutputFile>, diagnosis: &Diagnosis) -> Result<bool, Failure> {
    match (out, &diagnosis.model) {
        (Some(out), Some(model)) => out
            .write(model_file(zoo, model, "with the effects that a diagnosis found")?.as_bytes())
            .map(|()| true),
        (Some(_), None) => {
            print_note(
                "no missing effect was found: the model is unchanged, and --out writes \
                        nothing",
            );
            Ok(false)
        }
        (None, _) => Ok(false),
    }
}

fn report_html(
    model: &Model,
    law: &Law,
    diagnosis: &Diagnosis,
    read: &[ReadTrial],
) -> Result<Vec<u8>, Failure> {
    let trials = trials::trial_refs(read);
    let input = DiagnosisInput { diagnosis, model, law, trials: &trials, of: None, made: None };
    let rendered = render_diagnosis(&input)
        .map_err(|error| Failure::Refused(format!("the report cannot be written: {error}")))?;
    Ok(rendered.html.into_bytes())
}

/// Returns the diagnosis without the model, which `--out` writes, and without the series that only
/// plots need.
fn output_document(diagnosis: &Diagnosis) -> Result<Value, Failure> {
    let document = serde_json::to_value(diagnosis);
    let mut document = document
        .map_err(|error| Failure::Refused(format!("the result cannot be written: {error}")))?;
    if let Some(fields) = document.as_object_mut() {
        fields.remove("model");
        // Series of all trials would make up most of the document.
        fields.remove("residuals");
    }
    Ok(document)
}
