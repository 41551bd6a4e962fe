//! Discrepancies and instruments under which trials are most probable.

use rayon::prelude::*;
use sistership_model::trial::Channel;

use super::super::coefficient_prior::CoefficientPrior;
use super::super::evidence::not_positive_error;
use super::super::linearised_trials::LinearisedTrials;
use super::super::thresholds::THRESHOLDS;
use super::trial_information::{TrialInformation, expected_columns};
use sistership_filtering::{AxisDiscrepancies, InstrumentNoise, LinearisedPart, part_deviances};
use sistership_identification::refine::RefineError;

/// Discrepancies of accelerations and noise of instruments.
#[derive(Debug, Clone)]
pub(super) struct NoiseModel {
    pub discrepancies: AxisDiscrepancies,
    pub noise: InstrumentNoise,
}

/// One parameter of a noise model.
#[derive(Debug, Clone, Copy)]
enum NoiseParameter {
    Deviation(usize),
    White(usize),
    Noise(Channel),
    Drift(Channel),
}

impl NoiseModel {
    fn with_scaled_parameter(&self, number: NoiseParameter, factor: f64) -> Self {
        let mut changed = self.clone();
        let instrument = |noise: &mut InstrumentNoise, channel| {
            noise.remove(&channel).map(|instrument| (channel, instrument))
        };
        match number {
            NoiseParameter::Deviation(axis) => changed.discrepancies[axis].deviation *= factor,
            NoiseParameter::White(axis) => changed.discrepancies[axis].white *= factor,
            NoiseParameter::Noise(channel) => {
                if let Some((channel, mut own)) = instrument(&mut changed.noise, channel) {
                    own.deviation *= factor;
                    changed.noise.insert(channel, own);
                }
            }
            NoiseParameter::Drift(channel) => {
                if let Some((channel, mut own)) = instrument(&mut changed.noise, channel) {
                    own.drift *= factor;
                    changed.noise.insert(channel, own);
                }
            }
        }
        changed
    }

    fn parameter_list(&self) -> Vec<NoiseParameter> {
        let axes = 0..self.discrepancies.len();
        let of_axes =
            axes.flat_map(|axis| [NoiseParameter::Deviation(axis), NoiseParameter::White(axis)]);
        // Only headings and positions follow velocities, so only they have a drift.
        let follow = [Channel::Psi, Channel::X, Channel::Y];
        let drifts = follow
            .into_iter()
            .filter(|channel| self.noise.contains_key(channel))
            .map(NoiseParameter::Drift);
        of_axes.chain(drifts).chain(self.noise.keys().copied().map(NoiseParameter::Noise)).collect()
    }
}

/// Returns the most probable noise model; coefficients and noise are fitted in turn. Each trial is
/// evaluated with coefficients fitted on the others, so that their chance fit does not reduce the
/// noise.
///
/// # Errors
/// Returns an error if the information is not positive.
pub(super) fn most_probable_noise(
    workspace: &LinearisedTrials<'_>,
    fixed: &CoefficientPrior,
    start: Option<NoiseModel>,
) -> Result<NoiseModel, RefineError> {
    let rounds = &THRESHOLDS.calibration.factors;
    // A given start replaces the coarse round; only the last, finest one is needed.
    let first = if start.is_some() { rounds.len() - 1 } else { 0 };
    let mut best = match start {
        Some(start) => start,
        None => coarse_noise_model(workspace)?,
    };
    for factors in &rounds[first..] {
        let coefficients =
            coefficients_per_trial(workspace, fixed, &best)?.ok_or_else(not_positive_error)?;
        best = refine_noise_model(workspace, best, &coefficients, factors)?;
    }
    Ok(best)
}

/// Best of a few levels of discrepancy, the same for all axes.
fn coarse_noise_model(workspace: &LinearisedTrials<'_>) -> Result<NoiseModel, RefineError> {
    // Coefficients are not shifted yet: the first level needs no fit.
    let as_it_is = vec![vec![0.0; workspace.columns().len()]; workspace.trials.len()];
    let (scales, parts) = (workspace.motion_scales(), combine_parts(workspace, &as_it_is));
    let at = |level: &f64| NoiseModel {
        discrepancies: scales.level_discrepancies(*level),
        noise: workspace.noise.clone(),
    };
    let scored = |tried: NoiseModel| Ok((total_deviance(&parts, &tried)?, tried));
    let levels = THRESHOLDS.calibration.first_levels.iter();
    let all: Vec<ScoredNoiseModel> =
        levels.map(at).map(scored).collect::<Result<_, RefineError>>()?;
    let best = all.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
    best.map(|(_, best)| best).ok_or_else(not_positive_error)
}

