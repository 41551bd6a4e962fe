//! Whether a learned branch is taken beside what was chosen.
//!
//! The chosen model was fitted on all trials, of which the branch is judged on those left out of
//! its training: it is the model without a branch which this favours.

use sistership_identification::refine::{Progress, RefineError, ReplayedTrials, Thinning};
use sistership_learned::{BranchChoice, BranchKind, BranchSettings, Kinds, TrainError, choose};
use sistership_model::trial::Trial;
use sistership_model::{Law, Model};

use crate::thresholds::SEARCH;

/// Tries kinds of branches beside a model, with as many samples as simulations need; few trials
/// leave too little out.
///
/// # Errors
/// It was cancelled.
pub(super) fn branch(
    (model, law): (&Model, &Law),
    lpp_m: Option<f64>,
    trials: &[&Trial],
    progress: Progress<'_>,
) -> Result<BranchChoice, RefineError> {
    if trials.len() < SEARCH.branch_trials {
        return Ok(BranchChoice::untried(few(trials.len())));
    }
    let by = Thinning { economical: true, smoothing_s: None };
    let replayed = ReplayedTrials::new(law, lpp_m, trials, by);
    let kinds = Kinds::WhilePromising { step_s: replayed.step_s };
    let replayed: Vec<&Trial> = replayed.trials.iter().collect();
    let settings = BranchSettings::default();
    let told = |kind: BranchKind| {
        progress(0.99, &format!("fitting a learned correction: {}", kind.name()))
    };
    match choose(model, law, &replayed, (&settings, kinds), &told) {
        Ok(choice) => choice.ok_or(RefineError::Cancelled),
        Err(error) => Ok(BranchChoice::untried(untrained(&error))),
    }
}

fn few(trials: usize) -> String {
    format!(
        "none was tried: of {trials} trials too few can be left out of its training, {} are \
        asked",
        SEARCH.branch_trials
    )
}

fn untrained(error: &TrainError) -> String {
    format!("none can be trained: {error}")
}
