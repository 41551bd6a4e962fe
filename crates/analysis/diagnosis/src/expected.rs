//! Expected information of a trial on coefficients and on effects' parameters, also before it is
//! carried out.
//!
//! The information is that of the filter by which trials are diagnosed: sums of products of its
//! whitened columns (Ljung 1999, System identification, 2nd edition, section 7.4: the information
//! of prediction errors). All other columns, terms that the law lacks and virtual masses, are
//! integrated out trial by trial, as if each trial had its own: the error of the law's form differs
//! between manoeuvres, and repeating one does not reveal it.

use std::sync::Arc;

use nalgebra::{Cholesky, DMatrix};
use rayon::prelude::*;
use sistership_identification::refine::RefineError;
use sistership_model::law::Law;
use sistership_model::{Effect, Model, Trial};

use super::calibrated_model::CalibratedModel;
use super::coefficient_prior::CoefficientPrior;
use super::evidence::not_positive_error;
use super::linearised_trials::LinearisedTrials;
use super::nuisance::{TermForms, learned_prior, learned_terms, model_columns, uncalibrated_prior};
use super::setup::listed_candidates;
use sistership_filtering::{
    AxisDiscrepancies, EffectCandidate, FilterColumns, GramMatrix, InstrumentNoise, NoiseLevel,
    NuisanceColumn, NuisanceKind, filter_part,
};

/// Unknowns that trials shall determine.
#[derive(Debug, Clone, Copy)]
pub struct TrialUnknowns<'a> {
    /// The model, without the effects that are unknown.
    pub model: &'a Model,
    /// Its law, without effects.
    pub law: &'a Law,
    /// Library of effects.
    pub library: &'a [Arc<Effect>],
    /// Names of unknown coefficients.
    pub coefficients: &'a [String],
    /// Forms of unknown effects, at the values at which their columns are tangents.
    pub effects: &'a [EffectCandidate],
    /// Relative error of a published coefficient, for a model without the uncertainty of its own
    /// trials.
    pub slack: f64,
    /// Random accelerations of such a model that no coefficient explains, by the typical ones
    /// (`U^2/L`, or `(U/L)^2`).
    pub discrepancy_level: f64,
}

/// Information of trials on unknowns.
pub struct ExpectedInformation<'a> {
    unknowns: TrialUnknowns<'a>,
    calibrated: CalibratedModel,
    columns: FilterColumns,
    /// Indices of the unknowns: coefficients, then parameters of effects.
    asked: Vec<usize>,
    /// Indices of all other free columns, and the prior information on them.
    others: Vec<usize>,
    known: DMatrix<f64>,
}

impl<'a> ExpectedInformation<'a> {
    /// Prepares the information for trials with the channels of the trial `like`.
    ///
    /// # Errors
    /// Returns an error that names a coefficient that the law does not have, or what the model does
    /// not provide.
    pub fn new(unknowns: TrialUnknowns<'a>, like: &Trial) -> Result<Self, RefineError> {
        let TrialUnknowns { model, law, library, .. } = unknowns;
        let terms = learned_terms(model, law, library, &[like]);
        let mut nuisance = model_columns(model, law);
        let known = unknowns_prior(&unknowns, &nuisance, &terms)?;
        // The first columns have a prior; coefficients that the model does not name are appended
        // without one.
        let still = nuisance.len();
        nuisance.extend(missing_coefficients(&unknowns, &nuisance)?);
        let shift = vec![0.0; nuisance.len()];
        let calibrated = CalibratedModel::new(model, law, &terms, &nuisance, &shift)?;
        let is_asked = |place: usize| unknowns.coefficients.contains(&nuisance[place].name);
        let others: Vec<usize> = (0..still).filter(|place| !is_asked(*place)).collect();
        let known = marginal_information(&known, &others).ok_or_else(not_positive_error)?;
        let columns = FilterColumns { nuisance, candidates: unknowns.effects.to_vec() };
        let place = |name: &String| columns.nuisance.iter().position(|n| n.name == *name);
        let asked = unknowns.coefficients.iter().filter_map(place);
        let asked = asked.chain(columns.nuisance.len()..columns.len()).collect();
        Ok(Self { unknowns, calibrated, columns, asked, others, known })
    }

    /// Returns the information of planned trials, unknowns by unknowns, recorded by given
    /// instruments.
    ///
    /// # Errors
    /// Returns an error that names what the model or a trial lacks.
    pub fn planned_information(
        &self,
        trials: &[&Trial],
        instruments: &InstrumentNoise,
    ) -> Result<Vec<DMatrix<f64>>, RefineError> {
        let instruments = self.with_known_drift(instruments);
        let columns = self.columns.clone();
        let ready =
            LinearisedTrials::planned_trials(&self.calibrated, columns, trials, &instruments)?;
        self.information_per_trial(&ready)
    }

    /// Returns the information of recorded trials, and the noise of their instruments.
    ///
    /// # Errors
    /// Returns an error that names what the model or a trial lacks.
    pub fn recorded_information(
        &self,
        trials: &[&Trial],
    ) -> Result<(Vec<DMatrix<f64>>, InstrumentNoise), RefineError> {
        let columns = self.columns.clone();
        let ready =
            LinearisedTrials::linearised_on_demand(&self.calibrated, columns, trials, None)?;
        Ok((self.information_per_trial(&ready)?, ready.noise.clone()))
    }

