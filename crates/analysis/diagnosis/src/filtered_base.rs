//! A linearisation with all columns that may be needed, filtered at each level of the discrepancy.
//! A nearby hypothesis is then judged by its own columns alone, which pass the same filter; their
//! products with those of the coefficients come from the adjoint of it.

use std::collections::BTreeMap;
use std::ops::{AddAssign, Range};
use std::sync::{Arc, Mutex, PoisonError};

use nalgebra::DMatrix;
use rayon::prelude::*;
use sistership_model::manifest::VelocityFrame;

use super::calibrated_model::CalibratedModel;
use super::evidence::DiscrepancyFactor;
use super::hypothesis::JudgedHypothesis;
use super::linearised_trials::LinearisedTrials;
use sistership_filtering::{
    AxisDiscrepancies, EffectCandidate, FilterColumns, FilterGains, GramMatrix,
    LinearisationDetail, LinearisedPart, ResidualSystem, linearise,
};
use sistership_identification::refine::RefineError;

/// Accepted effects, and the data for judging others together with them.
pub(super) struct FilteredBase<'a> {
    pub taken: Vec<EffectCandidate>,
    pub workspace: LinearisedTrials<'a>,
    pub levels: Vec<FilteredLevel>,
    coefficients: usize,
    /// Hypotheses judged already, by the effect and the level of its screening.
    judged: Mutex<BTreeMap<(String, usize), JudgedHypothesis>>,
}

/// Filter at one level.
pub(super) struct FilteredLevel {
    pub level: DiscrepancyFactor,
    discrepancies: AxisDiscrepancies,
    /// Products of all columns, by trial.
    grams: Vec<GramMatrix>,
    /// Computed when a hypothesis is first judged at this level: they are larger than the trials.
    gains: Mutex<Option<TrialGains>>,
    /// Products of the coefficients by pieces of each trial, computed when they are first needed.
    pieces: Mutex<Option<TrialPieces>>,
}

/// Filter of each part, by trial.
type TrialGains = Arc<Vec<Vec<FilterGains>>>;

/// Products of the coefficients by trial and piece.
type TrialPieces = Arc<Vec<Vec<DMatrix<f64>>>>;

impl FilteredLevel {
    pub fn level_discrepancies(&self) -> &AxisDiscrepancies {
        &self.discrepancies
    }
}

