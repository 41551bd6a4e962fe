//! Calibration: the uncertainty that remains after the trials on which a model was fitted.

mod false_alarm;
mod noise_model;
mod representative;
mod systematic_errors;
mod trial_information;

use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::{Cholesky, DMatrix, DVector};
use noise_model::NoiseModel;
use rayon::prelude::*;
use representative::representative_trials;
use sistership_model::law::Law;
use sistership_model::trial::Channel;
use sistership_model::uncertainty::{Discrepancy, FalseAlarmLevel, InstrumentFit, Uncertainty};
use sistership_model::{Effect, Model, Trial};
use trial_information::{TrialInformation, expected_columns};

use super::calibrated_model::CalibratedModel;
use super::coefficient_prior::CoefficientPrior;
use super::evidence::not_positive_error;
use super::linearised_trials::LinearisedTrials;
use super::nuisance::{
    TermForms, learned_terms, missing_terms, term_regressor, uncalibrated_prior,
};
use super::patterns::PatternInformation;
use super::remainder::largest_per_channel;
use super::setup::listed_candidates;
use super::thresholds::THRESHOLDS;
use sistership_filtering::{
    AxisDiscrepancies, EffectCandidate, FilterColumns, GramMatrix, InstrumentNoise, NoiseLevel,
    NuisanceColumn,
};
use sistership_identification::refine::RefineError;

/// Inputs of a calibration.
#[derive(Clone, Copy)]
struct CalibrationInputs<'a> {
    law: &'a Law,
    effects: &'a [Arc<Effect>],
    trials: &'a [&'a Trial],
    /// Trials on which the noise model is learned.
    noise: &'a [&'a Trial],
    /// Least interval between independent readings on all trials, s.
    reading_interval_s: f64,
}

/// Determines the uncertainty that remains after the trials on which a model was fitted, to be
/// stored with it. Terms of the library's grammar that the model lacks are learned too, as far as
/// those trials show them; and the false-alarm levels of effects on these trials, which do not have
/// them, are stored for later judgements.
///
/// Given a number of `samples`, the noise model, which is evaluated repeatedly, is learned on
/// representative trials that have about so many samples together; each trial is then linearised
/// when it is needed, and not kept. Without one, it is learned on all trials.
///
/// # Errors
/// Returns an error that names the channel that a trial lacks, or one if the information is not
/// positive.
pub fn calibrate_model(
    model: &Model,
    law: &Law,
    effects: &[Arc<Effect>],
    trials: &[&Trial],
    samples: Option<usize>,
) -> Result<Uncertainty, RefineError> {
    let places = representative_trials(trials, samples.unwrap_or(usize::MAX));
    let noise: Vec<&Trial> = places.into_iter().map(|place| trials[place]).collect();
    // An earlier uncertainty belongs to other trials.
    let model = &Model { uncertainty: None, ..model.clone() };
    let reading_interval_s = trial_reading_interval_s(model, law, trials)?;
    let calibration = CalibrationInputs { law, effects, trials, noise: &noise, reading_interval_s };
    let learned = calibration.learn_noise_and_shift(model, None)?;
    let first = calibration.remaining_uncertainty(&learned)?;
    // Errors of instruments are searched under the first calibration; where there are some,
    // everything is learned again with them.
    let systematic_errors =
        systematic_errors::find_systematic_errors(model, &first, law, effects, &noise)?;
    if systematic_errors.is_empty() {
        return calibration.judged_uncertainty(&learned);
    }
    // The second calibration starts from the noise model of the first one.
    let found = Some(learned.found);
    let erring = Uncertainty { systematic_errors, instruments: BTreeMap::new(), ..first };
    let erring = Model { uncertainty: Some(erring), ..model.clone() };
    calibration.judged_uncertainty(&calibration.learn_noise_and_shift(&erring, found)?)
}

fn trial_reading_interval_s(
    model: &Model,
    law: &Law,
    trials: &[&Trial],
) -> Result<f64, RefineError> {
    let as_it_is = CalibratedModel::new(model, law, &TermForms::new(), &[], &[])?;
    LinearisedTrials::independent_interval_s(&as_it_is, trials)
}

/// Results of learning on the trials, before the uncertainty is determined.
struct LearnedCalibration<'a> {
    model: Model,
    /// The model with the coefficients shifted by the trials, and the shift.
    shifted: CalibratedModel,
    shift: Vec<f64>,
    nuisance: Vec<NuisanceColumn>,
    fixed: CoefficientPrior,
    /// Noise of the instruments on the trials on which the noise model was learned.
    scatter: InstrumentNoise,
    found: NoiseModel,
    /// Least interval between independent readings, s.
    reading_interval_s: f64,
    /// All trials with all columns, and their products, where they are few enough to be kept.
    kept: Option<(LinearisedTrials<'a>, Vec<GramMatrix>)>,
}

