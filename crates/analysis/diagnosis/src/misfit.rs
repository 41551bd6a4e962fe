//! Accuracy of an effect's own law.

use sistership_model::effect::ActsOn;

use super::thresholds::THRESHOLDS;
use super::values::form_target;
use sistership_filtering::EffectCandidate;

/// Difference between a form and the true effect, as a share of its response: the value of the
/// library, or the least that is assumed for any law.
pub(super) fn form_misfit(candidate: &EffectCandidate) -> f64 {
    candidate.form.file.misfit.unwrap_or(THRESHOLDS.effect.size)
}

/// Relative error of the size of an effect for that reason; it is zero for an instrument, whose
/// reading of a motion is exact by definition.
pub(super) fn size_error(candidate: &EffectCandidate) -> f64 {
    if form_target(candidate) == ActsOn::Measurement { 0.0 } else { form_misfit(candidate) }
}

/// Share of the response that may remain at the best size.
pub(super) fn shape_error(candidate: &EffectCandidate) -> f64 {
    candidate.form.file.misfit.unwrap_or(THRESHOLDS.effect.shape)
}

/// Returns true if the coefficients of the form agree with published ones: the sum of their squared
/// distances from the prior by its deviations is then a chi-square. Its quantile is Wilson and
/// Hilferty's (1931, Proc Natl Acad Sci 17, 684-688).
pub(super) fn is_as_published(candidate: &EffectCandidate) -> bool {
    let parameters = candidate.form.parameters.values().zip(&candidate.at);
    let distances: Vec<f64> = parameters
        .filter(|(parameter, _)| parameter.shape)
        .map(|(parameter, at)| (at - parameter.prior_mean) / parameter.prior_deviation)
        .collect();
    let freedom = distances.len() as f64;
    let chi_square: f64 = distances.iter().map(|distance| distance * distance).sum();
    // The cube root of chi^2/n is nearly normal, with variance 2/(9 n) and mean 1 less that.
    let spread = 2.0 / (9.0 * freedom);
    let root = 1.0 - spread + THRESHOLDS.effect.shape_quantile * spread.sqrt();
    distances.is_empty() || chi_square <= freedom * root.powi(3)
}

/// Share of the evidence for an effect that its misfit may amount to: the evidence is half the
/// square of a response, so that of the misfit is the square of the misfit times as large.
pub(super) fn misfit_share(candidate: &EffectCandidate) -> f64 {
    (THRESHOLDS.effect.misfits * form_misfit(candidate)).powi(2)
}

/// Returns true if the errors of a candidate's form have columns: it acts on accelerations, and is
/// present.
pub(super) fn has_form_errors(candidate: &EffectCandidate) -> bool {
    form_target(candidate) != ActsOn::Measurement
        && candidate.parameter_changes().iter().any(|change| *change != 0.0)
}