impl<'a> FilteredBase<'a> {
    /// Filters trials, which are linearised here, at each of some levels.
    ///
    /// # Errors
    /// Returns an error if the noise of a channel is unknown.
    pub fn new(
        taken: &[EffectCandidate],
        workspace: LinearisedTrials<'a>,
        levels: Vec<(DiscrepancyFactor, AxisDiscrepancies)>,
    ) -> Result<Self, RefineError> {
        let coefficients = workspace.columns().nuisance.len();
        let present: usize = taken.iter().map(|candidate| candidate.at.len()).sum();
        let products = |workspace: &LinearisedTrials<'_>, parts: &[LinearisedPart]| {
            let at = |(_, discrepancies): &(DiscrepancyFactor, AxisDiscrepancies)| {
                trial_products(workspace, parts, discrepancies)
            };
            levels.iter().map(at).collect::<Result<Vec<GramMatrix>, RefineError>>()
        };
        // Columns of the candidates are many times as large as their products, which suffice.
        let (workspace, grams) = workspace.linearise_with(coefficients + present, products)?;
        let mut each = grams.into_iter().map(Vec::into_iter).collect::<Vec<_>>();
        let at = |(level, discrepancies)| {
            let grams = each.iter_mut().filter_map(Iterator::next).collect();
            let (gains, pieces) = (Mutex::default(), Mutex::default());
            FilteredLevel { level, discrepancies, grams, gains, pieces }
        };
        let levels = levels.into_iter().map(at).collect();
        let (taken, judged) = (taken.to_vec(), Mutex::default());
        Ok(Self { taken, levels, coefficients, workspace, judged })
    }

    /// Releases the gains, which are larger than the trials; they are computed again when a
    /// hypothesis is judged.
    pub fn release_gains(&self) {
        for level in &self.levels {
            *level.gains.lock().unwrap_or_else(PoisonError::into_inner) = None;
        }
    }

    /// Judges a hypothesis once, and returns the stored result afterwards.
    ///
    /// # Errors
    /// Returns the error of the judgement.
    pub fn judge_once(
        &self,
        key: (String, usize),
        judge: impl FnOnce() -> Result<JudgedHypothesis, RefineError>,
    ) -> Result<JudgedHypothesis, RefineError> {
        // A panic of another thread leaves the map complete, so that its poisoning is ignored.
        let all = || self.judged.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = all().get(&key) {
            return Ok(known.clone());
        }
        // The lock is not held during the judgement; two threads may compute the same result.
        let judged = judge()?;
        all().insert(key, judged.clone());
        Ok(judged)
    }

    /// Products of all columns over all trials, at one of the levels.
    pub fn total_products(&self, level: usize) -> GramMatrix {
        GramMatrix::sum_parts(self.levels[level].grams.iter(), 1 + self.workspace.columns().len())
    }

    /// Columns of a hypothesis at whose values the base is linearised: the effects of the base, and
    /// others at their absence. None where the base is linearised at other values.
    fn matching_columns(&self, candidates: &[EffectCandidate]) -> Option<Vec<usize>> {
        let columns = self.workspace.columns();
        let one = |candidate: &EffectCandidate| {
            let place = columns.candidates.iter().position(|known| known == candidate)?;
            Some(columns.candidate_columns(place))
        };
        let own: Vec<_> = candidates.iter().map(one).collect::<Option<_>>()?;
        let is_complete = self.taken.iter().all(|taken| candidates.contains(taken));
        is_complete.then(|| (0..self.coefficients).chain(own.into_iter().flatten()).collect())
    }

    /// Gains of the filter at a level. Those of levels that are not neighbours are released:
    /// hypotheses are judged at a level and the one below.
    fn filter_gains(&self, level: usize) -> Result<TrialGains, RefineError> {
        for (_, far) in
            self.levels.iter().enumerate().filter(|(other, _)| other.abs_diff(level) > 1)
        {
            *far.gains.lock().unwrap_or_else(PoisonError::into_inner) = None;
        }
        let at = &self.levels[level];
        // Held during the computation: other threads wait for the result instead of repeating it.
        let mut kept = at.gains.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(gains) = &*kept {
            return Ok(Arc::clone(gains));
        }
        let of_part = |part: &LinearisedPart| {
            FilterGains::new(part, &self.workspace.noise, &at.discrepancies)
        };
        let one = |parts: &Vec<LinearisedPart>| parts.iter().map(of_part).collect();
        let each: Result<_, RefineError> =
            self.workspace.linearised_parts().par_iter().map(one).collect();
        let fresh: TrialGains = Arc::new(each?);
        *kept = Some(Arc::clone(&fresh));
        Ok(fresh)
    }

    /// Products of the coefficients at a level by pieces of equal duration of each trial.
    fn coefficient_pieces(&self, level: usize, count: usize) -> Result<TrialPieces, RefineError> {
        let gains = self.filter_gains(level)?;
        let mut kept = self.levels[level].pieces.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(pieces) = kept.as_ref().filter(|kept| kept.iter().all(|k| k.len() == count)) {
            return Ok(Arc::clone(pieces));
        }
        let c = self.coefficients;
        let of_trial = |(parts, gains): (&Vec<LinearisedPart>, &Vec<FilterGains>)| {
            let mut pieces = vec![DMatrix::zeros(c, c); count];
            for (part, gains) in parts.iter().zip(gains) {
                let known = gains.whiten_columns(part, c);
                for (piece, sum) in pieces.iter_mut().enumerate() {
                    let readings = piece_readings(piece, count, known.reading_count());
                    sum.add_assign(&known.own_products(readings).view((1, 1), (c, c)));
                }
            }
            pieces
        };
        let trials: Vec<_> = self.workspace.linearised_parts().iter().zip(gains.iter()).collect();
        let fresh: TrialPieces = Arc::new(trials.into_par_iter().map(of_trial).collect());
        *kept = Some(Arc::clone(&fresh));
        Ok(fresh)
    }

    /// Returns a hypothesis at its values, whose products are those of the base where the base is
    /// linearised there, and else come from a linearisation of its own.
    ///
    /// # Errors
    /// Returns an error that names what the model or a trial lacks.
    pub fn prepare_hypothesis(
        &self,
        learned: &CalibratedModel,
        candidates: &[EffectCandidate],
    ) -> Result<PreparedHypothesis<'_, 'a>, RefineError> {
        Ok(match self.matching_columns(candidates) {
            Some(columns) => PreparedHypothesis::Filtered(self, columns),
            None => PreparedHypothesis::Linearised(self.linearise_hypothesis(learned, candidates)?),
        })
    }

    /// Linearises readings and columns of a hypothesis at its values, to be filtered at any level.
    ///
    /// # Errors
    /// Returns an error that names what the model or a trial lacks.
    pub fn linearise_hypothesis(
        &self,
        learned: &CalibratedModel,
        candidates: &[EffectCandidate],
    ) -> Result<LinearisedHypothesis<'_, 'a>, RefineError> {
        let frame: VelocityFrame = self.workspace.frame();
        let columns = FilterColumns { nuisance: Vec::new(), candidates: candidates.to_vec() };
        let system = ResidualSystem::new(&learned.model, &learned.law, columns, frame)?;
        let system = system.with_expected_rates(learned.expected_rates);
        let records = self.workspace.records();
        let linear: Vec<Vec<LinearisedPart>> = records
            .par_iter()
            .map(|record| linearise(&system, record, LinearisationDetail::Columns))
            .collect::<Result<_, _>>()?;
        // The filter of the base is kept: its transitions and readings of deviations.
        let of = |(own, base): (Vec<LinearisedPart>, &Vec<LinearisedPart>)| {
            own.into_iter().zip(base).map(|(own, base)| own.with_filter_from(base)).collect()
        };
        Ok(LinearisedHypothesis {
            base: self,
            linear: linear.into_iter().zip(self.workspace.linearised_parts()).map(of).collect(),
        })
    }
}

