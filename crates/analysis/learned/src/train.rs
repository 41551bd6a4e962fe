//! Training of a learned correction and its weights from a foundation, trials and a recipe.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use sistership_model::branch::{
    CorrectionDocument, CorrectionError, CorrectionInput, CorrectionMode, CorrectionOutput,
    CorrectionRecipe, Learner, Signal,
};
use sistership_model::coefficient::Axis;
use sistership_model::learned::AttachedWeights;
use sistership_model::trial::Trial;
use sistership_model::validity::Region;
use sistership_model::version::sha256_hex;
use sistership_model::{Law, Model};
use sistership_simulation::{MotionEnvelope, PlantError, Ship};

use crate::domain::FadedDomain;
use crate::joined::JoinError;
use crate::regressor::OutputRegressor;
use crate::rows::{RowsError, WindowRow, window_rows};
use crate::sample::{TrainingSample, centre_and_scale, scale_input, signal_value};
use crate::weights::{CorrectionWeights, WeightsError};

/// Complete settings of a training.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CorrectionTraining {
    /// Way in which the correction is combined with the foundation.
    pub mode: CorrectionMode,
    /// Input signals of each acceleration; axes that are absent are left to the foundation.
    pub inputs: Vec<(Axis, Vec<Signal>)>,
    /// Learner and its settings.
    pub learner: Learner,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Length of the window over which accelerations are averaged, s.
    pub window_s: f64,
    /// Time from one sample to the next, s.
    pub hop_s: f64,
    /// Distance outside the domain at which the correction reaches zero, in half ranges; reduced if
    /// it would reach outside the physical range.
    pub fade: f64,
}

