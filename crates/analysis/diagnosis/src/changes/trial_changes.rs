//! Changes that explain a trial.

use std::collections::BTreeSet;
use std::ops::AddAssign;

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::super::coefficient_prior::CoefficientPrior;
use super::super::evidence::{
    HypothesisEstimate, MarginalInformation, NormalPrior, not_positive_error,
};
use super::super::hypothesis::JudgedHypothesis;
use super::super::linearised_trials::LinearisedTrials;
use super::super::misfit::{misfit_share, shape_error};
use super::super::outcome::{ChangeCourse, EffectChange, UnexplainedSegment};
use super::super::remainder::unexplained_in_trial;
use super::super::search::HypothesisSearch;
use super::super::values::values_with_errors;
use sistership_filtering::{
    AxisDiscrepancies, EffectCandidate, GramMatrix, LinearisedPart, whiten_part,
};
use sistership_identification::refine::RefineError;

use super::source::{ChangeSource, change_sources};
use super::windows::{ChangeWindow, TrialSegments, central_interval};

/// Data that are the same for all trials.
pub(super) struct ChangeSearch<'s, 'a> {
    search: &'s HypothesisSearch<'a>,
    workspace: &'s LinearisedTrials<'a>,
    discrepancies: AxisDiscrepancies,
    sources: Vec<ChangeSource>,
    /// Columns that are present together with a change: those of coefficients, and of the accepted
    /// effects.
    kept: Vec<usize>,
    /// Priors of the accepted effects by the other trials.
    taken: Vec<NormalPrior>,
    /// Relative uncertainty of the accepted effects' laws, by their columns.
    open: Vec<f64>,
}

/// Columns of a trial that are present with any change, after the filter.
struct KeptColumns {
    place: usize,
    /// Residual and columns by readings, by part.
    rows: Vec<DMatrix<f64>>,
    gram: GramMatrix,
}

/// A window of a source, with its evidence on a trial.
struct WeighedChange<'s> {
    source: &'s ChangeSource,
    window: ChangeWindow,
    evidence: f64,
    estimate: HypothesisEstimate,
}

impl<'s, 'a> ChangeSearch<'s, 'a> {
    pub fn new(
        search: &'s HypothesisSearch<'a>,
        best: &JudgedHypothesis,
        workspace: &'s LinearisedTrials<'a>,
    ) -> Self {
        let size = search.nuisance.len();
        let moved: usize = best.candidates.iter().map(|candidate| candidate.at.len()).sum();
        // The smallest positive number keeps the prior of a determined parameter valid.
        let deviation = |i: usize| best.covariance[(i, i)].max(f64::MIN_POSITIVE).sqrt();
        let share = |candidate: &EffectCandidate| {
            let share = shape_error(candidate);
            candidate.parameter_changes().into_iter().map(move |change| share * change)
        };
        Self {
            search,
            workspace,
            discrepancies: search.expected.clone(),
            sources: change_sources(search, workspace.columns()),
            kept: (0..size + moved).collect(),
            taken: (0..moved).map(|i| NormalPrior { mean: 0.0, deviation: deviation(i) }).collect(),
            open: vec![0.0; size]
                .into_iter()
                .chain(best.candidates.iter().flat_map(share))
                .collect(),
        }
    }

    /// Returns the most evident change of each effect that explains all that remains of a trial, of
    /// those that are requested.
    ///
    /// # Errors
    /// Returns an error if the noise of a channel is unknown, or if the information is not
    /// positive.
    pub fn trial_changes(
        &self,
        place: usize,
        least_evidence: f64,
        is_asked: &(dyn Fn(&str) -> bool + Sync),
    ) -> Result<Vec<EffectChange>, RefineError> {
        let trial = &self.kept_columns(place)?;
        let asked = self.sources.par_iter().filter(|source| is_asked(&source.candidate.effect));
        let each: Vec<Option<EffectChange>> = asked
            .map(|source| self.source_change(trial, source, least_evidence))
            .collect::<Result<_, _>>()?;
        let mut found: Vec<EffectChange> = each.into_iter().flatten().collect();
        found.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
        // Sorted by evidence: the first form of each effect is its most evident one.
        let mut effects = BTreeSet::new();
        found.retain(|change| effects.insert(change.effect.clone()));
        Ok(found)
    }

