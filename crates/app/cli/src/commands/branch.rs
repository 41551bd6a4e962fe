//! `sistership branch`: training of a learned correction on the residual accelerations of a model.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use sistership_jobs::derive::corrected_with_uncertainty;
use sistership_learned::{
    BranchChoice, BranchKind, BranchSettings, HeldOutFold, HeldOutTrials, Judgement, Kinds,
    Training, attach, choose, judge, train, with_branch,
};
use sistership_model::branch::BranchMode;
use sistership_model::{Law, Model, Trial, Zoo};

use super::branch_document::BranchDocument;
use super::branch_text;
use super::written::{WrittenFiles, guard, model_file, promised};
use crate::failure::{Failure, both};
use crate::named;
use crate::output::{self, count, note};
use crate::trials;
use crate::values::positive;
use crate::weights::{self, BranchWords};

const EXAMPLES: &str = "\
Examples:
  sistership branch --model my-model.yaml --trials trials.yaml --out with-branch.yaml
  sistership branch --model mariner --trials a.csv b.csv c.csv --kind forest --mode parallel --out m.yaml --json

The weights are written next to the model: with-branch.weights.json for with-branch.yaml. By default
every kind is compared on held-out trials, and none is used that is not significantly better than
the model without a correction: --out then writes nothing, and the exit status is 0.";

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
    kind: Kind,
    /// Combination with the law: `parallel` adds to its accelerations, `serial` replaces them and
    /// takes them as inputs, `convert` replaces them without.
    #[arg(long, value_enum, default_value_t)]
    mode: Mode,
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
enum Kind {
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
enum Mode {
    /// Adds to the accelerations of the law.
    #[default]
    Parallel,
    /// Replaces the accelerations of the law, which are among its inputs.
    Serial,
    /// Replaces the accelerations of the law, without them as inputs.
    Convert,
}

impl Kind {
    fn named(self) -> Option<BranchKind> {
        match self {
            Self::Auto => None,
            Self::Forest => Some(BranchKind::Forest),
            Self::Boosted => Some(BranchKind::Boosted),
            Self::Kernels => Some(BranchKind::Kernels),
            Self::Perceptron => Some(BranchKind::Perceptron),
        }
    }
}

impl From<Mode> for BranchMode {
    fn from(mode: Mode) -> Self {
        match mode {
            Mode::Parallel => Self::Parallel,
            Mode::Serial => Self::Serial,
            Mode::Convert => Self::Convert,
        }
    }
}

/// Learned correction with its training and its cross-validation.
struct Trained {
    model: Model,
    weights: Vec<u8>,
    training: Training,
    judgement: Option<Judgement>,
}

/// Runs the command.
///
/// # Errors
/// Returns an error if the model, a trial or a setting is refused, or if a file cannot be written.
pub fn run(zoo: &Zoo, arguments: &BranchArguments) -> Result<(), Failure> {
    let inputs: Vec<PathBuf> =
        arguments.trials.iter().cloned().chain([PathBuf::from(&arguments.model)]).collect();
    let beside = arguments.out.as_deref().map(weights::beside);
    // Output files are checked before the work, and all faults of the call are reported together.
    let files =
        both(promised(arguments.out.as_deref(), &inputs), promised(beside.as_deref(), &inputs));
    let asked = both(settings(arguments), named::foundation(zoo, &arguments.model));
    let read = both(files, trials::read(&arguments.trials));
    let ((settings, (model, law)), ((out, beside_file), read)) = both(asked, read)?;
    // A warning only: a sister ship's trials may be used on purpose.
    trials::remark_other_ship(&read, &model.ship);
    let mut files = WrittenFiles { out: arguments.out.as_deref(), report: None };
    guard(&files, &read)?;
    note(&format!("{}: {} read", model.name, count(read.len(), "trial")));
    let (choice, trained) = trained((zoo, &model, &law), &trials::trials(&read), &settings)?;
    match (out, beside_file, &trained) {
        (Some(out), Some(beside), Some(trained)) => {
            // Weights first, so that a model that exists has its weights.
            beside.write(&trained.weights)?;
            out.write(model_file(zoo, &trained.model, "with a learned branch")?.as_bytes())?;
        }
        (Some(_), ..) => note("no branch is taken, and --out writes nothing"),
        _ => {}
    }
    // The output names only files that were written.
    files.out = files.out.filter(|_| trained.is_some());
    let beside = beside.as_deref().filter(|_| trained.is_some());
    let document = document(&model, choice.as_ref(), trained.as_ref(), files, beside);
    output::print(arguments.json, &document, || branch_text::text(&document))
}

/// Returns the settings. A setting that is wrong regardless of the data is an error of the call.
fn settings(arguments: &BranchArguments) -> Result<BranchSettings, Failure> {
    let settings = BranchSettings {
        kind: arguments.kind.named(),
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

fn refused(error: impl std::fmt::Display) -> Failure {
    Failure::Refused(error.to_string())
}

/// Trains the requested kind, or the one that the comparison on held-out trials selects; `None` if
/// that selects none.
fn trained(
    (zoo, model, law): (&Zoo, &Model, &Law),
    trials: &[&Trial],
    settings: &BranchSettings,
) -> Result<(Option<BranchChoice>, Option<Trained>), Failure> {
    let (choice, settings) = if settings.is_open() {
        let told = |kind: BranchKind| {
            note(&format!("trying {} on trials left out", kind.name()));
            true
        };
        // The foundation is the same in every fold.
        let folds = HeldOutFold::of_one(model, trials.len());
        let on = HeldOutTrials { law, trials, folds: &folds };
        let choice = choose(model, &on, (settings, Kinds::Every), &told).map_err(refused)?;
        match choice.as_ref().and_then(|choice| choice.taken) {
            // The comparison is part of the output, also when it selects nothing.
            Some(kind) => (choice, settings.of(kind)),
            None => return Ok((choice, None)),
        }
    } else {
        (None, settings.clone())
    };
    let training = settings.training(model, law, trials).map_err(refused)?;
    note("training the branch, and judging it on trials left out");
    let (branch, weights) = train(model, law, trials, &training).map_err(refused)?;
    let judgement = judge(model, law, trials, &training).map_err(refused)?;
    let weights = weights.bytes().map_err(refused)?;
    let mut model = with_branch(model, branch);
    // The calibration simulates the model, so the weights must be attached before it.
    attach(&mut model, &weights).map_err(refused)?;
    note("learning what these trials leave open beside it");
    let effects: Vec<_> = zoo.effects().cloned().collect();
    let model = corrected_with_uncertainty(model, law, &effects, trials);
    Ok((choice, Some(Trained { model, weights, training, judgement })))
}

fn document<'a>(
    model: &'a Model,
    choice: Option<&'a BranchChoice>,
    trained: Option<&'a Trained>,
    files: WrittenFiles<'a>,
    weights: Option<&'a Path>,
) -> BranchDocument<'a> {
    let branch = trained.and_then(|trained| trained.model.branch.as_ref());
    let judgement = trained.and_then(|trained| trained.judgement.as_ref());
    BranchDocument {
        model: &model.name,
        choice,
        branch: branch.map(BranchWords::of),
        training: trained.map(|trained| &trained.training),
        weights_sha256: branch.map(|branch| branch.weights_sha256.as_str()),
        judgement,
        wins: judgement.map(Judgement::wins),
        files,
        weights,
    }
}