    fn information_per_trial(
        &self,
        ready: &LinearisedTrials<'_>,
    ) -> Result<Vec<DMatrix<f64>>, RefineError> {
        let discrepancies = self.unknown_discrepancies(ready);
        let of_trial = |trial: usize| {
            let parts = ready.parts_of_trial(trial)?;
            let grams: Vec<GramMatrix> = parts
                .iter()
                .map(|part| filter_part(part, &ready.noise, &discrepancies))
                .collect::<Result<_, _>>()?;
            let gram = GramMatrix::sum_parts(&grams, 1 + self.columns.len());
            self.information_on_unknowns(&gram).ok_or_else(not_positive_error)
        };
        (0..ready.trials.len()).into_par_iter().map(of_trial).collect()
    }

    /// Accelerations that no coefficient explains: those of the model's calibration, or those of
    /// the given level for a model without one.
    fn unknown_discrepancies(&self, ready: &LinearisedTrials<'_>) -> AxisDiscrepancies {
        let mut all = ready.motion_scales().level_discrepancies(self.unknowns.discrepancy_level);
        if let Some(uncertainty) = &self.unknowns.model.uncertainty {
            for (axis, own) in ready.axes().iter().zip(&mut all) {
                *own = uncertainty.discrepancy.get(axis).copied().unwrap_or(*own);
            }
        }
        all
    }

    /// Instruments with at least the drift of the model's calibration.
    fn with_known_drift(&self, instruments: &InstrumentNoise) -> InstrumentNoise {
        let known = self.unknowns.model.uncertainty.as_ref();
        let one = |(channel, own): (&_, &NoiseLevel)| {
            let fitted = known.and_then(|known| {
                let channel: &sistership_model::trial::Channel = channel;
                known.instruments.get(channel.name())
            });
            // The larger drift: planned instruments are assumed no better than the ship's own.
            let drift = fitted.map_or(own.drift, |fitted| own.drift.max(fitted.drift));
            (*channel, NoiseLevel { drift, ..*own })
        };
        instruments.iter().map(one).collect()
    }

    /// Information on the unknowns with all other columns integrated out: `G_aa - G_ao (G_oo +
    /// P)^-1 G_oa`.
    fn information_on_unknowns(&self, gram: &GramMatrix) -> Option<DMatrix<f64>> {
        let block = |rows: &[usize], columns: &[usize]| {
            DMatrix::from_fn(rows.len(), columns.len(), |i, j| {
                gram.products[(1 + rows[i], 1 + columns[j])]
            })
        };
        let (own, cross) = (block(&self.asked, &self.asked), block(&self.others, &self.asked));
        let others = Cholesky::new(block(&self.others, &self.others) + &self.known)?;
        Some(own - cross.transpose() * others.solve(&cross))
    }
}

/// Prior of all free columns.
fn unknowns_prior(
    unknowns: &TrialUnknowns<'_>,
    nuisance: &[NuisanceColumn],
    terms: &TermForms,
) -> Result<CoefficientPrior, RefineError> {
    match &unknowns.model.uncertainty {
        Some(uncertainty) => learned_prior(uncertainty),
        None => Ok(uncalibrated_prior(unknowns.model, nuisance, terms, unknowns.slack)),
    }
}

/// Unknown coefficients that the model's uncertainty does not name.
fn missing_coefficients(
    unknowns: &TrialUnknowns<'_>,
    nuisance: &[NuisanceColumn],
) -> Result<Vec<NuisanceColumn>, RefineError> {
    let there = |name: &&String| nuisance.iter().any(|own| own.name == **name);
    let one = |name: &String| {
        let axis = unknowns.law.unscaled_regressor(name).map(|(axis, _)| axis);
        let axis = axis.map_err(|_| {
            RefineError::Law(format!("law `{}` has no coefficient `{name}`", unknowns.law.name))
        })?;
        Ok(NuisanceColumn { name: name.clone(), kind: NuisanceKind::Own(axis) })
    };
    unknowns.coefficients.iter().filter(|name| !there(name)).map(one).collect()
}

/// Information on some columns alone, marginal over the others.
fn marginal_information(known: &CoefficientPrior, others: &[usize]) -> Option<DMatrix<f64>> {
    // Marginal information: the covariance of the selected columns, inverted again.
    let covariance = Cholesky::new(known.information.clone())?.inverse();
    let own =
        DMatrix::from_fn(others.len(), others.len(), |i, j| covariance[(others[i], others[j])]);
    Some(Cholesky::new(own)?.inverse())
}

/// Returns the forms of an effect that trials with certain channels can show: where a model carries
/// it, its own form at its values, otherwise all at its absence. Empty where the library does not
/// have it, or such trials do not show it.
pub fn observable_forms(
    effect: &str,
    model: &Model,
    law: &Law,
    library: &[Arc<Effect>],
    like: &Trial,
) -> Vec<EffectCandidate> {
    let carried = model.effects.iter().find(|own| own.name == effect);
    // Effects that a model carries are no candidates, so the list is made without them.
    let bare = Model { effects: Vec::new(), ..model.clone() };
    let forms = listed_candidates(&bare, law, library, &[like]).into_iter();
    let forms = forms.filter(|candidate| candidate.effect == effect);
    let Some(carried) = carried else { return forms.collect() };
    let at = |candidate: EffectCandidate| {
        let value = |name: &String| carried.parameters.get(name).map(|own| own.value);
        let at = candidate.form.parameters.keys().map(value).collect::<Option<_>>()?;
        Some(EffectCandidate { at, ..candidate })
    };
    forms.filter(|own| own.form.file.name == carried.form.name).filter_map(at).collect()
}
