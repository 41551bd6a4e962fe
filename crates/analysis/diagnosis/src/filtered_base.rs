//! A linearisation with all columns that may be needed, filtered at each level of the discrepancy.
//! A nearby hypothesis is then judged by its own columns alone, which pass the same filter; those
//! of the coefficients are already available.

use std::collections::BTreeMap;
use std::ops::{AddAssign, Range};
use std::sync::{Arc, Mutex, PoisonError};

use rayon::prelude::*;
use sistership_model::manifest::VelocityFrame;

use super::calibrated_model::CalibratedModel;
use super::evidence::DiscrepancyFactor;
use super::hypothesis::JudgedHypothesis;
use super::linearised_trials::LinearisedTrials;
use sistership_filtering::{
    AxisDiscrepancies, EffectCandidate, FilterColumns, FilterGains, GramMatrix,
    LinearisationDetail, LinearisedPart, ResidualSystem, WhitenedColumns, linearise,
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
    /// Computed when a hypothesis is first judged at this level: they are many times as large as
    /// the trials.
    coefficients: Mutex<Option<WhitenedCoefficients>>,
}

/// Filter of a part, and the residual and the columns of the coefficients that have passed it.
struct FilteredCoefficients {
    gains: FilterGains,
    columns: WhitenedColumns,
}

/// Whitened residual and columns of the coefficients, by trial and part.
type WhitenedCoefficients = Arc<Vec<Vec<FilteredCoefficients>>>;

impl FilteredLevel {
    pub fn level_discrepancies(&self) -> &AxisDiscrepancies {
        &self.discrepancies
    }
}

impl<'a> FilteredBase<'a> {
    /// Filters at each of some levels.
    ///
    /// # Errors
    /// Returns an error if the noise of a channel is unknown.
    pub fn new(
        taken: &[EffectCandidate],
        workspace: LinearisedTrials<'a>,
        levels: Vec<(DiscrepancyFactor, AxisDiscrepancies)>,
    ) -> Result<Self, RefineError> {
        let coefficients = workspace.columns().nuisance.len();
        let at = |(level, discrepancies): (DiscrepancyFactor, AxisDiscrepancies)| {
            let one =
                |parts: &Vec<LinearisedPart>| trial_products(&workspace, parts, &discrepancies);
            let grams =
                workspace.linearised_parts().par_iter().map(one).collect::<Result<_, _>>()?;
            Ok(FilteredLevel { level, discrepancies, grams, coefficients: Mutex::default() })
        };
        let levels = levels.into_iter().map(at).collect::<Result<_, RefineError>>()?;
        // Columns of the candidates are many times as large as their products.
        // The products of the candidates suffice.
        let mut workspace = workspace;
        let present: usize = taken.iter().map(|candidate| candidate.at.len()).sum();
        workspace.truncate_columns(coefficients + present);
        let (taken, judged) = (taken.to_vec(), Mutex::default());
        Ok(Self { taken, levels, coefficients, workspace, judged })
    }

