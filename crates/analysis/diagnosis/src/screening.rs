//! Screening of each effect, together with the accepted ones, by one linearisation.

use rayon::prelude::*;

use super::evidence::{MarginalInformation, NormalPrior};
use super::filtered_base::FilteredBase;
use super::hypothesis::candidate_priors;
use super::search::HypothesisSearch;
use sistership_filtering::EffectCandidate;
use sistership_identification::refine::RefineError;

/// An effect that may be missing, by one linearisation.
#[derive(Clone)]
pub(super) struct ScreenedEffect {
    pub evidence: f64,
    /// Evidence discounted by the effect's false-alarm level.
    pub discounted: f64,
    /// Level of the discrepancy at which it is most probable, among those of the base.
    pub level: usize,
    pub candidate: EffectCandidate,
}

/// Returns the evidence of each other effect together with the accepted ones, from one
/// linearisation at the absence of all others, most probable first. Effects on which the trials'
/// information is not positive are omitted.
///
/// # Errors
/// Returns an error if the information on the coefficients is not positive.
pub(super) fn screen_effects(
    search: &HypothesisSearch<'_>,
    base: &FilteredBase<'_>,
) -> Result<Vec<ScreenedEffect>, RefineError> {
    let others = search.other_candidates(&base.taken);
    let showing =
        |candidate: &&EffectCandidate| base.workspace.columns().matching_columns(candidate);
    let columns =
        base.taken.iter().flat_map(|kept| showing(&kept)).chain(others.iter().flat_map(showing));
    let places: Vec<usize> = (0..search.nuisance.len()).chain(columns).collect();
    let all: Vec<EffectCandidate> =
        base.taken.iter().chain(others.iter().copied()).cloned().collect();
    let at_level = |level: usize| {
        let total = base.total_products(level).select_columns(&places);
        let mut reduced = MarginalInformation::new(&total, &search.fixed)?;
        if !search.history.forms.is_empty() {
            search.history.add_to(&mut reduced, &all);
        }
        Ok((level, reduced))
    };
    let reduced: Vec<(usize, MarginalInformation)> =
        (0..base.levels.len()).into_par_iter().map(at_level).collect::<Result<_, RefineError>>()?;
    Ok(screen_candidates(search, base, &others, &reduced))
}

fn screen_candidates(
    search: &HypothesisSearch<'_>,
    base: &FilteredBase<'_>,
    others: &[&EffectCandidate],
    reduced: &[(usize, MarginalInformation)],
) -> Vec<ScreenedEffect> {
    // Columns of the information: those of the accepted effects first, then each candidate's in
    // turn.
    let kept: Vec<usize> = (0..base.taken.iter().map(|kept| kept.at.len()).sum()).collect();
    let mut first = kept.len();
    let mut one = |candidate: &&EffectCandidate| {
        let places: Vec<usize> =
            kept.iter().copied().chain(first..first + candidate.at.len()).collect();
        first += candidate.at.len();
        let fixing: Vec<NormalPrior> =
            base.taken.iter().chain([*candidate]).flat_map(candidate_priors).collect();
        let reduced = considered_levels(base, reduced, candidate);
        let gain = |(level, reduced): &&(usize, MarginalInformation)| {
            let gain = reduced.estimate_parameters(&places, &fixing)?.gain;
            Some((base.levels[*level].level.log_prior - 0.5 * reduced.deviance + gain, *level))
        };
        let (evidence, level) =
            reduced.iter().filter_map(gain).max_by(|a, b| a.0.total_cmp(&b.0))?;
        let own = (&places[kept.len()..], *candidate);
        let discounted = discounted_evidence(
            &reduced,
            (&kept, &base.taken),
            own,
            search.candidate_discount(candidate),
        )?;
        let prior = search.log_prior(candidate);
        Some(ScreenedEffect {
            evidence: evidence + prior,
            discounted: discounted + prior,
            level,
            candidate: (*candidate).clone(),
        })
    };
    let mut screened: Vec<ScreenedEffect> = others.iter().filter_map(&mut one).collect();
    screened.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    screened
}

/// Levels that are considered for a candidate, with the information of the trials at each.
fn considered_levels<'r>(
    base: &FilteredBase<'_>,
    reduced: &'r [(usize, MarginalInformation)],
    candidate: &EffectCandidate,
) -> Vec<&'r (usize, MarginalInformation)> {
    let is_weighed = |(level, _): &&(usize, MarginalInformation)| {
        base.levels[*level].level.is_weighed(Some(candidate))
    };
    reduced.iter().filter(is_weighed).collect()
}

/// Discounted evidence of an effect together with those of a base, at the level with the least
/// evidence.
fn discounted_evidence(
    reduced: &[&(usize, MarginalInformation)],
    (kept, taken): (&[usize], &[EffectCandidate]),
    (own, candidate): (&[usize], &EffectCandidate),
    discount: f64,
) -> Option<f64> {
    let others: Vec<NormalPrior> = taken.iter().flat_map(candidate_priors).collect();
    let fixing = candidate_priors(candidate);
    let columns: Vec<usize> = (0..own.len()).collect();
    let gain = |(_, reduced): &&(usize, MarginalInformation)| {
        let given = reduced.marginalise_others(kept, &others, own)?.divide_by(discount);
        Some(given.estimate_parameters(&columns, &fixing)?.gain)
    };
    // The least over levels: evidence at one level only is not reliable.
    reduced.iter().filter_map(gain).min_by(f64::total_cmp)
}
