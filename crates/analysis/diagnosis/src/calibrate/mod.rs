//! What the trials that a model was fitted on leave open.

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
use representative::representative;
use sistership_model::law::Law;
use sistership_model::trial::Channel;
use sistership_model::uncertainty::{Discrepancy, InstrumentFit, Uncertainty};
use sistership_model::{Effect, Model, Trial};
use trial_information::{TrialInformation, shift};

use super::calibrated_model::CalibratedModel;
use super::coefficient_prior::CoefficientPrior;
use super::evidence::not_positive;
use super::linearised_trials::LinearisedTrials;
use super::nuisance::{Terms, lacked, learned, prior, regressor};
use super::remainder::largest;
use super::setup::listed;
use super::thresholds::THRESHOLDS;
use sistership_filtering::{
    Columns, Discrepancies, EffectCandidate, Gram, Instrument, Noise, Nuisance,
};
use sistership_identification::refine::RefineError;

/// What a model is calibrated with.
#[derive(Clone, Copy)]
struct Calibration<'a> {
    law: &'a Law,
    effects: &'a [Arc<Effect>],
    trials: &'a [&'a Trial],
    /// Those on which the noise model is learned.
    noise: &'a [&'a Trial],
    settings: CalibrationSettings,
    /// How far readings are apart on all of them, where that was asked for.
    reading_interval_s: Option<f64>,
}

/// How it is learned what trials leave open: by a refinement's settings of these names.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct CalibrationSettings {
    /// Samples of the trials on which the noise model is learned; all where absent.
    pub samples: Option<usize>,
    /// No more is computed than needed: the noise model is searched in two rounds, and instruments
    /// among the errors that seem to be there.
    pub economical: bool,
    /// Instruments that follow rates follow those that the filter expects.
    pub expected_rates: bool,
    /// How far readings are apart is asked of the samples as they were recorded, and kept.
    pub reading_interval: bool,
}

/// What the trials that a model was fitted on leave open, to be kept with it. Terms of the
/// library's grammar that the model lacks are learned too, as far as those trials show them; and
/// what effects would explain of these trials, which do not have them, is kept to judge them by
/// later.
///
/// Given a number of samples, the noise model, which is asked for again and again, is learned on
/// trials that have about so many between them and stand for all; each trial is then linearised
/// when its turn comes, and not kept.
///
/// # Errors
/// Names the channel that a trial lacks, or says that the information is not positive.
pub fn calibrate(
    model: &Model,
    law: &Law,
    effects: &[Arc<Effect>],
    trials: &[&Trial],
    settings: CalibrationSettings,
) -> Result<Uncertainty, RefineError> {
    let places = representative(trials, settings.samples.unwrap_or(usize::MAX));
    let noise: Vec<&Trial> = places.into_iter().map(|place| trials[place]).collect();
    let model = &Model { uncertainty: None, ..model.clone() };
    let reading_interval_s =
        settings.reading_interval.then(|| own_reading_interval_s(model, law, trials));
    let reading_interval_s = reading_interval_s.transpose()?;
    let calibration =
        Calibration { law, effects, trials, noise: &noise, settings, reading_interval_s };
    let learned = calibration.learn(model, None)?;
    let first = calibration.left_open(&learned)?;
    let systematic_errors =
        systematic_errors::of(model, &first, law, effects, (&noise, settings.economical))?;
    if systematic_errors.is_empty() {
        return calibration.judged(&learned);
    }
    let found = settings.economical.then_some(learned.found);
    let erring = Uncertainty { systematic_errors, instruments: BTreeMap::new(), ..first };
    let erring = Model { uncertainty: Some(erring), ..model.clone() };
    calibration.judged(&calibration.learn(&erring, found)?)
}

fn own_reading_interval_s(model: &Model, law: &Law, trials: &[&Trial]) -> Result<f64, RefineError> {
    let as_it_is = CalibratedModel::new(model, law, &Terms::new(), &[], &[])?;
    LinearisedTrials::own_reading_interval_s(&as_it_is, trials)
}

/// What is learned before it is asked what the trials leave open.
struct Learned<'a> {
    model: Model,
    /// The model where trials have shifted it to, and by how much.
    shifted: CalibratedModel,
    shift: Vec<f64>,
    nuisance: Vec<Nuisance>,
    fixed: CoefficientPrior,
    /// What instruments scatter by on the trials on which the noise model was learned.
    scatter: Noise,
    found: NoiseModel,
    /// All trials with all columns, and their products, where they are few enough to be kept.
    kept: Option<(LinearisedTrials<'a>, Vec<Gram>)>,
}

