//! Changes that explain a trial.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use super::super::evidence::{
    HypothesisEstimate, MarginalInformation, NormalPrior, not_positive_error,
};
use super::super::hypothesis::JudgedHypothesis;
use super::super::linearised_trials::LinearisedTrials;
use super::super::misfit::{misfit_share, shape_error};
use super::super::outcome::{ChangeCourse, EffectChange, UnexplainedSegment};
use super::super::remainder::{PartErrors, unexplained_by_errors};
use super::super::search::HypothesisSearch;
use super::super::values::values_with_errors;
use sistership_filtering::{
    AxisDiscrepancies, EffectCandidate, FilterGains, GramMatrix, LinearisedPart, WhitenedColumns,
};
use sistership_identification::refine::RefineError;

use super::reduced_trial::ReducedTrial;
use super::segment_products::{KeptPart, SourceProducts, add_segment_products};
use super::source::{ChangeSource, change_sources};
use super::windows::{ChangeWindow, TrialSegments, central_interval};

/// Data that are the same for all trials.
pub(super) struct ChangeSearch<'s, 'a> {
    search: &'s HypothesisSearch<'a>,
    workspace: &'s LinearisedTrials<'a>,
    discrepancies: AxisDiscrepancies,
    sources: Vec<ChangeSource>,
    /// Number of columns that are present together with a change, which are the first: those of
    /// coefficients, and of the accepted effects.
    kept: usize,
    /// Priors of the accepted effects by the other trials.
    taken: Vec<NormalPrior>,
    /// Relative uncertainty of the accepted effects' laws, by their columns.
    open: Vec<f64>,
}

/// A trial with the columns that are present with any change.
struct KeptTrial<'p> {
    place: usize,
    parts: Vec<KeptPart<'p>>,
    reduced: ReducedTrial,
}

