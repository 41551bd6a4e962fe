//! What the trials that a model was fitted on leave open.

mod false_alarm;
mod noise_model;
mod systematic_errors;
mod trial_information;

use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::{Cholesky, DMatrix, DVector};
use noise_model::NoiseModel;
use sistership_model::law::Law;
use sistership_model::trial::Channel;
use sistership_model::uncertainty::{Discrepancy, InstrumentFit, Uncertainty};
use sistership_model::{Effect, Model, Trial};
use trial_information::TrialInformation;

use super::calibrated_model::CalibratedModel;
use super::coefficient_prior::CoefficientPrior;
use super::evidence::not_positive;
use super::linearised_trials::LinearisedTrials;
use super::nuisance::{Terms, lacked, learned, prior, regressor};
use super::remainder::largest;
use super::setup::listed;
use super::thresholds::THRESHOLDS;
use crate::residual::{Columns, Discrepancies, EffectCandidate, Instrument, Noise, Nuisance};
use sistership_estimate::refine::RefineError;

/// What the trials that a model was fitted on leave open, to be kept with it. Terms of the
/// library's grammar that the model lacks are learned too, as far as those trials show them; and
/// what effects would explain of these trials, which do not have them, is kept to judge them by
/// later.
///
/// # Errors
/// Names the channel that a trial lacks, or says that the information is not positive.
pub fn calibrate(
    model: &Model,
    law: &Law,
    effects: &[Arc<Effect>],
    trials: &[&Trial],
) -> Result<Uncertainty, RefineError> {
    let model = &Model { uncertainty: None, ..model.clone() };
    let first = by_instruments(model, law, effects, trials)?;
    let systematic_errors = systematic_errors::of(model, &first, law, effects, trials)?;
    if systematic_errors.is_empty() {
        return Ok(first);
    }
    let erring = Uncertainty { systematic_errors, instruments: BTreeMap::new(), ..first };
    by_instruments(&Model { uncertainty: Some(erring), ..model.clone() }, law, effects, trials)
}

/// What the trials leave open where instruments err as the model's uncertainty says, or not at all.
fn by_instruments(
    model: &Model,
    law: &Law,
    effects: &[Arc<Effect>],
    trials: &[&Trial],
) -> Result<Uncertainty, RefineError> {
    let terms = learned(model, law, effects, trials);
    let extra: Vec<_> = terms
        .iter()
        .filter_map(|(name, form)| Some((name.clone(), regressor(model, form)?.0)))
        .collect();
    let nuisance = Columns::nuisance(model, law, &extra);
    let prior = prior(model, &nuisance, &terms, THRESHOLDS.calibration.prior_share);
    let (shift, rough) = first_shift(model, law, &terms, &nuisance, &prior, trials)?;
    let candidates = listed(model, law, effects, trials);
    let columns = Columns { nuisance: nuisance.clone(), candidates: candidates.clone() };
    let mut workspace = LinearisedTrials::new(
        &CalibratedModel::new(model, law, &terms, &nuisance, &shift)?,
        columns,
        trials,
        None,
    )?;
    let fixed = prior.from(&shift);
    let scatter = workspace.noise.clone();
    let NoiseModel { discrepancies, noise } =
        noise_model::most_probable(&workspace, &fixed, Some(rough))?;
    workspace.noise = noise;
    let grams = workspace.each(&discrepancies);
    let freed = lacked(model, law, effects, trials);
    let freed = freed.iter().map(|(effect, form)| EffectCandidate::absent(effect, form));
    let all: Vec<_> = candidates.into_iter().chain(freed).collect();
    let known = TrialInformation { fixed: &fixed, grams: &grams, scatter: 1.0 };
    let known = TrialInformation { scatter: known.scatter(), ..known };
    Ok(Uncertainty {
        instruments: instruments(&workspace.noise, &scatter),
        systematic_errors: model
            .uncertainty
            .as_ref()
            .map(|known| known.systematic_errors.clone())
            .unwrap_or_default(),
        false_alarm_levels: false_alarm::levels(&workspace, &known, &all),
        remainder: remainder(&workspace, &known, &discrepancies),
        ..uncertainty(&workspace, &known, &shift, &discrepancies)?
    })
}