impl<'a> Calibration<'a> {
    /// Shift and noise where instruments err as the model's uncertainty says, or not at all; from
    /// the noise where they were said not to, where that has been learned.
    fn learn(&self, model: &Model, start: Option<NoiseModel>) -> Result<Learned<'a>, RefineError> {
        let &Self { law, effects, trials, noise, settings, reading_interval_s } = self;
        let economical = settings.economical;
        let terms = learned(model, law, effects, trials);
        let extra: Vec<_> = terms
            .iter()
            .filter_map(|(name, form)| Some((name.clone(), regressor(model, form)?.0)))
            .collect();
        let nuisance = Columns::nuisance(model, law, &extra);
        let prior = prior(model, &nuisance, &terms, THRESHOLDS.calibration.prior_share);
        let moved = |shift: &[f64]| -> Result<CalibratedModel, RefineError> {
            let moved = CalibratedModel::new(model, law, &terms, &nuisance, shift)?;
            Ok(CalibratedModel {
                expected_rates: settings.expected_rates,
                reading_interval_s,
                ..moved
            })
        };
        let as_it_is = moved(&vec![0.0; nuisance.len()])?;
        let (shift, rough) = first_shift(&as_it_is, &nuisance, &prior, (noise, start, economical))?;
        let fixed = prior.from(&shift);
        let shifted = moved(&shift)?;
        let all_at_once = noise.len() == trials.len();
        let columns = if all_at_once {
            self.whole(model, &nuisance)
        } else {
            Columns { nuisance: nuisance.clone(), candidates: Vec::new() }
        };
        let learned_on = LinearisedTrials::new(&shifted, columns, noise, None)?;
        let scatter = learned_on.noise.clone();
        let found = noise_model::most_probable(&learned_on, &fixed, (Some(rough), economical))?;
        let kept = all_at_once.then(|| -> Result<_, RefineError> {
            let kept = learned_on.under(&found.noise);
            let grams = kept.each(&found.discrepancies)?;
            Ok((kept, grams))
        });
        let kept = kept.transpose()?;
        let model = model.clone();
        Ok(Learned { model, shifted, shift, nuisance, fixed, scatter, found, kept })
    }

    /// Columns of coefficients and of all effects.
    fn whole(&self, model: &Model, nuisance: &[Nuisance]) -> Columns {
        let candidates = listed(model, self.law, self.effects, self.trials);
        Columns { nuisance: nuisance.to_vec(), candidates }
    }

    fn with_all_effects(&self, learned: &Learned<'_>) -> Result<LinearisedTrials<'a>, RefineError> {
        learned.one_at_a_time(self.whole(&learned.model, &learned.nuisance), self.trials)
    }

    /// With the coefficients' columns alone, for what is rounded: the last digits are others than
    /// with effects, whose equations stand in the tape at their absence.
    fn without_effects(
        &self,
        learned: &Learned<'_>,
        trials: &'a [&'a Trial],
    ) -> Result<LinearisedTrials<'a>, RefineError> {
        let columns = Columns { nuisance: learned.nuisance.clone(), candidates: Vec::new() };
        learned.one_at_a_time(columns, trials)
    }

    /// What the trials leave open of the coefficients; where no more is computed than needed, those
    /// of the noise model, on which alone instruments are asked.
    fn left_open(&self, learned: &Learned<'_>) -> Result<Uncertainty, RefineError> {
        let discrepancies = &learned.found.discrepancies;
        let of = |all: &LinearisedTrials<'_>, grams: &[Gram]| {
            uncertainty(all, &known(learned, grams), learned)
        };
        match &learned.kept {
            Some((all, grams)) => of(all, grams),
            None if self.settings.economical => {
                let all = self.without_effects(learned, self.noise)?;
                of(&all, &all.each(discrepancies)?)
            }
            None => {
                let all = self.with_all_effects(learned)?;
                of(&all, &all.coefficients_under(&all.noise, discrepancies)?)
            }
        }
    }

    /// The same, and what later diagnoses are to be judged by.
    fn judged(&self, learned: &Learned<'_>) -> Result<Uncertainty, RefineError> {
        let discrepancies = &learned.found.discrepancies;
        if let Some((all, grams)) = &learned.kept {
            let known = known(learned, grams);
            let but_one = known.but_one();
            let remainder = remainder(all, &but_one, discrepancies)?;
            return self.judged_by(learned, all, (&known, &but_one), remainder);
        }
        let all = self.with_all_effects(learned)?;
        let grams = all.each(discrepancies)?;
        let known = known(learned, &grams);
        let but_one = known.but_one();
        let remainder =
            remainder(&self.without_effects(learned, self.trials)?, &but_one, discrepancies)?;
        self.judged_by(learned, &all, (&known, &but_one), remainder)
    }

    fn judged_by(
        &self,
        learned: &Learned<'_>,
        all: &LinearisedTrials<'_>,
        (known, but_one): (&TrialInformation<'_>, &[CoefficientPrior]),
        remainder: BTreeMap<String, f64>,
    ) -> Result<Uncertainty, RefineError> {
        let model = &learned.model;
        let freed = lacked(model, self.law, self.effects, self.trials);
        let freed = freed.iter().map(|(effect, form)| EffectCandidate::absent(effect, form));
        let candidates: Vec<_> = all.columns().candidates.iter().cloned().chain(freed).collect();
        let errs = model.uncertainty.as_ref().map(|known| known.systematic_errors.clone());
        Ok(Uncertainty {
            systematic_errors: errs.unwrap_or_default(),
            false_alarm_levels: false_alarm::levels(all, (known, but_one), &candidates)?,
            remainder,
            ..uncertainty(all, known, learned)?
        })
    }
}

