//! Continuation of the history of a ship's effects by the trials of a diagnosis.

use super::discount::is_external;
use super::effect_history::{EffectHistory, FormHistory};
use super::evidence::MarginalInformation;
use super::filtered_base::FilteredBase;
use super::hypothesis::candidate_priors;
use super::search::HypothesisSearch;
use sistership_filtering::EffectCandidate;
use sistership_identification::refine::RefineError;

/// Effects that differ from day to day: they do not belong to the ship, and no earlier trial says
/// of them.
const EFFECTS_OF_A_DAY: [&str; 4] = ["current", "wind", "wave-drift", "shallow-water"];

/// Returns the history of the effects after the trials of a diagnosis. `base` is the one without
/// effects, at one of whose levels the trials are read; `named` are the effects found.
///
/// # Errors
/// Returns an error if the information is not positive.
pub(super) fn continue_history(
    search: &HypothesisSearch<'_>,
    (base, level): (&FilteredBase<'_>, usize),
    named: &[String],
) -> Result<EffectHistory, RefineError> {
    let (candidates, new) = trial_information(search, base, level)?;
    // Forms that the library has gained since have no information yet.
    let (mut before, mut right) = search.history.candidate_information(&candidates);
    let (mut forms, mut first) = (Vec::new(), 0);
    for candidate in &candidates {
        let own: Vec<usize> = (first..first + candidate.at.len()).collect();
        first += candidate.at.len();
        let all = MarginalInformation {
            information: &new.information + &before,
            right: &new.right + &right,
            ..new.clone()
        };
        let begins = begins_now(search, candidate, (&all, &new), &own);
        if begins {
            // Its columns are zero on the earlier trials.
            for &place in &own {
                before.row_mut(place).fill(0.0);
                before.column_mut(place).fill(0.0);
                right[place] = 0.0;
            }
        }
        forms.push(continue_form(search, candidate, begins, named));
    }
    let (information, right) = (&new.information + before, &new.right + right);
    let rows = 0..right.len();
    Ok(EffectHistory {
        model: search.model.name.clone(),
        forms,
        information: rows
            .flat_map(|i| (0..=i).map(move |j| (i, j)))
            .map(|at| information[at])
            .collect(),
        right: right.iter().copied().collect(),
    })
}

/// Returns the history without the forms of which these trials say that their effects begin now.
///
/// # Errors
/// Returns an error if the information is not positive.
pub(super) fn history_before(
    search: &HypothesisSearch<'_>,
    (base, level): (&FilteredBase<'_>, usize),
) -> Result<EffectHistory, RefineError> {
    let mut history = search.history.clone();
    if history.forms.is_empty() {
        return Ok(history);
    }
    let (candidates, new) = trial_information(search, base, level)?;
    let (before, right) = history.candidate_information(&candidates);
    let all = MarginalInformation {
        information: &new.information + before,
        right: &new.right + right,
        ..new.clone()
    };
    let mut first = 0;
    for candidate in &candidates {
        let own: Vec<usize> = (first..first + candidate.at.len()).collect();
        first += candidate.at.len();
        if begins_now(search, candidate, (&all, &new), &own) {
            history.clear_form(candidate);
        }
    }
    Ok(history)
}

/// Lasting effects, and the information of the trials on them at the absence of all.
fn trial_information(
    search: &HypothesisSearch<'_>,
    base: &FilteredBase<'_>,
    level: usize,
) -> Result<(Vec<EffectCandidate>, MarginalInformation), RefineError> {
    // An effect that follows an external record is judged by the record of its own day.
    let lasts = |candidate: &&EffectCandidate| {
        !is_external(candidate) && !EFFECTS_OF_A_DAY.contains(&candidate.effect.as_str())
    };
    let candidates: Vec<EffectCandidate> = search.listed.iter().filter(lasts).cloned().collect();
    let columns = candidates.iter().flat_map(|one| base.workspace.columns().matching_columns(one));
    let places: Vec<usize> = (0..search.nuisance.len()).chain(columns).collect();
    // Products of all columns exist already: no trial is filtered again.
    let total = base.total_products(level).select_columns(&places);
    let new = MarginalInformation::new(&total, &search.fixed)?;
    Ok((candidates, new))
}

/// Returns true if the newest trials alone are at least as evident for an effect as all of them.
fn begins_now(
    search: &HypothesisSearch<'_>,
    candidate: &EffectCandidate,
    (all, new): (&MarginalInformation, &MarginalInformation),
    own: &[usize],
) -> bool {
    // The prior counts once in either: the comparison is one of the trials alone.
    let priors = candidate_priors(candidate);
    let gain = |says: &MarginalInformation| {
        let says = says.select_columns(own).divide_by(search.candidate_discount(candidate));
        let places: Vec<usize> = (0..own.len()).collect();
        says.estimate_parameters(&places, &priors).map_or(f64::NEG_INFINITY, |one| one.gain)
    };
    gain(new) >= gain(all)
}

fn continue_form(
    search: &HypothesisSearch<'_>,
    candidate: &EffectCandidate,
    begins: bool,
    named: &[String],
) -> FormHistory {
    let key = candidate.candidate_key();
    let known = search.history.forms.iter().find(|form| form.key == key);
    let trial = |trial: Option<&&sistership_model::Trial>| {
        trial.map(|trial| trial.name.clone()).unwrap_or_default()
    };
    // A new beginning forgets the count, not when the effect was last named.
    let kept = known.filter(|_| !begins);
    FormHistory {
        parameters: candidate.at.len(),
        trials: search.trials.len() + kept.map_or(0, |known| known.trials),
        since: kept.map_or_else(|| trial(search.trials.first()), |known| known.since.clone()),
        last_seen: match named.contains(&candidate.effect) {
            true => Some(trial(search.trials.last())),
            false => known.and_then(|known| known.last_seen.clone()),
        },
        key,
    }
}
