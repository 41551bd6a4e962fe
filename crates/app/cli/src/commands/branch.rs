//! `sistership branch`: training of a learned correction on the residual accelerations of a model.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use sistership_jobs::derive::correction_with_uncertainty;
use sistership_learned::{
    BranchChoice, BranchKind, BranchSettings, CorrectionEvaluation, CorrectionTraining,
    HeldOutFold, HeldOutTrials, KindSearch, attach, evaluate_training, select_kind,
    train_correction, with_branch,
};
use sistership_model::branch::CorrectionMode;
use sistership_model::{Law, Model, Trial, Zoo};

use super::branch_document::BranchDocument;
use super::branch_text;
use super::written_files::{WrittenFiles, check_outputs, model_file, output_file};
use crate::failure::{Failure, combine_results};
use crate::output::{self, format_count, print_note};
use crate::resolve;
use crate::trials;
use crate::values::positive;
use crate::weights::{self, CorrectionSummary};

const EXAMPLES: &str = "\
Examples:
  sistership branch --model my-model.yaml --trials trials.yaml --out with-branch.yaml
  sistership branch --model mariner --trials a.csv b.csv c.csv --kind forest --mode parallel --out m.yaml --json

The weights are written next to the model: with-branch.weights.json for with-branch.yaml. By default
all kinds are compared on held-out trials, and the best is used if it is significantly better than
the model without a correction. Otherwise --out writes nothing, and the exit status is 0.";

/// Train a learned correction on the residual accelerations of a model.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct BranchArguments {
    /// The model to be corrected: a name in the zoo, a model file, or a vessel file with a model.
    #[arg(long)]
    model: String,
    /// Trial manifests, CSV or Parquet files.
    #[arg(long, value_name = "TRIALS", num_args = 1.., required = true)]
    trials: Vec<PathBuf>,
    /// Kind of regressor.
    #[arg(long, value_enum, default_value_t)]
    kind: RegressorKind,
    /// Combination with the law: `parallel` adds to its accelerations, `serial` replaces them and
    /// takes them as inputs, `convert` replaces them without.
    #[arg(long, value_enum, default_value_t)]
    mode: CombinationMode,
    /// Seed of the random numbers.
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    seed: u64,
    /// Interval over which accelerations are estimated; the default is half the time to travel a
    /// ship length.
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_negative_numbers = true)]
    window_s: Option<f64>,
    /// Distance outside the range covered by the trials at which the correction has faded to zero,
    /// in half ranges; 1 by default.
    #[arg(long, value_name = "HALF_RANGES", value_parser = positive, allow_negative_numbers = true)]
    fade: Option<f64>,
    /// Write the model with the correction, and its weights next to it.
    #[arg(long, value_name = "MODEL.yaml")]
    out: Option<PathBuf>,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

/// Kinds of regressors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
enum RegressorKind {
    /// The best on held-out trials, if it is significantly better than none.
    #[default]
    Auto,
    /// A random forest.
    Forest,
    /// Boosted trees.
    Boosted,
    /// Kernel ridge.
    Kernels,
    /// A multilayer perceptron.
    Perceptron,
}

/// Combinations of a learned correction with the law.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
enum CombinationMode {
    /// Adds to the accelerations of the law.
    #[default]
    Parallel,
    /// Replaces the accelerations of the law, which are among its inputs.
    Serial,
    /// Replaces the accelerations of the law, without them as inputs.
    Convert,
}

impl RegressorKind {
    fn branch_kind(self) -> Option<BranchKind> {
        match self {
            Self::Auto => None,
            Self::Forest => Some(BranchKind::Forest),
            Self::Boosted => Some(BranchKind::Boosted),
            Self::Kernels => Some(BranchKind::Kernels),
            Self::Perceptron => Some(BranchKind::Perceptron),
        }
    }
}

impl From<CombinationMode> for CorrectionMode {
    fn from(mode: CombinationMode) -> Self {
        match mode {
            CombinationMode::Parallel => Self::Parallel,
            CombinationMode::Serial => Self::Serial,
            CombinationMode::Convert => Self::Convert,
        }
    }
}

/// Learned correction with its training and its cross-validation.
struct TrainedCorrection {
    model: Model,
    weights: Vec<u8>,
    training: CorrectionTraining,
    judgement: Option<CorrectionEvaluation>,
}