    /// Releases the whitened columns of the coefficients, which are many times as large as the
    /// trials; they are computed again when a hypothesis is judged.
    pub fn release_coefficients(&self) {
        for level in &self.levels {
            *level.coefficients.lock().unwrap_or_else(PoisonError::into_inner) = None;
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

    /// Whitened columns of the coefficients at a level. Those of levels that are not neighbours are
    /// released: hypotheses are judged at a level and the one below.
    fn whitened_coefficients(&self, level: usize) -> Result<WhitenedCoefficients, RefineError> {
        for (_, far) in
            self.levels.iter().enumerate().filter(|(other, _)| other.abs_diff(level) > 1)
        {
            *far.coefficients.lock().unwrap_or_else(PoisonError::into_inner) = None;
        }
        let at = &self.levels[level];
        // Held during the computation: other threads wait for the result instead of repeating it.
        let mut kept = at.coefficients.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(coefficients) = &*kept {
            return Ok(Arc::clone(coefficients));
        }
        let of_part = |part: &LinearisedPart| {
            // Only the coefficients pass the filter: the candidates' columns are many more.
            let gains = FilterGains::new(part, &self.workspace.noise, &at.discrepancies)?;
            let columns = gains.whiten_columns(part, self.coefficients);
            Ok(FilteredCoefficients { gains, columns })
        };
        let one = |parts: &Vec<LinearisedPart>| {
            parts.iter().map(of_part).collect::<Result<Vec<_>, RefineError>>()
        };
        let each =
            self.workspace.linearised_parts().par_iter().map(one).collect::<Result<_, _>>()?;
        let fresh: WhitenedCoefficients = Arc::new(each);
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
        let (at, coefficients) =
            (&self.base.levels[level], self.base.whitened_coefficients(level)?);
        let trials: Vec<_> = self.linear.iter().zip(coefficients.iter().zip(&at.grams)).collect();
        let of = |(parts, (known, all)): (&Vec<LinearisedPart>, (&Vec<_>, &GramMatrix))| {
            self.hypothesis_products(parts, known, all)
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
        let coefficients = self.base.whitened_coefficients(level)?;
        let trials: Vec<_> = self.linear.iter().zip(coefficients.iter()).collect();
        let of = |(parts, known): (&Vec<LinearisedPart>, &Vec<FilteredCoefficients>)| {
            self.piecewise_products(parts, known, count)
        };
        let each: Vec<Vec<GramMatrix>> = trials.into_par_iter().map(of).collect();
        Ok(each.into_iter().flatten().collect())
    }

    fn piecewise_products(
        &self,
        parts: &[LinearisedPart],
        known: &[FilteredCoefficients],
        count: usize,
    ) -> Vec<GramMatrix> {
        let c = self.base.coefficients;
        let mut pieces = vec![GramMatrix::zeros(c + self.own_width()); count];
        // Only the columns' products are needed, so the likelihood terms stay zero.
        for (part, known) in parts.iter().zip(known) {
            let own = known.gains.whiten_columns(part, part.sizes.columns);
            let readings = own.reading_count();
            for (piece, gram) in pieces.iter_mut().enumerate() {
                // Readings are divided by their number, so that pieces have nearly equal durations.
                let (from, to) = (piece * readings / count, (piece + 1) * readings / count);
                let square = known.columns.own_products(from..to);
                let square = square.view((1, 1), (c, c));
                gram.products.view_mut((1, 1), (c, c)).add_assign(&square);
                add_products(gram, (&known.columns, &own), from..to);
            }
        }
        pieces
    }

    fn hypothesis_products(
        &self,
        parts: &[LinearisedPart],
        known: &[FilteredCoefficients],
        all: &GramMatrix,
    ) -> GramMatrix {
        let c = self.base.coefficients;
        let mut gram = GramMatrix::zeros(c + self.own_width());
        // The coefficients' own products, and the terms of the filter, are those of the base.
        gram.products.view_mut((1, 1), (c, c)).copy_from(&all.products.view((1, 1), (c, c)));
        (gram.log_variance, gram.count) = (all.log_variance, all.count);
        for (part, known) in parts.iter().zip(known) {
            let own = known.gains.whiten_columns(part, part.sizes.columns);
            add_products(&mut gram, (&known.columns, &own), 0..own.reading_count());
        }
        gram
    }

    /// Number of columns: the residual and the parameters of the hypothesis.
    fn own_width(&self) -> usize {
        1 + self.linear.iter().flatten().next().map_or(0, |part| part.sizes.columns)
    }
}

/// Adds products of coefficients with a hypothesis' own columns, and of these among themselves, over
/// some readings. The first known column is the residual of the base.
fn add_products(
    gram: &mut GramMatrix,
    (known, own): (&WhitenedColumns, &WhitenedColumns),
    readings: Range<usize>,
) {
    let cross = known.products_with(own, readings.clone());
    let square = own.own_products(readings);
    let (c, own) = (cross.nrows() - 1, cross.ncols());
    // The residual is at index 0; own columns follow those of the coefficients.
    let place = |i: usize| if i == 0 { 0 } else { c + i };
    for i in 0..own {
        for k in 1..=c {
            gram.products[(k, place(i))] += cross[(k, i)];
            gram.products[(place(i), k)] += cross[(k, i)];
        }
        (0..own).for_each(|j| gram.products[(place(i), place(j))] += square[(i, j)]);
    }
}
