//! Effects that cannot be named by their parameters alone.

use nalgebra::{Cholesky, DVector};

use super::hypothesis::JudgedHypothesis;
use super::misfit::is_as_published;
use super::refusal::Refusal;
use super::thresholds::THRESHOLDS;
use super::values::own_covariance;

/// Reason for which a single effect of a hypothesis cannot be named, by its parameters alone.
pub(super) fn parameter_refusal(judged: &JudgedHypothesis, place: usize) -> Option<Refusal> {
    let candidate = &judged.candidates[place];
    if !is_as_published(candidate) {
        return Some(Refusal::NotAsPublished(candidate.effect.clone()));
    }
    has_no_size(judged, place).then(|| Refusal::NoSize(candidate.effect.clone()))
}

/// Returns true if the sizes of an effect, without the coefficients of its form, agree with its
/// absence: their squared distance by their covariance is below the quantile of one size.
fn has_no_size(judged: &JudgedHypothesis, place: usize) -> bool {
    let candidate = &judged.candidates[place];
    let covariance = own_covariance(&judged.candidates, place, &judged.covariance);
    let parameters = candidate.form.parameters.values().enumerate();
    let sizes: Vec<usize> = parameters.filter(|(_, own)| !own.shape).map(|(i, _)| i).collect();
    let changes = candidate.parameter_changes();
    let change = DVector::from_iterator(sizes.len(), sizes.iter().map(|&i| changes[i]));
    let own = covariance.select_rows(&sizes).select_columns(&sizes);
    let square = Cholesky::new(own).map(|factor| change.dot(&factor.solve(&change)));
    square.is_some_and(|square| square < THRESHOLDS.effect.least_size.powi(2))
}
