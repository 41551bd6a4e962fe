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
use super::evidence::not_positive;
use super::linearised_trials::LinearisedTrials;
use super::nuisance::{Terms, columns, learned, learned_prior, prior};
use super::setup::listed;
use sistership_filtering::{
    Columns, Discrepancies, EffectCandidate, Gram, Instrument, Noise, Nuisance, NuisanceKind,
    filter,
};

/// Unknowns that trials shall determine.
#[derive(Debug, Clone, Copy)]
pub struct Unknowns<'a> {
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
    unknowns: Unknowns<'a>,
    calibrated: CalibratedModel,
    columns: Columns,
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
    pub fn new(unknowns: Unknowns<'a>, like: &Trial) -> Result<Self, RefineError> {
        let Unknowns { model, law, library, .. } = unknowns;
        let terms = learned(model, law, library, &[like]);
        let mut nuisance = columns(model, law);
        let known = known(&unknowns, &nuisance, &terms)?;
        // The first columns have a prior; coefficients that the model does not name are appended
        // without one.
        let still = nuisance.len();
        nuisance.extend(missing(&unknowns, &nuisance)?);
        let shift = vec![0.0; nuisance.len()];
        let calibrated = CalibratedModel::new(model, law, &terms, &nuisance, &shift)?;
        let is_asked = |place: usize| unknowns.coefficients.contains(&nuisance[place].name);
        let others: Vec<usize> = (0..still).filter(|place| !is_asked(*place)).collect();
        let known = of_others(&known, &others).ok_or_else(not_positive)?;
        let columns = Columns { nuisance, candidates: unknowns.effects.to_vec() };
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
    pub fn planned(
        &self,
        trials: &[&Trial],
        instruments: &Noise,
    ) -> Result<Vec<DMatrix<f64>>, RefineError> {
        let instruments = self.drifting(instruments);
        let columns = self.columns.clone();
        let ready = LinearisedTrials::planned(&self.calibrated, columns, trials, &instruments)?;
        self.each(&ready)
    }

    /// Returns the information of recorded trials, and the noise of their instruments.
    ///
    /// # Errors
    /// Returns an error that names what the model or a trial lacks.
    pub fn sailed(&self, trials: &[&Trial]) -> Result<(Vec<DMatrix<f64>>, Noise), RefineError> {
        let columns = self.columns.clone();
        let ready = LinearisedTrials::one_at_a_time(&self.calibrated, columns, trials, None)?;
        Ok((self.each(&ready)?, ready.noise.clone()))
    }

    fn each(&self, ready: &LinearisedTrials<'_>) -> Result<Vec<DMatrix<f64>>, RefineError> {
        let discrepancies = self.discrepancies(ready);
        let of_trial = |trial: usize| {
            let parts = ready.parts(trial)?;
            let grams: Vec<Gram> = parts
                .iter()
                .map(|part| filter(part, &ready.noise, &discrepancies))
                .collect::<Result<_, _>>()?;
            let gram = Gram::sum(&grams, 1 + self.columns.len());
            self.of_asked(&gram).ok_or_else(not_positive)
        };
        (0..ready.trials.len()).into_par_iter().map(of_trial).collect()
    }

    /// Accelerations that no coefficient explains: those of the model's calibration, or those of
    /// the given level for a model without one.
    fn discrepancies(&self, ready: &LinearisedTrials<'_>) -> Discrepancies {
        let mut all = ready.scales().discrepancies(self.unknowns.discrepancy_level);
        if let Some(uncertainty) = &self.unknowns.model.uncertainty {
            for (axis, own) in ready.axes().iter().zip(&mut all) {
                *own = uncertainty.discrepancy.get(axis).copied().unwrap_or(*own);
            }
        }
        all
    }

    /// Instruments with at least the drift of the model's calibration.
    fn drifting(&self, instruments: &Noise) -> Noise {
        let known = self.unknowns.model.uncertainty.as_ref();
        let one = |(channel, own): (&_, &Instrument)| {
            let fitted = known.and_then(|known| {
                let channel: &sistership_model::trial::Channel = channel;
                known.instruments.get(channel.name())
            });
            // The larger drift: planned instruments are assumed no better than the ship's own.
            let drift = fitted.map_or(own.drift, |fitted| own.drift.max(fitted.drift));
            (*channel, Instrument { drift, ..*own })
        };
        instruments.iter().map(one).collect()
    }

    /// Information on the unknowns with all other columns integrated out: `G_aa - G_ao (G_oo +
    /// P)^-1 G_oa`.
    fn of_asked(&self, gram: &Gram) -> Option<DMatrix<f64>> {
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
fn known(
    unknowns: &Unknowns<'_>,
    nuisance: &[Nuisance],
    terms: &Terms,
) -> Result<CoefficientPrior, RefineError> {
    match &unknowns.model.uncertainty {
        Some(uncertainty) => learned_prior(uncertainty),
        None => Ok(prior(unknowns.model, nuisance, terms, unknowns.slack)),
    }
}

/// Unknown coefficients that the model's uncertainty does not name.
fn missing(unknowns: &Unknowns<'_>, nuisance: &[Nuisance]) -> Result<Vec<Nuisance>, RefineError> {
    let there = |name: &&String| nuisance.iter().any(|own| own.name == **name);
    let one = |name: &String| {
        let axis = unknowns.law.term(name).map(|(axis, _)| axis);
        let axis = axis.map_err(|_| {
            RefineError::Law(format!("law `{}` has no coefficient `{name}`", unknowns.law.name))
        })?;
        Ok(Nuisance { name: name.clone(), kind: NuisanceKind::Own(axis) })
    };
    unknowns.coefficients.iter().filter(|name| !there(name)).map(one).collect()
}

/// Information on some columns alone, marginal over the others.
fn of_others(known: &CoefficientPrior, others: &[usize]) -> Option<DMatrix<f64>> {
    // Marginal information: the covariance of the selected columns, inverted again.
    let covariance = Cholesky::new(known.information.clone())?.inverse();
    let own =
        DMatrix::from_fn(others.len(), others.len(), |i, j| covariance[(others[i], others[j])]);
    Some(Cholesky::new(own)?.inverse())
}

/// Returns the forms of an effect that trials with certain channels can show: where a model carries
/// it, its own form at its values, otherwise all at its absence. Empty where the library does not
/// have it, or such trials do not show it.
pub fn forms_of(
    effect: &str,
    model: &Model,
    law: &Law,
    library: &[Arc<Effect>],
    like: &Trial,
) -> Vec<EffectCandidate> {
    let carried = model.effects.iter().find(|own| own.name == effect);
    // Effects that a model carries are no candidates, so the list is made without them.
    let bare = Model { effects: Vec::new(), ..model.clone() };
    let forms = listed(&bare, law, library, &[like]).into_iter();
    let forms = forms.filter(|candidate| candidate.effect == effect);
    let Some(carried) = carried else { return forms.collect() };
    let at = |candidate: EffectCandidate| {
        let value = |name: &String| carried.parameters.get(name).map(|own| own.value);
        let at = candidate.form.parameters.keys().map(value).collect::<Option<_>>()?;
        Some(EffectCandidate { at, ..candidate })
    };
    forms.filter(|own| own.form.file.name == carried.form.name).filter_map(at).collect()
}
