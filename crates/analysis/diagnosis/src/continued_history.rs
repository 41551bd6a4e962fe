//! Continuation of the history of a ship's effects by the trials of a diagnosis.

use super::discount::is_external;
use super::effect_history::{EffectHistory, FormHistory};
use super::evidence::{MarginalInformation, NormalPrior};
use super::filtered_base::FilteredBase;
use super::hypothesis::candidate_priors;
use super::search::HypothesisSearch;
use sistership_filtering::EffectCandidate;
use sistership_identification::refine::RefineError;
use sistership_model::sample_hash::sample_hash;

/// Returns the history of the effects after the trials of a diagnosis. `base` is the one without
/// effects, at one of whose levels the trials are read; `named` are the effects found.
///
/// # Errors
/// Returns an error if the information is not positive.
pub(super) fn continue_history(
    search: &HypothesisSearch<'_>,
    (base, level): (&FilteredBase<'_>, usize),
    named: &[String],
    least_evidence: f64,
) -> Result<EffectHistory, RefineError> {
    let WeighedHistory { candidates, new, before, begin } =
        WeighedHistory::weigh(search, (base, level), least_evidence)?;
    let each = candidates.iter().zip(&begin);
    let forms = each.map(|(one, &begins)| continue_form(search, one, begins, named)).collect();
    let (information, right) = (&new.information + before.information, &new.right + before.right);
    let rows = 0..right.len();
    let hashes = search.trials.iter().map(|trial| sample_hash(trial));
    Ok(EffectHistory {
        model: search.model.name.clone(),
        forms,
        information: rows
            .flat_map(|i| (0..=i).map(move |j| (i, j)))
            .map(|at| information[at])
            .collect(),
        right: right.iter().copied().collect(),
        samples: search.history.samples.iter().cloned().chain(hashes).collect(),
    })
}

/// Returns the history without the forms of which these trials say that their effects begin or end
/// now.
///
/// # Errors
/// Returns an error if the information is not positive.
pub(super) fn history_before(
    search: &HypothesisSearch<'_>,
    at: (&FilteredBase<'_>, usize),
    least_evidence: f64,
) -> Result<EffectHistory, RefineError> {
    let mut history = search.history.clone();
    if history.forms.is_empty() {
        return Ok(history);
    }
    let WeighedHistory { candidates, before, begin, .. } =
        WeighedHistory::weigh(search, at, least_evidence)?;
    // Forms of other libraries stay as they are.
    history.set_information(&candidates, &before);
    let begun = candidates.iter().zip(begin).filter(|(_, begins)| *begins);
    begun.for_each(|(candidate, _)| history.forget_trials(candidate));
    Ok(history)
}

/// Earlier information, weighed against that of new trials.
struct WeighedHistory {
    /// Lasting effects.
    candidates: Vec<EffectCandidate>,
    /// Information of the new trials.
    new: MarginalInformation,
    /// Information of the earlier trials, without effects that begin or end now.
    before: MarginalInformation,
    /// Of each candidate: true if its effect begins or ends with the new trials.
    begin: Vec<bool>,
}

impl WeighedHistory {
    fn weigh(
        search: &HypothesisSearch<'_>,
        (base, level): (&FilteredBase<'_>, usize),
        least_evidence: f64,
    ) -> Result<Self, RefineError> {
        let (candidates, new) = trial_information(search, base, level)?;
        // Forms that the library has gained since have no information yet.
        let (information, right) = search.history.candidate_information(&candidates);
        let before = MarginalInformation { information, right, ..new.clone() };
        let all = MarginalInformation {
            information: &new.information + &before.information,
            right: &new.right + &before.right,
            ..new.clone()
        };
        let (mut first, mut begin, mut kept) = (0, Vec::new(), before.clone());
        for candidate in &candidates {
            let own: Vec<usize> = (first..first + candidate.at.len()).collect();
            first += candidate.at.len();
            let gain = |says: &MarginalInformation| form_gain(search, candidate, says, &own);
            let (of_new, of_all, of_before) = (gain(&new), gain(&all), gain(&before));
            // Two sizes, or one and none, must be as much more evident than one size for all trials
            // as an effect must be to be named.
            let ends = of_before + of_new.max(0.0) > of_all + least_evidence;
            let begins = ends || of_new >= of_all;
            if begins {
                leave_form_out(&mut kept, &own, ends.then(|| candidate_priors(candidate)));
            }
            begin.push(begins);
        }
        Ok(Self { candidates, new, before: kept, begin })
    }
}

/// Leaves a form out of earlier information: its columns are zero on trials without its effect. An
/// effect that has ended since is integrated out under its priors; otherwise another effect that
/// resembles it would be seen in its place.
fn leave_form_out(
    before: &mut MarginalInformation,
    own: &[usize],
    present: Option<Vec<NormalPrior>>,
) {
    let others: Vec<usize> = (0..before.right.len()).filter(|place| !own.contains(place)).collect();
    let left = present.and_then(|priors| before.marginalise_others(own, &priors, &others));
    // The columns of an absent effect are zero.
    for &place in own {
        before.information.row_mut(place).fill(0.0);
        before.information.column_mut(place).fill(0.0);
        before.right[place] = 0.0;
    }
    let Some(left) = left else { return };
    for (i, &row) in others.iter().enumerate() {
        before.right[row] = left.right[i];
        for (j, &column) in others.iter().enumerate() {
            before.information[(row, column)] = left.information[(i, j)];
        }
    }
}

/// Lasting effects, and the information of the trials on them at the absence of all.
fn trial_information(
    search: &HypothesisSearch<'_>,
    base: &FilteredBase<'_>,
    level: usize,
) -> Result<(Vec<EffectCandidate>, MarginalInformation), RefineError> {
    // An effect that follows an external record is judged by the record of its own day.
    let lasts = |candidate: &&EffectCandidate| {
        !is_external(candidate) && !search.daily.contains(&candidate.effect)
    };
    let candidates: Vec<EffectCandidate> = search.listed.iter().filter(lasts).cloned().collect();
    let columns = candidates.iter().flat_map(|one| base.workspace.columns().matching_columns(one));
    let places: Vec<usize> = (0..search.nuisance.len()).chain(columns).collect();
    // Products of all columns exist already: no trial is filtered again.
    let total = base.total_products(level).select_columns(&places);
    let new = MarginalInformation::new(&total, &search.fixed)?;
    Ok((candidates, new))
}

/// Logarithm of the evidence of information for a form; its priors count once, so that comparisons
/// are of the trials alone.
fn form_gain(
    search: &HypothesisSearch<'_>,
    candidate: &EffectCandidate,
    says: &MarginalInformation,
    own: &[usize],
) -> f64 {
    let says = says.select_columns(own).divide_by(search.candidate_discount(candidate));
    let places: Vec<usize> = (0..own.len()).collect();
    let estimate = says.estimate_parameters(&places, &candidate_priors(candidate));
    estimate.map_or(f64::NEG_INFINITY, |one| one.gain)
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