/// Columns of a source with weights, by part, and their products with those that are present with
/// any change.
struct WeightedColumns {
    parts: Vec<WhitenedColumns>,
    products: SourceProducts,
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
            kept: size + moved,
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
        let trial = &self.kept_trial(place)?;
        let asked: Vec<&ChangeSource> =
            self.sources.iter().filter(|source| is_asked(&source.candidate.effect)).collect();
        let weighed = self.segment_products(trial, &asked);
        let each: Vec<Option<EffectChange>> = weighed
            .par_iter()
            .map(|(source, stretches, products)| {
                self.source_change(trial, (source, *stretches, products), least_evidence)
            })
            .collect::<Result<_, _>>()?;
        let mut found: Vec<EffectChange> = each.into_iter().flatten().collect();
        found.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
        // Sorted by evidence: the first form of each effect is its most evident one.
        let mut effects = BTreeSet::new();
        found.retain(|change| effects.insert(change.effect.clone()));
        Ok(found)
    }

    /// Products of each source by segments of a trial. Sources with as many segments share a pass.
    fn segment_products<'w>(
        &self,
        trial: &KeptTrial<'_>,
        asked: &[&'w ChangeSource],
    ) -> Vec<(&'w ChangeSource, TrialSegments, SourceProducts)> {
        let mut alike: BTreeMap<usize, (TrialSegments, Vec<&'w ChangeSource>)> = BTreeMap::new();
        for &source in asked {
            let Some(stretches) = self.divide_trial(trial.place, source) else { continue };
            alike.entry(stretches.count).or_insert((stretches, Vec::new())).1.push(source);
        }
        let of_group = |(stretches, sources): (TrialSegments, Vec<&'w ChangeSource>)| {
            let zeros = |source: &&ChangeSource| {
                SourceProducts::zeros(1 + self.kept, stretches.count * source.columns.len())
            };
            let mut products: Vec<SourceProducts> = sources.iter().map(zeros).collect();
            for kept in &trial.parts {
                add_segment_products(kept, &sources, stretches, &mut products);
            }
            let all = sources.into_iter().zip(products);
            all.map(|(source, products)| (source, stretches, products)).collect::<Vec<_>>()
        };
        let groups: Vec<_> = alike.into_values().collect();
        groups.into_par_iter().flat_map_iter(of_group).collect()
    }

    /// The most evident change of a source, where it explains all that remains of a trial.
    fn source_change(
        &self,
        trial: &KeptTrial<'_>,
        (source, stretches, products): (&ChangeSource, TrialSegments, &SourceProducts),
        least_evidence: f64,
    ) -> Result<Option<EffectChange>, RefineError> {
        // Windows at the segments' ends first; the time of the best one is then refined.
        let coarse = self.segment_windows(trial, source, (stretches, products))?;
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
        trial: &KeptTrial<'_>,
        source: &'w ChangeSource,
        (stretches, products): (TrialSegments, &SourceProducts),
    ) -> Result<Vec<WeighedChange<'w>>, RefineError> {
        let cut = trial.reduced.information(&products.cross, &products.own)?;
        let of = |window: ChangeWindow| {
            let spread = stretches.window_matrix(window, source.columns.len());
            weigh_window(source, window, cut.transform_columns(&spread), stretches)
        };
        Ok(stretches.all_windows().into_iter().filter_map(of).collect())
    }

    /// Windows of a source at times between the neighbours of one.
    fn refined_windows<'w>(
        &self,
        trial: &KeptTrial<'_>,
        source: &'w ChangeSource,
        stretches: TrialSegments,
        about: ChangeWindow,
    ) -> Result<Vec<WeighedChange<'w>>, RefineError> {
        let windows = stretches.neighbouring_windows(about);
        let shares = |t_s: f64| {
            windows.iter().map(|window| window.share_at(t_s, stretches.span_s)).collect()
        };
        let SourceProducts { cross, own } = self.weighted_columns(trial, source, &shares).products;
        let cut = trial.reduced.information(&cross, &own)?;
        let parameters = source.columns.len();
        // Columns are ordered by parameter, then by window.
        let of = |(at, window): (usize, &ChangeWindow)| {
            let own = (0..parameters).map(|parameter| parameter * windows.len() + at);
            weigh_window(source, *window, cut.select_columns(&own.collect::<Vec<_>>()), stretches)
        };
        Ok(windows.iter().enumerate().filter_map(of).collect())
    }

    /// A trial with its filter and the columns that are present with any change.
    fn kept_trial(&self, place: usize) -> Result<KeptTrial<'_>, RefineError> {
        let mut gram = GramMatrix::zeros(1 + self.kept);
        let mut parts = Vec::new();
        for part in &self.workspace.linearised_parts()[place] {
            let gains = FilterGains::new(part, &self.workspace.noise, &self.discrepancies)?;
            let columns = gains.whiten_columns(part, self.kept);
            gram.add(&columns.gram_matrix());
            parts.push(KeptPart { part, gains, columns });
        }
        let reduced = ReducedTrial::new(&gram, &self.search.fixed, &self.taken)?;
        Ok(KeptTrial { place, parts, reduced })
    }

    /// Columns of a source, each once for every weight of a time.
    fn weighted_columns(
        &self,
        trial: &KeptTrial<'_>,
        source: &ChangeSource,
        weights: &dyn Fn(f64) -> Vec<f64>,
    ) -> WeightedColumns {
        let of = |kept: &KeptPart<'_>| {
            let part = kept.part.weight_columns(&[], &source.columns, weights);
            kept.gains.whiten_columns(&part, part.sizes.columns)
        };
        let parts: Vec<WhitenedColumns> = trial.parts.iter().map(of).collect();
        let own = parts.first().map_or(0, |part| part.column_count() - 1);
        let mut products = SourceProducts::zeros(1 + self.kept, own);
        for (kept, part) in trial.parts.iter().zip(&parts) {
            let readings = 0..part.reading_count();
            // The first column is the residual again.
            let cross = kept.columns.products_with(part, readings.clone());
            products.cross += cross.columns(1, own);
            products.own += part.own_products(readings).view((1, 1), (own, own));
        }
        WeightedColumns { parts, products }
    }

    /// Unexplained remainder of a trial with a change.
    fn remaining_with(
        &self,
        trial: &KeptTrial<'_>,
        stretches: TrialSegments,
        change: &WeighedChange<'_>,
    ) -> Result<Vec<UnexplainedSegment>, RefineError> {
        let WeighedChange { source, window, .. } = change;
        let weight = |t_s: f64| vec![window.share_at(t_s, stretches.span_s)];
        let changed = self.weighted_columns(trial, source, &weight);
        let places: Vec<usize> = (0..source.columns.len()).collect();
        let SourceProducts { cross, own } = &changed.products;
        let size =
            trial.reduced.information(cross, own)?.estimate_parameters(&places, &source.priors);
        let size = size.ok_or_else(not_positive_error)?.mean;
        let known = trial.reduced.known_parameters(cross, &size)?;
        // What is explained is subtracted from the residual, which is the first column.
        let explained: Vec<f64> =
            std::iter::once(1.0).chain(known.iter().map(|own| -own)).collect();
        let open: Vec<f64> = std::iter::once(0.0).chain(self.open.iter().copied()).collect();
        let by_change = |by: f64| -> Vec<f64> {
            std::iter::once(0.0).chain(size.iter().map(|size| by * size)).collect()
        };
        // The error of the change's own law is allowed for as well.
        let (explained_by, open_by) = (by_change(-1.0), by_change(source.misfit));
        let errors: Vec<PartErrors> = trial
            .parts
            .iter()
            .zip(&changed.parts)
            .map(|(kept, own)| PartErrors {
                left: add_sums((&kept.columns, &explained), (own, &explained_by)),
                moved: add_sums((&kept.columns, &open), (own, &open_by)),
            })
            .collect();
        let parts: Vec<&LinearisedPart> = trial.parts.iter().map(|kept| kept.part).collect();
        let clean = self.search.model.uncertainty.as_ref().map(|known| &known.remainder);
        let name = &self.workspace.trials[trial.place].name;
        Ok(unexplained_by_errors((self.workspace, name), &parts, &errors, clean))
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

/// Sum at each reading of columns by their weights, and of others by theirs.
fn add_sums(
    (columns, weights): (&WhitenedColumns, &[f64]),
    (others, by): (&WhitenedColumns, &[f64]),
) -> Vec<f64> {
    let mut sum = columns.weighted_sum(weights);
    sum.iter_mut().zip(others.weighted_sum(by)).for_each(|(sum, other)| *sum += other);
    sum
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
