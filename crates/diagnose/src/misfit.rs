//! How far an effect's own law is trusted.

use sistership_model::effect::ActsOn;

use super::thresholds::THRESHOLDS;
use super::values::acts_on;
use sistership_residual::EffectCandidate;

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

/// The share of the evidence for an effect that its misfit may be worth: half the square of a
/// response is the evidence for it, so that of the misfit the evidence is the misfit squared of
/// that.
pub(super) fn shadow_share(candidate: &EffectCandidate) -> f64 {
    (THRESHOLDS.effect.misfits * misfit(candidate)).powi(2)
}
