//! Whether an effect that follows a record follows it: the record of another time must not do as
//! well.

use sistership_model::Trial;

use super::discount::{OUTSIDE, is_from_outside};
use super::filtered_base::FilteredBase;
use super::hypothesis::JudgedHypothesis;
use super::search::HypothesisSearch;
use super::thresholds::THRESHOLDS;
use sistership_estimate::refine::RefineError;

/// Whether the effect that came last follows a record from outside, and records of another time
/// explain the trials better.
///
/// # Errors
/// Names what a trial lacks.
pub(super) fn is_placebo(
    search: &HypothesisSearch<'_>,
    judged: &JudgedHypothesis,
    base: &FilteredBase<'_>,
) -> Result<bool, RefineError> {
    let Some(last) = judged.candidates.last().filter(|candidate| is_from_outside(candidate)) else {
        return Ok(false);
    };
    let again = |search: &HypothesisSearch<'_>| {
        let there = search.bare(&base.taken, &search.levels)?;
        Ok(search.judge(&there, last, judged.level)?.log_evidence)
    };
    exceeds(search, judged.log_evidence, &again)
}

/// Whether effects explain the trials better, by a margin, than with records from outside of any
/// other time.
///
/// # Errors
/// Names what a trial lacks.
pub(super) fn follow_records(
    search: &HypothesisSearch<'_>,
    judged: &JudgedHypothesis,
    margin: f64,
) -> Result<bool, RefineError> {
    let again = |search: &HypothesisSearch<'_>| {
        let there = search.bare(&judged.candidates, &search.levels)?;
        Ok(search.alone(&there)?.1.log_evidence)
    };
    Ok(!exceeds(search, judged.log_evidence - margin, &again)?)
}

/// Whether with the records of any other time the evidence is more than so much.
fn exceeds(
    search: &HypothesisSearch<'_>,
    limit: f64,
    evidence: &dyn Fn(&HypothesisSearch<'_>) -> Result<f64, RefineError>,
) -> Result<bool, RefineError> {
    for share in THRESHOLDS.effect.placebo_shifts {
        let shifted: Vec<Trial> = search.trials.iter().map(|trial| shifted(trial, share)).collect();
        let trials: Vec<&Trial> = shifted.iter().collect();
        if evidence(&HypothesisSearch { trials: &trials, ..search.clone() })? > limit {
            return Ok(true);
        }
    }
    Ok(false)
}

/// A trial with its records of what is outside shifted by a share of it; their ends are joined.
fn shifted(trial: &Trial, share: f64) -> Trial {
    let mut trial = trial.clone();
    for channel in OUTSIDE {
        if let Some(values) = trial.channels.get_mut(&channel) {
            let by = (share * values.len() as f64) as usize;
            values.rotate_left(by);
        }
    }
    trial
}