/// Error of a training.
#[derive(Debug, thiserror::Error)]
pub enum TrainError {
    /// The foundation cannot be simulated.
    #[error(transparent)]
    Foundation(#[from] PlantError),
    /// A trial cannot be used for training.
    #[error(transparent)]
    Rows(#[from] RowsError),
    /// A setting is out of range.
    #[error("{0}")]
    Setting(#[from] CorrectionError),
    /// There are too few samples.
    #[error("{found} samples are too few for training: give trials with at least {wanted}")]
    Few {
        /// Number of samples.
        found: usize,
        /// Smallest number that is accepted.
        wanted: usize,
    },
    /// The equations cannot be solved.
    #[error(
        "outputs.{0}: the equations are singular; increase `ridge` or reduce the number of \
             centres"
    )]
    Singular(Axis),
    /// The range covered by trials fills the physical range.
    #[error("the trials reach the limit of the physical range of `{0}`: check for faulty readings")]
    Reach(String),
    /// The trained correction does not fit its foundation.
    #[error(transparent)]
    Joined(#[from] Box<JoinError>),
    /// The weights cannot be written.
    #[error(transparent)]
    Weights(#[from] WeightsError),
}

/// Smallest number of samples: enough for two leaves of twenty samples each.
const FEWEST: usize = 40;

/// Trains a correction on the accelerations of the trials that the foundation, `model` under `law`,
/// does not explain. The bytes of correction and weights depend on the arguments alone.
///
/// # Errors
/// Returns an error that names the trial or the setting at fault.
pub fn train_correction(
    model: &Model,
    law: &Law,
    trials: &[&Trial],
    training: &CorrectionTraining,
) -> Result<(CorrectionDocument, CorrectionWeights), TrainError> {
    let recipe = CorrectionRecipe {
        learner: training.learner.clone(),
        seed: training.seed,
        window_s: training.window_s,
        hop_s: training.hop_s,
        trials: trials.iter().map(|trial| trial.name.clone()).collect(),
    };
    recipe.check_settings()?;
    // The foundation alone: a correction that the model may have already is not part of the
    // residual.
    let ship = Ship::new(&model.without_correction(), law)?;
    let mut all = Vec::new();
    for trial in trials {
        all.extend(window_rows(&ship, trial, training.window_s, training.hop_s)?);
    }
    if all.len() < FEWEST {
        return Err(TrainError::Few { found: all.len(), wanted: FEWEST });
    }
    let reached = || TrainError::Reach(model.name.clone());
    // The domain is that of the training rows, and the fade is reduced until the correction cannot
    // act outside the physical range.
    let domain = covered_region(&all, ship.has_propeller()).ok_or_else(reached)?;
    let fade = fade_within(&domain, training.fade, ship.envelope()).ok_or_else(reached)?;
    // The document names its weights by hash, so they are trained first.
    let (outputs, weights) = train_outputs(&all, training)?;
    let weights_sha256 = sha256_hex(&weights.to_bytes()?);
    let branch = CorrectionDocument {
        mode: training.mode,
        outputs,
        weights_sha256,
        domain,
        fade,
        recipe,
        learned: AttachedWeights::default(),
    };
    branch.check_document()?;
    Ok((branch, weights))
}

/// Trains a model's correction again, by the recipe in its document.
///
/// # Errors
/// Returns the errors of a first training.
pub fn retrain_correction(
    model: &Model,
    branch: &CorrectionDocument,
    law: &Law,
    trials: &[&Trial],
) -> Result<(CorrectionDocument, CorrectionWeights), TrainError> {
    let signals = |output: &CorrectionOutput| {
        (output.axis, output.inputs.iter().map(|input| input.signal).collect())
    };
    let training = CorrectionTraining {
        mode: branch.mode,
        inputs: branch.outputs.iter().map(signals).collect(),
        learner: branch.recipe.learner.clone(),
        seed: branch.recipe.seed,
        window_s: branch.recipe.window_s,
        hop_s: branch.recipe.hop_s,
        fade: branch.fade,
    };
    train_correction(model, law, trials, &training)
}

/// Region that the rows cover, without the outliers of single readings.
fn covered_region(rows: &[WindowRow], has_propeller: bool) -> Option<Region> {
    let column = |of: &dyn Fn(&WindowRow) -> f64| rows.iter().map(of).collect::<Vec<f64>>();
    let mut columns: BTreeMap<String, Vec<f64>> = ["u", "v", "r"]
        .into_iter()
        .enumerate()
        .map(|(axis, name)| (name.to_owned(), column(&|row| row.instant.velocities[axis])))
        .collect();
    columns.insert("delta".into(), column(&|row| row.instant.delta_rad));
    if has_propeller {
        columns.insert("n".into(), column(&|row| row.instant.n_rps));
    }
    Region::from_samples(&columns)
}

/// Returns the requested fade, or the largest of its multiples 0.9, 0.81, ... that keeps the
/// correction inside the physical range.
fn fade_within(domain: &Region, fade: f64, envelope: &MotionEnvelope) -> Option<f64> {
    std::iter::successors(Some(fade), |fade| Some(0.9 * fade))
        // The search ends at one hundredth of the requested fade.
        .take_while(|tried| *tried > 0.01 * fade)
        .find(|fade| FadedDomain::from_region(domain, *fade).is_some_and(|d| d.is_within(envelope)))
}

/// Trains the regressor of every output.
fn train_outputs(
    rows: &[WindowRow],
    training: &CorrectionTraining,
) -> Result<(Vec<CorrectionOutput>, CorrectionWeights), TrainError> {
    let (mut outputs, mut regressors) = (Vec::new(), Vec::new());
    for (place, (axis, signals)) in training.inputs.iter().enumerate() {
        // Scales are computed from the rows, then the sample is scaled by them.
        let output = scaled_output(rows, *axis, signals, &axis_targets(rows, *axis, training.mode));
        let sample = output_sample(rows, &output, training.mode);
        let learned =
            OutputRegressor::train_output(&training.learner, &sample, training.seed, place);
        regressors.push(learned.ok_or(TrainError::Singular(*axis))?);
        outputs.push(output);
    }
    Ok((outputs, CorrectionWeights { outputs: regressors }))
}

/// Inputs and targets of an output, in standard deviations.
pub(crate) fn output_sample(
    rows: &[WindowRow],
    output: &CorrectionOutput,
    mode: CorrectionMode,
) -> TrainingSample {
    let column =
        |input: &CorrectionInput| rows.iter().map(|r| scale_input(input, &r.instant)).collect();
    let targets = axis_targets(rows, output.axis, mode);
    TrainingSample {
        columns: output.inputs.iter().map(column).collect(),
        targets: targets.iter().map(|target| target / output.scale).collect(),
    }
}

/// Targets of an axis: the measured acceleration, less that of the foundation for a parallel
/// correction.
fn axis_targets(rows: &[WindowRow], axis: Axis, mode: CorrectionMode) -> Vec<f64> {
    let place = [Axis::X, Axis::Y, Axis::N].iter().position(|a| *a == axis).unwrap_or_default();
    let target = |row: &WindowRow| match mode {
        CorrectionMode::Parallel => row.measured[place] - row.instant.accelerations[place],
        CorrectionMode::Convert | CorrectionMode::Serial => row.measured[place],
    };
    rows.iter().map(target).collect()
}

/// Output with the scales of its inputs, and the scale and range of its targets.
fn scaled_output(
    rows: &[WindowRow],
    axis: Axis,
    signals: &[Signal],
    targets: &[f64],
) -> CorrectionOutput {
    let input = |signal: &Signal| {
        let values: Vec<f64> = rows.iter().map(|row| signal_value(*signal, &row.instant)).collect();
        let (centre, scale) = centre_and_scale(&values);
        CorrectionInput { signal: *signal, centre, scale }
    };
    let range =
        targets.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(*x), b.max(*x)]);
    let scale = centre_and_scale(targets).1;
    CorrectionOutput { axis, inputs: signals.iter().map(input).collect(), scale, range }
}