/// Products of all columns over a trial.
fn trial_products(
    workspace: &LinearisedTrials<'_>,
    parts: &[LinearisedPart],
    discrepancies: &AxisDiscrepancies,
) -> Result<GramMatrix, RefineError> {
    let mut gram = GramMatrix::zeros(1 + workspace.columns().len());
    for part in parts {
        let gains = FilterGains::new(part, &workspace.noise, discrepancies)?;
        gram.add(&gains.whitened_products(part));
    }
    Ok(gram)
}

/// A hypothesis at its values, ready for the products of its columns.
pub(super) enum PreparedHypothesis<'b, 'a> {
    /// Some columns of a base, which is linearised at these values.
    Filtered(&'b FilteredBase<'a>, Vec<usize>),
    Linearised(LinearisedHypothesis<'b, 'a>),
}

impl PreparedHypothesis<'_, '_> {
    /// Returns the products of each trial: residual, coefficients, parameters of the hypothesis.
    ///
    /// # Errors
    /// Returns an error if the noise of a channel is unknown.
    pub fn products_per_trial(&self, level: usize) -> Result<Vec<GramMatrix>, RefineError> {
        match self {
            Self::Filtered(base, columns) => {
                let grams = base.levels[level].grams.iter();
                Ok(grams.map(|gram| gram.select_columns(columns)).collect())
            }
            Self::Linearised(linearised) => linearised.products_per_trial(level),
        }
    }
}

/// A hypothesis linearised at its values.
pub(super) struct LinearisedHypothesis<'b, 'a> {
    base: &'b FilteredBase<'a>,
    linear: Vec<Vec<LinearisedPart>>,
}

impl LinearisedHypothesis<'_, '_> {
    /// Returns the products of each trial: residual, coefficients, parameters of the hypothesis.
    ///
    /// # Errors
    /// Returns an error if the noise of a channel is unknown.
    fn products_per_trial(&self, level: usize) -> Result<Vec<GramMatrix>, RefineError> {
        let (at, gains) = (&self.base.levels[level], self.base.filter_gains(level)?);
        let trials: Vec<_> = self.trial_parts().zip(gains.iter().zip(&at.grams)).collect();
        let of = |(parts, (gains, all)): (TrialParts<'_>, (&Vec<FilterGains>, &GramMatrix))| {
            self.hypothesis_products(parts, gains, all)
        };
        Ok(trials.into_par_iter().map(of).collect())
    }

