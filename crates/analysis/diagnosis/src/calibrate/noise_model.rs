//! The discrepancies and instruments under which trials are most probable.

use rayon::prelude::*;
use sistership_model::trial::Channel;

use super::super::coefficient_prior::CoefficientPrior;
use super::super::evidence::not_positive;
use super::super::linearised_trials::LinearisedTrials;
use super::super::thresholds::THRESHOLDS;
use super::trial_information::{TrialInformation, shift};
use sistership_filtering::{Discrepancies, Linearised, Noise, deviances};
use sistership_identification::refine::RefineError;

/// What readings scatter by beside the model.
#[derive(Debug, Clone)]
pub(super) struct NoiseModel {
    pub discrepancies: Discrepancies,
    pub noise: Noise,
}

/// One number of it.
#[derive(Debug, Clone, Copy)]
enum NoiseParameter {
    Deviation(usize),
    White(usize),
    Noise(Channel),
    Drift(Channel),
}

impl NoiseModel {
    fn times(&self, number: NoiseParameter, factor: f64) -> Self {
        let mut changed = self.clone();
        let instrument = |noise: &mut Noise, channel| {
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

    fn numbers(&self) -> Vec<NoiseParameter> {
        let axes = 0..self.discrepancies.len();
        let of_axes =
            axes.flat_map(|axis| [NoiseParameter::Deviation(axis), NoiseParameter::White(axis)]);
        let follow = [Channel::Psi, Channel::X, Channel::Y];
        let drifts = follow
            .into_iter()
            .filter(|channel| self.noise.contains_key(channel))
            .map(NoiseParameter::Drift);
        of_axes.chain(drifts).chain(self.noise.keys().copied().map(NoiseParameter::Noise)).collect()
    }
}

/// The most probable scatter, coefficients and scatter being fitted in turn. Each trial is judged
/// by coefficients fitted on the others, so that what these have followed by chance is not taken
/// for knowledge.
///
/// # Errors
/// Says that the information is not positive.
pub(super) fn most_probable(
    workspace: &LinearisedTrials<'_>,
    fixed: &CoefficientPrior,
    (start, economical): (Option<NoiseModel>, bool),
) -> Result<NoiseModel, RefineError> {
    let rounds: &[[f64; 2]] = match economical {
        true => &THRESHOLDS.calibration.factors_economical,
        false => &THRESHOLDS.calibration.factors,
    };
    let first = if start.is_some() { rounds.len() - 1 } else { 0 };
    let mut best = match start {
        Some(start) => start,
        None => coarse(workspace)?,
    };
    for factors in &rounds[first..] {
        let coefficients = coefficients(workspace, fixed, &best)?.ok_or_else(not_positive)?;
        best = refined(workspace, best, &coefficients, factors)?;
    }
    Ok(best)
}

/// The best of a few levels of discrepancy, the same for all axes.
fn coarse(workspace: &LinearisedTrials<'_>) -> Result<NoiseModel, RefineError> {
    let as_it_is = vec![vec![0.0; workspace.columns().len()]; workspace.trials.len()];
    let (scales, parts) = (workspace.scales(), along(workspace, &as_it_is));
    let at = |level: &f64| NoiseModel {
        discrepancies: scales.discrepancies(*level),
        noise: workspace.noise.clone(),
    };
    let scored = |tried: NoiseModel| Ok((deviance(&parts, &tried)?, tried));
    let levels = THRESHOLDS.calibration.first_levels.iter();
    let all: Vec<Scored> = levels.map(at).map(scored).collect::<Result<_, RefineError>>()?;
    let best = all.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
    best.map(|(_, best)| best).ok_or_else(not_positive)
}

/// For each trial the coefficients by the others; of a single trial, by itself.
fn coefficients(
    workspace: &LinearisedTrials<'_>,
    fixed: &CoefficientPrior,
    scatter: &NoiseModel,
) -> Result<Option<Vec<Vec<f64>>>, RefineError> {
    let grams = workspace.coefficients_under(&scatter.noise, &scatter.discrepancies)?;
    let known = TrialInformation { fixed, grams: &grams, scatter: 1.0 };
    let others = if grams.len() == 1 { vec![known.all()] } else { known.but_one() };
    Ok(others.iter().map(|others| shift(others, workspace.columns().len())).collect())
}

/// Parts of trials with all columns in one.
type LinearisedParts = Vec<Vec<Linearised>>;

fn along(workspace: &LinearisedTrials<'_>, parameters: &[Vec<f64>]) -> LinearisedParts {
    let along = |(parts, of): (&Vec<Linearised>, &Vec<f64>)| {
        parts.iter().map(|part| part.along(of)).collect()
    };
    workspace.linear().par_iter().zip(parameters).map(along).collect()
}

/// Minus twice the logarithm of the likelihood.
fn deviance(parts: &LinearisedParts, scatter: &NoiseModel) -> Result<f64, RefineError> {
    let all: Vec<&Linearised> = parts.iter().flatten().collect();
    let mut each = deviances(&all, &scatter.noise, &scatter.discrepancies)?.into_iter();
    // Summed in order: the same on any number of threads.
    let trials = parts.iter().map(|parts| each.by_ref().take(parts.len()).sum::<f64>());
    Ok(trials.collect::<Vec<_>>().iter().sum())
}

/// Each number alone, as far as it helps.
fn refined(
    workspace: &LinearisedTrials<'_>,
    start: NoiseModel,
    coefficients: &[Vec<f64>],
    factors: &[f64],
) -> Result<NoiseModel, RefineError> {
    let parts = along(workspace, coefficients);
    let scored =
        |tried: NoiseModel, number: NoiseParameter| match is_possible(workspace, &tried, number) {
            true => Ok(Some((deviance(&parts, &tried)?, tried))),
            false => Ok(None),
        };
    let mut best = (deviance(&parts, &start)?, start);
    for factor in factors {
        for number in best.1.numbers() {
            best = multiplied(best, number, *factor, &scored)?;
        }
    }
    Ok(best.1)
}

/// A noise model with its deviance.
type Scored = (f64, NoiseModel);

/// One number multiplied by a factor, or divided by it, for as long as that helps. Both ways are
/// looked at together; where one has helped, the other leads back.
fn multiplied(
    best: Scored,
    number: NoiseParameter,
    factor: f64,
    scored: &(dyn Fn(NoiseModel, NoiseParameter) -> Result<Option<Scored>, RefineError> + Sync),
) -> Result<Scored, RefineError> {
    let better = |from: &Scored, by: f64| -> Result<Option<Scored>, RefineError> {
        let most = from.0 - THRESHOLDS.calibration.least_gain;
        // What is no number is no gain.
        let tried = scored(from.1.times(number, by), number)?;
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

/// No instrument errs by less than its readings scatter.
fn is_possible(
    workspace: &LinearisedTrials<'_>,
    tried: &NoiseModel,
    number: NoiseParameter,
) -> bool {
    let (NoiseParameter::Noise(channel) | NoiseParameter::Drift(channel)) = number else {
        return true;
    };
    let pair = workspace.noise.get(&channel).zip(tried.noise.get(&channel));
    let share = THRESHOLDS.calibration.scatter_share;
    pair.is_none_or(|(least, own)| {
        own.deviation >= share * least.deviation && own.drift >= share * least.drift
    })
}