impl<'a> CalibrationInputs<'a> {
    /// Learns shift and noise, with the systematic errors of the model's uncertainty if it has any;
    /// starts from a noise model that was learned without them, if given.
    fn learn_noise_and_shift(
        &self,
        model: &Model,
        start: Option<NoiseModel>,
    ) -> Result<LearnedCalibration<'a>, RefineError> {
        let &Self { law, effects, trials, noise, reading_interval_s } = self;
        let terms = learned_terms(model, law, effects, trials);
        // Only terms with a regressor in this model can be columns.
        let extra: Vec<_> = terms
            .iter()
            .filter_map(|(name, form)| Some((name.clone(), term_regressor(model, form)?.0)))
            .collect();
        let nuisance = FilterColumns::nuisance_columns(model, law, &extra);
        let prior =
            uncalibrated_prior(model, &nuisance, &terms, THRESHOLDS.calibration.prior_share);
        let moved = |shift: &[f64]| -> Result<CalibratedModel, RefineError> {
            let moved = CalibratedModel::new(model, law, &terms, &nuisance, shift)?;
            Ok(CalibratedModel {
                expected_rates: true,
                reading_interval_s: Some(reading_interval_s),
                ..moved
            })
        };
        // The first shift is found about the given model; the noise is then learned about the
        // shifted one.
        let as_it_is = moved(&vec![0.0; nuisance.len()])?;
        let (shift, rough) = first_shift(&as_it_is, &nuisance, &prior, (noise, start))?;
        let fixed = prior.relative_to(&shift);
        let shifted = moved(&shift)?;
        let all_at_once = noise.len() == trials.len();
        // Columns of all effects are needed later only if these trials are kept.
        let columns = if all_at_once {
            self.all_columns(model, &nuisance)
        } else {
            FilterColumns { nuisance: nuisance.clone(), candidates: Vec::new() }
        };
        let learned_on = LinearisedTrials::new(&shifted, columns, noise, None)?;
        // Noise by the readings alone, before the most probable one replaces it.
        let scatter = learned_on.noise.clone();
        let found = noise_model::most_probable_noise(&learned_on, &fixed, Some(rough))?;
        // Linearisations are kept only if all trials are used for the noise model.
        let kept = all_at_once.then(|| -> Result<_, RefineError> {
            let kept = learned_on.with_noise(&found.noise);
            let grams = kept.products_per_trial(&found.discrepancies)?;
            Ok((kept, grams))
        });
        let kept = kept.transpose()?;
        let model = model.clone();
        Ok(LearnedCalibration {
            model,
            shifted,
            shift,
            nuisance,
            fixed,
            scatter,
            found,
            reading_interval_s,
            kept,
        })
    }

    /// Columns of coefficients and of all effects.
    fn all_columns(&self, model: &Model, nuisance: &[NuisanceColumn]) -> FilterColumns {
        let candidates = listed_candidates(model, self.law, self.effects, self.trials);
        FilterColumns { nuisance: nuisance.to_vec(), candidates }
    }

    fn with_all_effects(
        &self,
        learned: &LearnedCalibration<'_>,
    ) -> Result<LinearisedTrials<'a>, RefineError> {
        learned.one_at_a_time(self.all_columns(&learned.model, &learned.nuisance), self.trials)
    }

    /// Trials with the columns of coefficients alone, for values that are rounded: with the columns
    /// of effects, whose equations are part of the tape also at their absence, the last digits
    /// differ.
    fn without_effects(
        &self,
        learned: &LearnedCalibration<'_>,
        trials: &'a [&'a Trial],
    ) -> Result<LinearisedTrials<'a>, RefineError> {
        let columns = FilterColumns { nuisance: learned.nuisance.clone(), candidates: Vec::new() };
        learned.one_at_a_time(columns, trials)
    }

    /// Uncertainty of the coefficients after the trials of the noise model, on which alone
    /// systematic errors are searched.
    fn remaining_uncertainty(
        &self,
        learned: &LearnedCalibration<'_>,
    ) -> Result<Uncertainty, RefineError> {
        let discrepancies = &learned.found.discrepancies;
        let of = |all: &LinearisedTrials<'_>, grams: &[GramMatrix]| {
            root_uncertainty(all, &scaled_information(learned, grams), learned)
        };
        match &learned.kept {
            Some((all, grams)) => of(all, grams),
            None => {
                let all = self.without_effects(learned, self.noise)?;
                of(&all, &all.products_per_trial(discrepancies)?)
            }
        }
    }

    /// Uncertainty of the coefficients, with false-alarm levels and remainders for the judgement of
    /// later diagnoses.
    fn judged_uncertainty(
        &self,
        learned: &LearnedCalibration<'_>,
    ) -> Result<Uncertainty, RefineError> {
        let discrepancies = &learned.found.discrepancies;
        if let Some((all, grams)) = &learned.kept {
            let known = scaled_information(learned, grams);
            let but_one = known.leave_one_out();
            let remainder = largest_remainders(all, &but_one, discrepancies)?;
            return self.uncertainty_with_levels(learned, all, (&known, &but_one), remainder);
        }
        let all = self.with_all_effects(learned)?;
        let grams = all.products_per_trial(discrepancies)?;
        let known = scaled_information(learned, &grams);
        let but_one = known.leave_one_out();
        // The remainder is rounded and stored, so it is computed without the columns of effects.
        let remainder = largest_remainders(
            &self.without_effects(learned, self.trials)?,
            &but_one,
            discrepancies,
        )?;
        self.uncertainty_with_levels(learned, &all, (&known, &but_one), remainder)
    }

    fn uncertainty_with_levels(
        &self,
        learned: &LearnedCalibration<'_>,
        all: &LinearisedTrials<'_>,
        (known, but_one): (&TrialInformation<'_>, &[CoefficientPrior]),
        remainder: BTreeMap<String, f64>,
    ) -> Result<Uncertainty, RefineError> {
        let model = &learned.model;
        // Terms that free a coefficient have a false-alarm level too, without a column of their
        // own.
        let freed = missing_terms(model, self.law, self.effects, self.trials);
        let freed = freed.iter().map(|(effect, form)| EffectCandidate::at_absence(effect, form));
        let candidates: Vec<_> = all.columns().candidates.iter().cloned().chain(freed).collect();
        // The learned errors of instruments are part of the model here, and are stored with its
        // uncertainty.
        let errs = model.uncertainty.as_ref().map(|known| known.systematic_errors.clone());
        let mut levels = false_alarm::false_alarm_levels(all, (known, but_one), &candidates)?;
        levels.extend(self.pattern_levels(learned, but_one)?);
        Ok(Uncertainty {
            systematic_errors: errs.unwrap_or_default(),
            false_alarm_levels: levels,
            remainder,
            ..root_uncertainty(all, known, learned)?
        })
    }

    /// False-alarm levels of the patterns of remainders.
    fn pattern_levels(
        &self,
        learned: &LearnedCalibration<'_>,
        but_one: &[CoefficientPrior],
    ) -> Result<BTreeMap<String, FalseAlarmLevel>, RefineError> {
        // Each trial under coefficients fitted on the others: its own would explain a part of the
        // pattern.
        let all = self.without_effects(learned, self.trials)?;
        let discrepancies = &learned.found.discrepancies;
        Ok(PatternInformation::new(&all, discrepancies, &[], (but_one, None))?.clean_levels(&all))
    }
}