impl Learned<'_> {
    /// Trials under what was learned; each is linearised when it is asked for.
    fn one_at_a_time<'a>(
        &self,
        columns: Columns,
        trials: &'a [&'a Trial],
    ) -> Result<LinearisedTrials<'a>, RefineError> {
        let all = LinearisedTrials::one_at_a_time(&self.shifted, columns, trials, None)?;
        Ok(all.under(&self.found.noise))
    }
}

/// What the trials say, coefficients differing from trial to trial as they seem to.
fn known<'g>(learned: &'g Learned<'_>, grams: &'g [Gram]) -> TrialInformation<'g> {
    let known = TrialInformation { fixed: &learned.fixed, grams, scatter: 1.0 };
    TrialInformation { scatter: known.scatter(), ..known }
}

/// What the trials teach by one linearisation about the model as it is, and the discrepancies by
/// that.
fn first_shift(
    as_it_is: &CalibratedModel,
    nuisance: &[Nuisance],
    prior: &CoefficientPrior,
    (trials, start, economical): (&[&Trial], Option<NoiseModel>, bool),
) -> Result<(Vec<f64>, NoiseModel), RefineError> {
    let columns = Columns { nuisance: nuisance.to_vec(), candidates: Vec::new() };
    let mut workspace = LinearisedTrials::new(as_it_is, columns, trials, None)?;
    let scatter = noise_model::most_probable(&workspace, prior, (start, economical))?;
    workspace.noise.clone_from(&scatter.noise);
    let grams = workspace.each(&scatter.discrepancies)?;
    let shift = TrialInformation { fixed: prior, grams: &grams, scatter: 1.0 }
        .all()
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
    but_one: &[CoefficientPrior],
    discrepancies: &Discrepancies,
) -> Result<BTreeMap<String, f64>, RefineError> {
    let sizes = |trial: usize| {
        let Some(shift) = shift(&but_one[trial], workspace.columns().len()) else {
            return Ok(Vec::new());
        };
        largest(workspace, &workspace.parts(trial)?, discrepancies, &shift)
    };
    let sizes: Vec<Vec<(Channel, f64)>> = (0..workspace.trials.len())
        .into_par_iter()
        .map(sizes)
        .collect::<Result<_, RefineError>>()?;
    let mut limits: BTreeMap<String, f64> = BTreeMap::new();
    for (channel, size) in sizes.into_iter().flatten() {
        let limit = limits.entry(channel.name().to_owned()).or_default();
        let rounding = THRESHOLDS.calibration.rounding;
        *limit = limit.max((rounding * size).round() / rounding);
    }
    Ok(limits)
}

fn uncertainty(
    workspace: &LinearisedTrials<'_>,
    known: &TrialInformation<'_>,
    learned: &Learned<'_>,
) -> Result<Uncertainty, RefineError> {
    // From the model as it is, not as the trials have shifted it.
    let back: Vec<f64> = learned.shift.iter().map(|shift| -shift).collect();
    let all = known.all().from(&back);
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
        axes.iter().copied().zip(learned.found.discrepancies.iter().copied()).collect();
    Ok(Uncertainty {
        names: workspace.columns().nuisance.iter().map(|n: &Nuisance| n.name.clone()).collect(),
        scales,
        root_information: Uncertainty::rows(size, &|i, j| lower[(j, i)]),
        offset: offset.iter().copied().collect(),
        discrepancy,
        instruments: instruments(&workspace.noise, &learned.scatter),
        systematic_errors: Vec::new(),
        expected_rates: learned.shifted.expected_rates,
        reading_interval_s: learned.shifted.reading_interval_s,
        false_alarm_levels: BTreeMap::new(),
        remainder: BTreeMap::new(),
        trials: workspace.trials.iter().map(|trial| trial.name.clone()).collect(),
    })
}