    /// The most evident change of a source, where it explains all that remains of a trial.
    fn source_change(
        &self,
        trial: &KeptColumns,
        source: &ChangeSource,
        least_evidence: f64,
    ) -> Result<Option<EffectChange>, RefineError> {
        let Some(stretches) = self.divide_trial(trial.place, source) else { return Ok(None) };
        // Windows at the segments' ends first; the time of the best one is then refined.
        let coarse = self.segment_windows(trial, source, stretches)?;
        let taken = simplest_window(&coarse, least_evidence);
        let Some(taken) = taken.filter(|taken| taken.evidence > least_evidence) else {
            return Ok(None);
        };
        // A change without a time has nothing to refine.
        let fine = match taken.window.is_timed() {
            true => self.refined_windows(trial, source, stretches, taken.window)?,
            false => Vec::new(),
        };
        let taken = most_evident(&fine).unwrap_or(taken);
        // Accepted only if the trial has no remainder with it.
        let is_right = self.remaining_with(trial, stretches, taken)?.is_empty();
        Ok(is_right.then(|| self.change_report((trial.place, stretches), taken, (&coarse, &fine))))
    }

    fn divide_trial(&self, place: usize, source: &ChangeSource) -> Option<TrialSegments> {
        let parts = &self.workspace.linearised_parts()[place];
        let first = parts.first()?.t_s.first()?;
        let last = parts.last()?.t_s.last()?;
        let length_s = self.workspace.lpp_m / self.workspace.speed_m_s;
        let parameters = source.columns.len();
        (last > first).then(|| TrialSegments::new([*first, *last], length_s, parameters))
    }

