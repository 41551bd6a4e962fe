//! Changes in time: for a trial with an unexplained remainder, the effect that begins, ends or
//! drifts within it, or that this trial alone has.
//!
//! A trial is divided into segments, and the columns of each effect with it: sums of segments are
//! the columns of the effect in any window of time, so that one filtering of the trial evaluates
//! all of them. Coefficients and the effects that are already present may adjust within their
//! uncertainty.

mod reduced_trial;
mod segment_products;
mod source;
mod trial_changes;
mod windows;

use std::collections::BTreeMap;

use super::hypothesis::JudgedHypothesis;
use super::outcome::{ChangeCourse, EffectChange, UnexplainedSegment};
use super::search::HypothesisSearch;
use super::thresholds::THRESHOLDS;
use sistership_filtering::EffectCandidate;
use sistership_identification::refine::RefineError;

use trial_changes::ChangeSearch;

/// Returns the changes of one effect that explain the remainder, the most evident first: of the
/// effect that explains most trials by the most evidence. Returns none where it explains fewer than
/// half of the trials with a remainder, as such an effect only resembles the missing one, or where
/// it is present throughout most trials, with a different size in each. Of many such trials those
/// with the largest remainders are examined. `listed` are the effects that were evaluated,
/// including those that were refused because they are not constant.
///
/// # Errors
/// Returns an error that names what a trial lacks.
pub(super) fn find_changes(
    (search, best, listed): (&HypothesisSearch<'_>, &JudgedHypothesis, &[EffectCandidate]),
    remaining: &[UnexplainedSegment],
    least_evidence: f64,
) -> Result<Vec<EffectChange>, RefineError> {
    if remaining.is_empty() {
        return Ok(Vec::new());
    }
    let workspace = search.prepare_trials(change_columns(search, best, listed))?;
    let changing = ChangeSearch::new(search, best, &workspace);
    let place = |name: &String| workspace.trials.iter().position(|trial| trial.name == *name);
    // In the order of the remainders, the largest first.
    let asked: Vec<usize> = trials_with_remainder(remaining).iter().filter_map(place).collect();
    let asked = &asked[..asked.len().min(THRESHOLDS.changes.asked)];
    let found =
        select_common_effect(changes_per_trial(&changing, asked, least_evidence)?, least_evidence);
    // A change throughout most trials is a permanent effect of varying size, no change in time.
    let whole = found.iter().filter(|change| change.course == ChangeCourse::Throughout).count();
    let is_change = whole as f64 <= THRESHOLDS.changes.throughout * workspace.trials.len() as f64;
    Ok(if is_change { found } else { Vec::new() })
}

/// Names of trials with a remainder, those with the largest first.
pub(super) fn trials_with_remainder(remaining: &[UnexplainedSegment]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for stretch in remaining {
        if !names.contains(&stretch.trial) {
            names.push(stretch.trial.clone());
        }
    }
    names
}

/// Changes that explain each trial, of effects that may still explain enough of them.
fn changes_per_trial(
    changing: &ChangeSearch<'_, '_>,
    asked: &[usize],
    least: f64,
) -> Result<Vec<Vec<EffectChange>>, RefineError> {
    let mut each: Vec<Vec<EffectChange>> = Vec::new();
    for &place in asked {
        let to_come = asked.len() - each.len();
        let explained = |effect: &str| {
            let of_effect =
                |changes: &&Vec<EffectChange>| changes.iter().any(|one| one.effect == effect);
            each.iter().filter(of_effect).count()
        };
        // An effect is dropped as soon as the trials to come cannot make it explain enough.
        let may_be = |effect: &str| is_enough(explained(effect) + to_come, asked.len());
        each.push(changing.trial_changes(place, least, &may_be)?);
    }
    Ok(each)
}

/// Returns true if the changes of an effect explain enough of the trials.
fn is_enough(trials: usize, of: usize) -> bool {
    trials as f64 >= THRESHOLDS.changes.trials * of as f64
}

/// Changes of the effect that explains most trials, with the other effects that are as likely.
fn select_common_effect(each: Vec<Vec<EffectChange>>, least_evidence: f64) -> Vec<EffectChange> {
    let mut effects: BTreeMap<String, (usize, f64)> = BTreeMap::new();
    for change in each.iter().flatten() {
        let (trials, evidence) = effects.entry(change.effect.clone()).or_default();
        (*trials, *evidence) = (*trials + 1, *evidence + change.evidence);
    }
    // By the number of trials first, then by the evidence.
    let taken = effects.iter().max_by(|a, b| a.1.0.cmp(&b.1.0).then(a.1.1.total_cmp(&b.1.1)));
    let Some((effect, &(trials, evidence))) = taken else { return Vec::new() };
    if !is_enough(trials, each.len()) {
        return Vec::new();
    }
    // Effects that explain as many trials with nearly the same evidence are alternatives.
    let is_near = |(name, (of, own)): &(&String, &(usize, f64))| {
        *name != effect && *of == trials && evidence - own < least_evidence * trials as f64
    };
    let or: Vec<String> = effects.iter().filter(is_near).map(|(name, _)| name.clone()).collect();
    let of_taken = each.into_iter().flatten().filter(|change| change.effect == *effect);
    let mut found: Vec<EffectChange> =
        of_taken.map(|change| EffectChange { or: or.clone(), ..change }).collect();
    found.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    found
}

/// Effects that are present, at their estimates, and all others at their absence.
fn change_columns(
    search: &HypothesisSearch<'_>,
    best: &JudgedHypothesis,
    listed: &[EffectCandidate],
) -> Vec<EffectCandidate> {
    let is_other = |candidate: &&EffectCandidate| {
        !best.candidates.iter().any(|taken| taken.effect == candidate.effect)
    };
    let others = listed.iter().filter(is_other).chain(&search.changing);
    best.candidates.iter().chain(others).cloned().collect()
}
