//! Choice of a learned correction for the chosen model.
//!
//! A correction is judged on trials that neither it nor its base model has seen: the base models
//! are those of the chosen candidate's folds, and the corrections are trained with them on the same
//! trials. The best one must be significantly better there (95 %), complete the manoeuvres that
//! every model must complete, leave the standard manoeuvres no less certain, and be no worse where
//! the trials of the largest and smallest rudder angles and speeds are held out
//! ([`crate::correction`]).

use sistership_identification::refine::{Progress, RefineError, ReplayedTrials};
use sistership_learned::{
    BranchChoice, BranchKind, BranchSettings, HeldOutTrials, KindSearch, TrainError, select_kind,
};
use sistership_model::trial::Trial;

use crate::correction::Correction;
use crate::foundation::CorrectionBase;
use crate::thresholds::SEARCH;

/// Tries kinds of corrections for a model, with as many samples as simulations need; none if there
/// are too few trials to hold any out.
///
/// # Errors
/// Returns an error if it was cancelled.
pub(super) fn choose_correction(
    foundation: &CorrectionBase<'_>,
    progress: Progress<'_>,
) -> Result<BranchChoice, RefineError> {
    let (request, trials) = (&foundation.request, foundation.trials);
    if trials.len() < SEARCH.branch_trials {
        return Ok(BranchChoice::without_evaluation(too_few_trials(trials.len())));
    }
    // Without folds there is no base model that has not seen a trial.
    let folds = foundation.held_out_folds();
    if folds.is_empty() {
        return Ok(BranchChoice::without_evaluation(IN_PARTS.to_owned()));
    }
    let lpp_m = request.target.particular("lpp_m");
    let replayed = ReplayedTrials::new(request.law, lpp_m, trials, None);
    let kinds = KindSearch::WhilePromising { step_s: replayed.step_s };
    let thinned: Vec<&Trial> = replayed.trials.iter().collect();
    let on = HeldOutTrials { law: request.law, trials: &thinned, folds: &folds };
    let model = &foundation.refinement.model;
    let settings = BranchSettings::default();
    let told = |kind: BranchKind| {
        progress(0.99, &format!("fitting a learned correction: {}", kind.name()))
    };
    let choice = match select_kind(model, &on, (&settings, kinds), &told) {
        // `None` is a cancelled training; a correction that cannot be trained is no error of the
        // search.
        Ok(choice) => choice.ok_or(RefineError::Cancelled)?,
        Err(error) => return Ok(BranchChoice::without_evaluation(training_failure(&error))),
    };
    let Some(kind) = choice.taken else { return Ok(choice) };
    if !progress(0.99, &format!("checking the learned correction: {}", kind.name())) {
        return Err(RefineError::Cancelled);
    }
    let correction = Correction { foundation, on, kind, step_s: replayed.step_s };
    Ok(correction
        .run_checks(choice)
        .unwrap_or_else(|error| BranchChoice::without_evaluation(training_failure(&error))))
}

const IN_PARTS: &str = "not considered: only parts of trials were held out, so that no trial is \
                        unknown to all models";

fn too_few_trials(trials: usize) -> String {
    format!(
        "not considered: {trials} trials are too few to train and test a correction; at least {} \
         are needed",
        SEARCH.branch_trials
    )
}

fn training_failure(error: &TrainError) -> String {
    format!("training failed: {error}")
}