impl LearnedCalibration<'_> {
    /// Trials under the learned noise; each is linearised when it is needed.
    fn one_at_a_time<'a>(
        &self,
        columns: FilterColumns,
        trials: &'a [&'a Trial],
    ) -> Result<LinearisedTrials<'a>, RefineError> {
        let all = LinearisedTrials::linearised_on_demand(&self.shifted, columns, trials, None)?;
        Ok(all.with_noise(&self.found.noise))
    }
}

/// Information of the trials, with the scatter of coefficients between trials that they show.
fn scaled_information<'g>(
    learned: &'g LearnedCalibration<'_>,
    grams: &'g [GramMatrix],
) -> TrialInformation<'g> {
    // A ratio of one first, from which the actual one is determined.
    let known = TrialInformation { fixed: &learned.fixed, grams, scatter: 1.0 };
    TrialInformation { scatter: known.variance_ratio(), ..known }
}

/// Shift of the coefficients by one linearisation about the given model, and the noise model of
/// that linearisation.
fn first_shift(
    as_it_is: &CalibratedModel,
    nuisance: &[NuisanceColumn],
    prior: &CoefficientPrior,
    (trials, start): (&[&Trial], Option<NoiseModel>),
) -> Result<(Vec<f64>, NoiseModel), RefineError> {
    let columns = FilterColumns { nuisance: nuisance.to_vec(), candidates: Vec::new() };
    let mut workspace = LinearisedTrials::new(as_it_is, columns, trials, None)?;
    let scatter = noise_model::most_probable_noise(&workspace, prior, start)?;
    workspace.noise.clone_from(&scatter.noise);
    let grams = workspace.products_per_trial(&scatter.discrepancies)?;
    let shift = TrialInformation { fixed: prior, grams: &grams, scatter: 1.0 }
        .total_information()
        .expected_shift(nuisance);
    Ok((shift.ok_or_else(not_positive_error)?, scatter))
}

