//! Trials as the search among hypotheses reads them: means over intervals in which the ship hardly
//! moves, where each reading has a noise of its own.

use sistership_filtering::average_trial;
use sistership_identification::refine::RefineError;
use sistership_model::{Trial, particulars};
use sistership_priors::transfer::trial_approach;

use super::DiagnosisInputs;
use super::calibrated_model::CalibratedModel;
use super::linearised_trials::LinearisedTrials;
use super::nuisance::TermForms;
use super::thresholds::THRESHOLDS;

/// Returns the means of all trials; none where a recorder has smoothed its readings, or where no
/// interval has two samples.
///
/// # Errors
/// Returns an error that names what the model lacks.
pub(super) fn averaged_trials(
    request: &DiagnosisInputs<'_>,
) -> Result<Option<Vec<Trial>>, RefineError> {
    let known = request.model.uncertainty.as_ref().map_or(0.0, |known| known.reading_interval_s);
    let model = CalibratedModel::new(request.model, request.law, &TermForms::new(), &[], &[])?;
    let interval_s = LinearisedTrials::independent_interval_s(&model, request.trials)?;
    let approach = trial_approach(request.trials).map(|approach| approach.speed_m_s);
    let length_m = particulars::particular_value(&request.model.particulars, "lpp_m");
    let is_white = known.max(interval_s) == 0.0;
    let (Some(speed_m_s), Some(length_m), true) =
        (approach.or(request.model.speed_m_s), length_m, is_white)
    else {
        return Ok(None);
    };
    let length_s = length_m / speed_m_s;
    let step_s = request.settings.least_step_s.unwrap_or(THRESHOLDS.trials.mean * length_s);
    let settles_s = THRESHOLDS.trials.settles * length_s;
    let means = |trial: &&Trial| average_trial(trial, step_s, settles_s);
    // All trials or none, so that they have one noise model.
    Ok(request.trials.iter().map(means).collect())
}
