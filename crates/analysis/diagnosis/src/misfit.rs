//! How far an effect's own law is trusted.

use sistership_model::effect::ActsOn;

use super::thresholds::THRESHOLDS;
use super::values::acts_on;
use sistership_filtering::EffectCandidate;

/// By how much a form differs from what nature has in its place, a share of its response: what the
/// library states, or the least that is assumed of any law.
pub(super) fn misfit(candidate: &EffectCandidate) -> f64 {
    candidate.form.file.misfit.unwrap_or(THRESHOLDS.effect.size)
}

/// By how much the size of an effect is uncertain for that: what an instrument says of a motion is
/// exact by definition.
pub(super) fn of_size(candidate: &EffectCandidate) -> f64 {
    if acts_on(candidate) == ActsOn::Measurement { 0.0 } else { misfit(candidate) }
}

/// What may remain of its response where it is at its best size.
pub(super) fn of_shape(candidate: &EffectCandidate) -> f64 {
    candidate.form.file.misfit.unwrap_or(THRESHOLDS.effect.shape)
}

/// Whether the coefficients of the form are such as authors have: the sum of their squared
/// distances from the prior by its deviations is a chi-square where they are. Its quantile is
/// Wilson and Hilferty's (1931, Proc Natl Acad Sci 17, 684-688).
pub(super) fn is_as_published(candidate: &EffectCandidate) -> bool {
    let parameters = candidate.form.parameters.values().zip(&candidate.at);
    let distances: Vec<f64> = parameters
        .filter(|(parameter, _)| parameter.shape)
        .map(|(parameter, at)| (at - parameter.prior_mean) / parameter.prior_deviation)
        .collect();
    let freedom = distances.len() as f64;
    let chi_square: f64 = distances.iter().map(|distance| distance * distance).sum();
    let spread = 2.0 / (9.0 * freedom);
    let root = 1.0 - spread + THRESHOLDS.effect.shape_quantile * spread.sqrt();
    distances.is_empty() || chi_square <= freedom * root.powi(3)
}

/// The share of the evidence for an effect that its misfit may be worth: half the square of a
/// response is the evidence for it, so that of the misfit the evidence is the misfit squared of
/// that.
pub(super) fn shadow_share(candidate: &EffectCandidate) -> f64 {
    (THRESHOLDS.effect.misfits * misfit(candidate)).powi(2)
}