    /// All windows of a source that begin and end at the limits of segments.
    fn segment_windows<'w>(
        &self,
        trial: &KeptColumns,
        source: &'w ChangeSource,
        stretches: TrialSegments,
    ) -> Result<Vec<WeighedChange<'w>>, RefineError> {
        let cut =
            self.source_information(trial, source, &|t_s| stretches.segment_membership(t_s))?;
        let of = |window: ChangeWindow| {
            let spread = stretches.window_matrix(window, source.columns.len());
            weigh_window(source, window, cut.transform_columns(&spread), stretches)
        };
        Ok(stretches.all_windows().into_iter().filter_map(of).collect())
    }

    /// Windows of a source at times between the neighbours of one.
    fn refined_windows<'w>(
        &self,
        trial: &KeptColumns,
        source: &'w ChangeSource,
        stretches: TrialSegments,
        about: ChangeWindow,
    ) -> Result<Vec<WeighedChange<'w>>, RefineError> {
        let windows = stretches.neighbouring_windows(about);
        let shares = |t_s: f64| {
            windows.iter().map(|window| window.share_at(t_s, stretches.span_s)).collect()
        };
        let cut = self.source_information(trial, source, &shares)?;
        let parameters = source.columns.len();
        // Columns are ordered by parameter, then by window.
        let of = |(at, window): (usize, &ChangeWindow)| {
            let own = (0..parameters).map(|parameter| parameter * windows.len() + at);
            weigh_window(source, *window, cut.select_columns(&own.collect::<Vec<_>>()), stretches)
        };
        Ok(windows.iter().enumerate().filter_map(of).collect())
    }

    /// Information of a trial on the columns of a source, each once for every weight of a time,
    /// with coefficients and the accepted effects integrated out.
    fn source_information(
        &self,
        trial: &KeptColumns,
        source: &ChangeSource,
        weights: &dyn Fn(f64) -> Vec<f64>,
    ) -> Result<MarginalInformation, RefineError> {
        let gram = self.source_gram(trial, source, weights)?;
        let all = MarginalInformation::new(&gram, &self.search.fixed)?;
        let taken: Vec<usize> = (0..self.taken.len()).collect();
        let own: Vec<usize> = (taken.len()..all.right.len()).collect();
        if taken.is_empty() {
            return Ok(all);
        }
        all.marginalise_others(&taken, &self.taken, &own).ok_or_else(not_positive_error)
    }

    /// Parts of a trial with some columns as they are, and the columns of a source multiplied by
    /// weights.
    fn weighted_parts(
        &self,
        (place, kept): (usize, &[usize]),
        source: &ChangeSource,
        weights: &dyn Fn(f64) -> Vec<f64>,
    ) -> Vec<LinearisedPart> {
        let parts = self.workspace.linearised_parts()[place].iter();
        parts.map(|part| part.weight_columns(kept, &source.columns, weights)).collect()
    }

    /// Columns of coefficients and of the accepted effects, which are the same for every change.
    fn kept_columns(&self, place: usize) -> Result<KeptColumns, RefineError> {
        let width = 1 + self.kept.len();
        let mut gram = GramMatrix::zeros(width);
        let mut whitened = |part: &LinearisedPart| {
            let part = part.weight_columns(&self.kept, &[], &|_| Vec::new());
            let (rows, log_variance) = self.whiten_part(&part)?;
            gram.add(&GramMatrix::from_columns(&rows, log_variance));
            Ok(rows)
        };
        let parts = self.workspace.linearised_parts()[place].iter();
        let rows = parts.map(&mut whitened).collect::<Result<_, RefineError>>()?;
        Ok(KeptColumns { place, rows, gram })
    }

    /// Residual and columns by readings.
    fn whiten_part(&self, part: &LinearisedPart) -> Result<(DMatrix<f64>, f64), RefineError> {
        let (rows, log_variance) = whiten_part(part, &self.workspace.noise, &self.discrepancies)?;
        let width = 1 + part.sizes.columns;
        Ok((DMatrix::from_vec(width, rows.len() / width, rows), log_variance))
    }

    /// Products of the kept columns and those of a source.
    fn source_gram(
        &self,
        trial: &KeptColumns,
        source: &ChangeSource,
        weights: &dyn Fn(f64) -> Vec<f64>,
    ) -> Result<GramMatrix, RefineError> {
        let parts = self.weighted_parts((trial.place, &[]), source, weights);
        let (known, own) =
            (trial.gram.products.nrows(), parts.first().map_or(0, |part| part.sizes.columns));
        // The products of the kept columns are computed once per trial; only the rows and columns
        // of the source are added.
        let mut gram =
            GramMatrix { products: DMatrix::zeros(known + own, known + own), ..trial.gram };
        gram.products.view_mut((0, 0), (known, known)).copy_from(&trial.gram.products);
        for (part, rows) in parts.iter().zip(&trial.rows) {
            // Cross products with the kept columns, and products of the source's own columns.
            let of_source = self.whiten_part(part)?.0.rows(1, own).transpose();
            let (cross, square) = (rows * &of_source, of_source.tr_mul(&of_source));
            gram.products.view_mut((0, known), (known, own)).add_assign(&cross);
            gram.products.view_mut((known, 0), (own, known)).add_assign(&cross.transpose());
            gram.products.view_mut((known, known), (own, own)).add_assign(&square);
        }
        Ok(gram)
    }

    /// Unexplained remainder of a trial with a change.
    fn remaining_with(
        &self,
        trial: &KeptColumns,
        stretches: TrialSegments,
        change: &WeighedChange<'_>,
    ) -> Result<Vec<UnexplainedSegment>, RefineError> {
        let WeighedChange { source, window, .. } = change;
        let weight = |t_s: f64| vec![window.share_at(t_s, stretches.span_s)];
        let gram = self.source_gram(trial, source, &weight)?;
        let parameters = self.fit_with_change(&gram, &self.search.fixed, source)?;
        // The error of the change's own law is allowed for as well.
        let changed = parameters.iter().skip(self.kept.len()).map(|size| source.misfit * size);
        let open: Vec<f64> = self.open.iter().copied().chain(changed).collect();
        let place = trial.place;
        let parts = self.weighted_parts((place, &self.kept), source, &weight);
        let clean = self.search.model.uncertainty.as_ref().map(|known| &known.remainder);
        let named = (self.workspace, self.workspace.trials[place].name.as_str());
        unexplained_in_trial(named, &parts, &self.discrepancies, (&parameters, &open), clean)
    }

    /// Coefficients, accepted effects and the change, fitted together on the trial.
    fn fit_with_change(
        &self,
        gram: &GramMatrix,
        fixed: &CoefficientPrior,
        source: &ChangeSource,
    ) -> Result<Vec<f64>, RefineError> {
        let reduced = MarginalInformation::new(gram, fixed)?;
        let priors: Vec<NormalPrior> = self.taken.iter().chain(&source.priors).copied().collect();
        let places: Vec<usize> = (0..priors.len()).collect();
        let estimate =
            reduced.estimate_parameters(&places, &priors).ok_or_else(not_positive_error)?;
        // Coefficients follow from the estimate: they were integrated out before.
        let shift = &reduced.shift - &reduced.answers * &estimate.mean;
        Ok(shift.iter().chain(estimate.mean.iter()).copied().collect())
    }

    /// Result for a change; `coarse` and `fine` are all windows of its source.
    fn change_report(
        &self,
        (place, stretches): (usize, TrialSegments),
        taken: &WeighedChange<'_>,
        (coarse, fine): (&[WeighedChange<'_>], &[WeighedChange<'_>]),
    ) -> EffectChange {
        let WeighedChange { source, window, evidence, estimate } = taken;
        let mut candidate = source.candidate.clone();
        // The estimate is a distance from the absence of the effect.
        candidate.at.iter_mut().zip(estimate.mean.iter()).for_each(|(at, mean)| *at += mean);
        let is_timed = window.is_timed();
        EffectChange {
            effect: candidate.effect.clone(),
            form: candidate.form.file.name.clone(),
            meaning: candidate.form.file.meaning.clone(),
            trial: self.workspace.trials[place].name.clone(),
            course: window.course,
            at_s: is_timed.then_some(window.at_s),
            between_s: is_timed.then(|| time_interval(stretches, coarse, fine)),
            parameters: values_with_errors(&candidate, &estimate.covariance, self.search.model),
            evidence: *evidence,
            or: Vec::new(),
        }
    }
}