/// Instruments relative to the noise of their readings alone.
fn instrument_fits(
    fitted: &InstrumentNoise,
    scatter: &InstrumentNoise,
) -> BTreeMap<String, InstrumentFit> {
    let one = |(channel, own): (&Channel, &NoiseLevel)| {
        let deviation_by_scatter = own.deviation / scatter.get(channel)?.deviation;
        Some((channel.name().to_owned(), InstrumentFit { deviation_by_scatter, drift: own.drift }))
    };
    fitted.iter().filter_map(one).collect()
}

/// Largest remainder of each channel, each trial under coefficients fitted on the others.
fn largest_remainders(
    workspace: &LinearisedTrials<'_>,
    but_one: &[CoefficientPrior],
    discrepancies: &AxisDiscrepancies,
) -> Result<BTreeMap<String, f64>, RefineError> {
    let sizes = |trial: usize| {
        let Some(shift) = expected_columns(&but_one[trial], workspace.columns().len()) else {
            return Ok(Vec::new());
        };
        largest_per_channel(workspace, &workspace.parts_of_trial(trial)?, discrepancies, &shift)
    };
    let sizes: Vec<Vec<(Channel, f64)>> = (0..workspace.trials.len())
        .into_par_iter()
        .map(sizes)
        .collect::<Result<_, RefineError>>()?;
    // The largest over all trials, rounded so that a version does not depend on last digits.
    let mut limits: BTreeMap<String, f64> = BTreeMap::new();
    for (channel, size) in sizes.into_iter().flatten() {
        let limit = limits.entry(channel.name().to_owned()).or_default();
        let rounding = THRESHOLDS.calibration.rounding;
        *limit = limit.max((rounding * size).round() / rounding);
    }
    Ok(limits)
}

fn root_uncertainty(
    workspace: &LinearisedTrials<'_>,
    known: &TrialInformation<'_>,
    learned: &LearnedCalibration<'_>,
) -> Result<Uncertainty, RefineError> {
    // Relative to the given model, not to the shifted one.
    let back: Vec<f64> = learned.shift.iter().map(|shift| -shift).collect();
    let all = known.total_information().relative_to(&back);
    let size = all.weighted_mean.len();
    // Scaled by the prior's standard deviations: coefficients differ by orders of magnitude.
    let scales: Vec<f64> =
        (0..size).map(|i| known.fixed.information[(i, i)].sqrt().recip()).collect();
    let scaled =
        DMatrix::from_fn(size, size, |i, j| all.information[(i, j)] * scales[i] * scales[j]);
    let right = DVector::from_fn(size, |i, _| all.weighted_mean[i] * scales[i]);
    let factor = Cholesky::new(scaled).ok_or_else(not_positive_error)?;
    let lower = factor.l();
    // The offset L^-1 b, with which the scaled mean is L'^-1 times the offset.
    let offset = lower.solve_lower_triangular(&right).unwrap_or(right);
    let axes = workspace.axes();
    let discrepancy: BTreeMap<_, Discrepancy> =
        axes.iter().copied().zip(learned.found.discrepancies.iter().copied()).collect();
    Ok(Uncertainty {
        names: workspace
            .columns()
            .nuisance
            .iter()
            .map(|n: &NuisanceColumn| n.name.clone())
            .collect(),
        scales,
        root_information: Uncertainty::format_rows(size, &|i, j| lower[(j, i)]),
        offset: offset.iter().copied().collect(),
        discrepancy,
        instruments: instrument_fits(&workspace.noise, &learned.scatter),
        systematic_errors: Vec::new(),
        reading_interval_s: learned.reading_interval_s,
        false_alarm_levels: BTreeMap::new(),
        remainder: BTreeMap::new(),
        trials: workspace.trials.iter().map(|trial| trial.name.clone()).collect(),
    })
}
