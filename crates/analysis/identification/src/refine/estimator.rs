//! The interface of estimators.

use super::candidate::CandidateFit;
use super::equations::Equations;
use super::outcome::RefineError;
use super::problem::Problem;
use super::progress::Progress;
use super::settings::Settings;
use super::variant::Variant;
use sistership_model::law::Law;

/// An estimator: a method that gives candidates from trials, each a fit with its errors on held-out
/// trials.
pub(super) trait Estimator: Sync {
    /// Fills in settings without a value, so that a version records those that were used.
    /// `length_s` is the time in which the ship travels its own length, s.
    fn resolve(&self, settings: &mut Settings, law: &Law, length_s: Option<f64>);

    /// Returns the method by which it makes rows of the equations of motion.
    fn equations(&self, settings: &Settings) -> Equations;

    /// Adds its candidates to `candidates`, the first of which is the source.
    ///
    /// # Errors
    /// Returns an error with the setting, trial or channel at fault, or if the refinement was
    /// cancelled.
    fn candidates(
        &self,
        problem: &Problem<'_>,
        variants: &[Variant],
        candidates: &mut Vec<CandidateFit>,
        progress: Progress<'_>,
    ) -> Result<(), RefineError>;
}
