//! Errors of the forms of effects, as columns of linearised parts ([`sistership_filtering`]).

use nalgebra::Cholesky;
use sistership_filtering::{
    AxisColumn, EffectCandidate, GramMatrix, LinearisedPart, TrialReadings,
};
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

/// Integrates out the last columns, which are errors of forms; without them where what is left is not
/// positive.
pub(super) fn integrate_form_errors(gram: GramMatrix, count: usize) -> GramMatrix {
    if count == 0 {
        return gram;
    }
    let before = gram.products.diagonal();
    let kept: Vec<usize> = (0..before.len() - 1 - count).collect();
    let without = gram.select_columns(&kept);
    let Some(mut left) = gram.integrate_last(count) else { return without };
    // What is left of a column that resembles the errors is a difference of large numbers: the
    // ridge is above its rounding, so that the information stays positive.
    for column in 1..left.products.nrows() {
        let ridge = THRESHOLDS.effect.form_ridge * before[column];
        left.products[(column, column)] += ridge.max(f64::MIN_POSITIVE);
    }
    let information = left.products.view((1, 1), (kept.len(), kept.len())).into_owned();
    if Cholesky::new(information).is_some() { left } else { without }
}