/// Runs the command.
///
/// # Errors
/// Returns an error if the model, a trial or a setting is refused, or if a file cannot be written.
pub fn run(zoo: &Zoo, arguments: &BranchArguments) -> Result<(), Failure> {
    let inputs: Vec<PathBuf> =
        arguments.trials.iter().cloned().chain([PathBuf::from(&arguments.model)]).collect();
    let beside = arguments.out.as_deref().map(weights::weights_path);
    // Output files are checked before the work, and all faults of the call are reported together.
    let files = combine_results(
        output_file(arguments.out.as_deref(), &inputs),
        output_file(beside.as_deref(), &inputs),
    );
    let asked = combine_results(
        branch_settings(arguments),
        resolve::resolve_foundation(zoo, &arguments.model),
    );
    let read = combine_results(files, trials::read_trials(&arguments.trials));
    let ((settings, (model, law)), ((out, beside_file), read)) = combine_results(asked, read)?;
    // A warning only: a sister ship's trials may be used on purpose.
    trials::remark_other_ship(&read, &model.ship);
    let mut files = WrittenFiles { out: arguments.out.as_deref(), report: None };
    check_outputs(&files, &read)?;
    print_note(&format!("{}: {} read", model.name, format_count(read.len(), "trial")));
    let (choice, trained) =
        train_and_judge((zoo, &model, &law), &trials::trial_refs(&read), &settings)?;
    match (out, beside_file, &trained) {
        (Some(out), Some(beside), Some(trained)) => {
            // Weights first, so that a model that exists has its weights.
            beside.write(&trained.weights)?;
            out.write(model_file(zoo, &trained.model, "with a learned correction")?.as_bytes())?;
        }
        (Some(_), ..) => print_note("no learned correction is used, and --out writes nothing"),
        _ => {}
    }
    // The output names only files that were written.
    files.out = files.out.filter(|_| trained.is_some());
    let beside = beside.as_deref().filter(|_| trained.is_some());
    let document = output_document(&model, choice.as_ref(), trained.as_ref(), files, beside);
    output::print_result(arguments.json, &document, || branch_text::format_branch(&document))
}

/// Returns the settings. A setting that is wrong regardless of the data is an error of the call.
fn branch_settings(arguments: &BranchArguments) -> Result<BranchSettings, Failure> {
    let settings = BranchSettings {
        kind: arguments.kind.branch_kind(),
        mode: Some(arguments.mode.into()),
        seed: Some(arguments.seed),
        window_s: arguments.window_s,
        fade: arguments.fade,
        ..BranchSettings::default()
    };
    let flag = |field: String| field.replace('_', "-");
    settings
        .check()
        .map_err(|(field, message)| Failure::Call(format!("--{}: {message}", flag(field))))?;
    Ok(settings)
}

fn refusal(error: impl std::fmt::Display) -> Failure {
    Failure::Refused(error.to_string())
}

/// Trains the requested kind, or the one that the comparison on held-out trials selects; `None` if
/// that selects none.
fn train_and_judge(
    (zoo, model, law): (&Zoo, &Model, &Law),
    trials: &[&Trial],
    settings: &BranchSettings,
) -> Result<(Option<BranchChoice>, Option<TrainedCorrection>), Failure> {
    let (choice, settings) = if settings.is_open() {
        let told = |kind: BranchKind| {
            print_note(&format!("cross-validating {}", kind.name()));
            true
        };
        // The foundation is the same in every fold.
        let folds = HeldOutFold::with_one_foundation(model, trials.len());
        let on = HeldOutTrials { law, trials, folds: &folds };
        let choice =
            select_kind(model, &on, (settings, KindSearch::Every), &told).map_err(refusal)?;
        match choice.as_ref().and_then(|choice| choice.taken) {
            // The comparison is part of the output, also when it selects nothing.
            Some(kind) => (choice, settings.with_kind(kind)),
            None => return Ok((choice, None)),
        }
    } else {
        (None, settings.clone())
    };
    let training = settings.complete_training(model, law, trials).map_err(refusal)?;
    print_note("training the learned correction and cross-validating it");
    let (branch, weights) = train_correction(model, law, trials, &training).map_err(refusal)?;
    let judgement = evaluate_training(model, law, trials, &training).map_err(refusal)?;
    let weights = weights.to_bytes().map_err(refusal)?;
    let mut model = with_branch(model, branch);
    // The calibration simulates the model, so the weights must be attached before it.
    attach(&mut model, &weights).map_err(refusal)?;
    print_note("estimating the noise model of the corrected model");
    let effects: Vec<_> = zoo.effects().cloned().collect();
    let model = correction_with_uncertainty(model, law, &effects, trials);
    Ok((choice, Some(TrainedCorrection { model, weights, training, judgement })))
}

fn output_document<'a>(
    model: &'a Model,
    choice: Option<&'a BranchChoice>,
    trained: Option<&'a TrainedCorrection>,
    files: WrittenFiles<'a>,
    weights: Option<&'a Path>,
) -> BranchDocument<'a> {
    let branch = trained.and_then(|trained| trained.model.branch.as_ref());
    let judgement = trained.and_then(|trained| trained.judgement.as_ref());
    BranchDocument {
        model: &model.name,
        choice,
        branch: branch.map(CorrectionSummary::from_branch),
        training: trained.map(|trained| &trained.training),
        weights_sha256: branch.map(|branch| branch.weights_sha256.as_str()),
        judgement,
        wins: judgement.map(CorrectionEvaluation::is_better),
        files,
        weights,
    }
}