/// What the trials teach by one linearisation about the model as it is, and the discrepancies by
/// that.
fn first_shift(
    model: &Model,
    law: &Law,
    terms: &Terms,
    nuisance: &[Nuisance],
    prior: &CoefficientPrior,
    trials: &[&Trial],
) -> Result<(Vec<f64>, NoiseModel), RefineError> {
    let columns = Columns { nuisance: nuisance.to_vec(), candidates: Vec::new() };
    let as_it_is = CalibratedModel::new(model, law, terms, nuisance, &vec![0.0; nuisance.len()])?;
    let mut workspace = LinearisedTrials::new(&as_it_is, columns, trials, None)?;
    let scatter = noise_model::most_probable(&workspace, prior, None)?;
    workspace.noise.clone_from(&scatter.noise);
    let grams = workspace.each(&scatter.discrepancies);
    let shift = TrialInformation { fixed: prior, grams: &grams, scatter: 1.0 }
        .by(&|_| true)
        .expected_shift(nuisance);
    Ok((shift.ok_or_else(not_positive)?, scatter))
}

/// Instruments by what their scatter alone says.
fn instruments(fitted: &Noise, scatter: &Noise) -> BTreeMap<String, InstrumentFit> {
    let one = |(channel, own): (&Channel, &Instrument)| {
        let deviation_by_scatter = own.deviation / scatter.get(channel)?.deviation;
        Some((channel.name().to_owned(), InstrumentFit { deviation_by_scatter, drift: own.drift }))
    };
    fitted.iter().filter_map(one).collect()
}

/// The largest remainder by channel, each trial under coefficients fitted on the others.
fn remainder(
    workspace: &LinearisedTrials<'_>,
    known: &TrialInformation<'_>,
    discrepancies: &Discrepancies,
) -> BTreeMap<String, f64> {
    let mut limits: BTreeMap<String, f64> = BTreeMap::new();
    for trial in 0..workspace.trials.len() {
        let Some(shift) = known.shift(trial, workspace.columns().len()) else { continue };
        for (channel, size) in largest(workspace, trial, discrepancies, &shift) {
            let limit = limits.entry(channel.name().to_owned()).or_default();
            *limit = limit.max(
                (THRESHOLDS.calibration.rounding * size).round() / THRESHOLDS.calibration.rounding,
            );
        }
    }
    limits
}

fn uncertainty(
    workspace: &LinearisedTrials<'_>,
    known: &TrialInformation<'_>,
    shift: &[f64],
    discrepancies: &Discrepancies,
) -> Result<Uncertainty, RefineError> {
    // From the model as it is, not as the trials have shifted it.
    let back: Vec<f64> = shift.iter().map(|shift| -shift).collect();
    let all = known.by(&|_| true).from(&back);
    let size = all.weighted_mean.len();
    let scales: Vec<f64> =
        (0..size).map(|i| known.fixed.information[(i, i)].sqrt().recip()).collect();
    let scaled =
        DMatrix::from_fn(size, size, |i, j| all.information[(i, j)] * scales[i] * scales[j]);
    let right = DVector::from_fn(size, |i, _| all.weighted_mean[i] * scales[i]);
    let factor = Cholesky::new(scaled).ok_or_else(not_positive)?;
    let lower = factor.l();
    let offset = lower.solve_lower_triangular(&right).unwrap_or(right);
    let axes = workspace.axes();
    let discrepancy: BTreeMap<_, Discrepancy> =
        axes.iter().copied().zip(discrepancies.iter().copied()).collect();
    Ok(Uncertainty {
        names: workspace.columns().nuisance.iter().map(|n: &Nuisance| n.name.clone()).collect(),
        scales,
        root_information: Uncertainty::rows(size, &|i, j| lower[(j, i)]),
        offset: offset.iter().copied().collect(),
        discrepancy,
        instruments: BTreeMap::new(),
        systematic_errors: Vec::new(),
        false_alarm_levels: BTreeMap::new(),
        remainder: BTreeMap::new(),
        trials: workspace.trials.iter().map(|trial| trial.name.clone()).collect(),
    })
}