/// Coefficients of each trial by the others; those of a single trial, by itself.
fn coefficients_per_trial(
    workspace: &LinearisedTrials<'_>,
    fixed: &CoefficientPrior,
    scatter: &NoiseModel,
) -> Result<Option<Vec<Vec<f64>>>, RefineError> {
    let grams = workspace.coefficient_products_under(&scatter.noise, &scatter.discrepancies)?;
    let known = TrialInformation { fixed, grams: &grams, scatter: 1.0 };
    let others =
        if grams.len() == 1 { vec![known.total_information()] } else { known.leave_one_out() };
    Ok(others.iter().map(|others| expected_columns(others, workspace.columns().len())).collect())
}

/// Parts of trials with all columns combined into one.
type LinearisedParts = Vec<Vec<LinearisedPart>>;

fn combine_parts(workspace: &LinearisedTrials<'_>, parameters: &[Vec<f64>]) -> LinearisedParts {
    let along = |(parts, of): (&Vec<LinearisedPart>, &Vec<f64>)| {
        parts.iter().map(|part| part.combine_columns(of)).collect()
    };
    workspace.linearised_parts().par_iter().zip(parameters).map(along).collect()
}

/// Minus twice the logarithm of the likelihood.
fn total_deviance(parts: &LinearisedParts, scatter: &NoiseModel) -> Result<f64, RefineError> {
    let all: Vec<&LinearisedPart> = parts.iter().flatten().collect();
    let mut each = part_deviances(&all, &scatter.noise, &scatter.discrepancies)?.into_iter();
    // Summed in order: the same on any number of threads.
    let trials = parts.iter().map(|parts| each.by_ref().take(parts.len()).sum::<f64>());
    Ok(trials.collect::<Vec<_>>().iter().sum())
}

/// Improves each parameter alone while the deviance falls.
fn refine_noise_model(
    workspace: &LinearisedTrials<'_>,
    start: NoiseModel,
    coefficients: &[Vec<f64>],
    factors: &[f64],
) -> Result<NoiseModel, RefineError> {
    let parts = combine_parts(workspace, coefficients);
    let scored =
        |tried: NoiseModel, number: NoiseParameter| match is_possible(workspace, &tried, number) {
            true => Ok(Some((total_deviance(&parts, &tried)?, tried))),
            false => Ok(None),
        };
    let mut best = (total_deviance(&parts, &start)?, start);
    // Coordinate descent: coarse factors first, every parameter in turn.
    for factor in factors {
        for number in best.1.parameter_list() {
            best = descend_parameter(best, number, *factor, &scored)?;
        }
    }
    Ok(best.1)
}

/// A noise model with its deviance.
type ScoredNoiseModel = (f64, NoiseModel);

/// Multiplies or divides one parameter by a factor while that improves the deviance. Both
/// directions are evaluated together; after a step in one direction, the other would lead back.
fn descend_parameter(
    best: ScoredNoiseModel,
    number: NoiseParameter,
    factor: f64,
    scored: &(
         dyn Fn(NoiseModel, NoiseParameter) -> Result<Option<ScoredNoiseModel>, RefineError> + Sync
     ),
) -> Result<ScoredNoiseModel, RefineError> {
    let better =
        |from: &ScoredNoiseModel, by: f64| -> Result<Option<ScoredNoiseModel>, RefineError> {
            let most = from.0 - THRESHOLDS.calibration.least_gain;
            // A deviance that is not a number fails the comparison.
            let tried = scored(from.1.with_scaled_parameter(number, by), number)?;
            Ok(tried.filter(|(deviance, _)| *deviance <= most))
        };
    let (more, less) = rayon::join(|| better(&best, factor), || better(&best, factor.recip()));
    let (by, mut best) = match (more?, less?) {
        (Some(more), _) => (factor, more),
        (None, Some(less)) => (factor.recip(), less),
        (None, None) => return Ok(best),
    };
    while let Some(next) = better(&best, by)? {
        best = next;
    }
    Ok(best)
}

/// Returns true if the noise of an instrument is not below the noise of its readings alone.
fn is_possible(
    workspace: &LinearisedTrials<'_>,
    tried: &NoiseModel,
    number: NoiseParameter,
) -> bool {
    let (NoiseParameter::Noise(channel) | NoiseParameter::Drift(channel)) = number else {
        return true;
    };
    let pair = workspace.noise.get(&channel).zip(tried.noise.get(&channel));
    // The noise of the readings alone is the lower limit.
    let share = THRESHOLDS.calibration.scatter_share;
    pair.is_none_or(|(least, own)| {
        own.deviation >= share * least.deviation && own.drift >= share * least.drift
    })
}