/// Evidence of a window of a source by the information of a trial.
fn weigh_window(
    source: &ChangeSource,
    window: ChangeWindow,
    says: MarginalInformation,
    stretches: TrialSegments,
) -> Option<WeighedChange<'_>> {
    let places: Vec<usize> = (0..source.columns.len()).collect();
    let estimate = says.divide_by(source.discount).estimate_parameters(&places, &source.priors)?;
    let evidence = estimate.gain + source.log_prior + stretches.log_prior(window);
    Some(WeighedChange { source, window, evidence, estimate })
}

fn most_evident<'w, 's>(windows: &'w [WeighedChange<'s>]) -> Option<&'w WeighedChange<'s>> {
    windows.iter().max_by(|a, b| a.evidence.total_cmp(&b.evidence))
}

/// Selected window of a source. A change throughout the trial or a drift needs no time, and where
/// the form is another author's, it may seem to begin or end.
fn simplest_window<'w, 's>(
    windows: &'w [WeighedChange<'s>],
    least_evidence: f64,
) -> Option<&'w WeighedChange<'s>> {
    let best = most_evident(windows)?;
    // Part of the evidence that may come from the difference between published forms.
    let may_be = misfit_share(&best.source.candidate) * best.evidence.max(0.0);
    let enough = best.evidence - least_evidence - may_be;
    let of = |course: ChangeCourse| {
        windows.iter().find(|one| one.window.course == course && one.evidence >= enough)
    };
    Some(of(ChangeCourse::Throughout).or_else(|| of(ChangeCourse::Drifts)).unwrap_or(best))
}

/// Interval of a change's time, by the finer times where there are some.
fn time_interval(
    stretches: TrialSegments,
    coarse: &[WeighedChange<'_>],
    fine: &[WeighedChange<'_>],
) -> [f64; 2] {
    let Some((first, last)) = fine.first().zip(fine.last()) else { return stretches.span_s };
    let step_s = stretches.refined_step_s();
    let is_outside = |one: &&WeighedChange<'_>| {
        one.window.course == first.window.course
            && !(first.window.at_s..=last.window.at_s).contains(&one.window.at_s)
    };
    // Coarse windows inside the refined interval are replaced by the refined ones.
    let outside = coarse.iter().filter(is_outside);
    let outside = outside.map(|one| (one.window.at_s, one.evidence, stretches.width_s()));
    let inside = fine.iter().map(|one| (one.window.at_s, one.evidence, step_s));
    central_interval(outside.chain(inside).collect())
}
