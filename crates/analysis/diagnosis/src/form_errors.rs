//! Errors of the forms of effects, as columns of linearised parts ([`sistership_filtering`]).

use sistership_filtering::{AxisColumn, EffectCandidate, LinearisedPart, TrialReadings};
use sistership_model::trial::Channel;

use super::linearised_trials::LinearisedTrials;
use super::misfit::{form_misfit, has_form_errors};
use super::thresholds::THRESHOLDS;

/// Columns of the errors of all candidates' forms along a part, with a standard deviation of one.
/// The candidates' own columns begin at `first`.
pub(super) fn form_error_columns(
    workspace: &LinearisedTrials<'_>,
    record: &TrialReadings<'_>,
    part: &LinearisedPart,
    (first, candidates): (usize, &[EffectCandidate]),
) -> Vec<AxisColumn> {
    if !candidates.iter().any(has_form_errors) {
        return Vec::new();
    }
    // Forms of different authors differ most in how they depend on the speed.
    let speed = record.trial.channel(Channel::U).unwrap_or_default();
    let excess = |k: &usize| speed.get(*k).map_or(0.0, |u| u / workspace.speed_m_s - 1.0);
    let pace: Vec<f64> = part.samples.iter().map(excess).collect();
    let memory_s = THRESHOLDS.effect.form_memory * workspace.lpp_m / workspace.speed_m_s;
    let mut place = first;
    let mut columns = Vec::new();
    for candidate in candidates {
        let mut weights = vec![0.0; part.sizes.columns];
        for (weight, change) in weights[place..].iter_mut().zip(candidate.parameter_changes()) {
            *weight = form_misfit(candidate) * change;
        }
        place += candidate.at.len();
        if has_form_errors(candidate) {
            columns.extend(part.form_errors(&weights, &pace, memory_s));
        }
    }
    columns
}