    /// Returns the products of each trial in pieces of equal duration.
    ///
    /// # Errors
    /// Returns an error if the noise of a channel is unknown.
    pub fn products_per_piece(
        &self,
        level: usize,
        count: usize,
    ) -> Result<Vec<GramMatrix>, RefineError> {
        let known = self.base.coefficient_pieces(level, count)?;
        let gains = self.base.filter_gains(level)?;
        let trials: Vec<_> = self.trial_parts().zip(gains.iter().zip(known.iter())).collect();
        let of = |(parts, (gains, known)): (TrialParts<'_>, (&Vec<FilterGains>, &Vec<_>))| {
            self.piecewise_products(parts, gains, known)
        };
        let each: Vec<Vec<GramMatrix>> = trials.into_par_iter().map(of).collect();
        Ok(each.into_iter().flatten().collect())
    }

    /// Parts of each trial, of the hypothesis and of the base.
    fn trial_parts(&self) -> impl Iterator<Item = TrialParts<'_>> {
        let base = self.base.workspace.linearised_parts();
        self.linear.iter().zip(base).map(|(own, base)| TrialParts { own, base })
    }

    fn piecewise_products(
        &self,
        parts: TrialParts<'_>,
        gains: &[FilterGains],
        known: &[DMatrix<f64>],
    ) -> Vec<GramMatrix> {
        let c = self.base.coefficients;
        let mut pieces = vec![GramMatrix::zeros(c + self.own_width()); known.len()];
        // Only the columns' products are needed, so the likelihood terms stay zero.
        for (gram, known) in pieces.iter_mut().zip(known) {
            gram.products.view_mut((1, 1), (c, c)).copy_from(known);
        }
        for ((part, base), gains) in parts.own.iter().zip(parts.base).zip(gains) {
            let own = gains.whiten_columns(part, part.sizes.columns);
            for (piece, gram) in pieces.iter_mut().enumerate() {
                let readings = piece_readings(piece, known.len(), own.reading_count());
                let cross = gains.column_products(base, &own, readings.clone());
                add_products(gram, &cross.rows(0, c).into_owned(), &own.own_products(readings));
            }
        }
        pieces
    }

    fn hypothesis_products(
        &self,
        parts: TrialParts<'_>,
        gains: &[FilterGains],
        all: &GramMatrix,
    ) -> GramMatrix {
        let c = self.base.coefficients;
        let mut gram = GramMatrix::zeros(c + self.own_width());
        // The coefficients' own products, and the terms of the filter, are those of the base.
        gram.products.view_mut((1, 1), (c, c)).copy_from(&all.products.view((1, 1), (c, c)));
        (gram.log_variance, gram.count) = (all.log_variance, all.count);
        for ((part, base), gains) in parts.own.iter().zip(parts.base).zip(gains) {
            let own = gains.whiten_columns(part, part.sizes.columns);
            // Coefficients act by accelerations alone: they need not pass the filter.
            let all = 0..own.reading_count();
            let cross = gains.column_products(base, &own, all.clone());
            add_products(&mut gram, &cross.rows(0, c).into_owned(), &own.own_products(all));
        }
        gram
    }

    /// Number of columns: the residual and the parameters of the hypothesis.
    fn own_width(&self) -> usize {
        1 + self.linear.iter().flatten().next().map_or(0, |part| part.sizes.columns)
    }
}

/// Readings of a piece of a part, of equal numbers so that pieces have nearly equal durations.
fn piece_readings(piece: usize, pieces: usize, readings: usize) -> Range<usize> {
    piece * readings / pieces..(piece + 1) * readings / pieces
}

/// Parts of a trial, linearised at a hypothesis and at its base.
#[derive(Clone, Copy)]
struct TrialParts<'p> {
    own: &'p [LinearisedPart],
    base: &'p [LinearisedPart],
}

/// Adds products of coefficients with a hypothesis' own columns, and of these among themselves, of
/// which the first is the residual.
fn add_products(gram: &mut GramMatrix, cross: &DMatrix<f64>, square: &DMatrix<f64>) {
    let (c, own) = cross.shape();
    // The residual is at index 0; own columns follow those of the coefficients.
    let place = |i: usize| if i == 0 { 0 } else { c + i };
    for i in 0..own {
        for k in 0..c {
            gram.products[(1 + k, place(i))] += cross[(k, i)];
            gram.products[(place(i), 1 + k)] += cross[(k, i)];
        }
        (0..own).for_each(|j| gram.products[(place(i), place(j))] += square[(i, j)]);
    }
}
