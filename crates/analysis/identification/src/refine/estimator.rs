//! The interface of estimators.

use super::candidate::CandidateFit;
use super::equations::EquationForm;
use super::outcome::RefineError;
use super::problem::RefinementProblem;
use super::progress::Progress;
use super::settings::RefinementSettings;
use super::variant::TermVariant;
use sistership_model::law::Law;

/// An estimator: a method that gives candidates from trials, each a fit with its errors on held-out
/// trials.
pub(super) trait Estimator: Sync {
    /// Fills in settings without a value, so that a version records those that were used.
    /// `length_s` is the time in which the ship travels its own length, s.
    fn resolve_settings(&self, settings: &mut RefinementSettings, law: &Law, length_s: Option<f64>);

    /// Returns the method by which it makes rows of the equations of motion.
    fn equation_form(&self, settings: &RefinementSettings) -> EquationForm;

    /// Adds its candidates to `candidates`, the first of which is the source.
    ///
    /// # Errors
    /// Returns an error with the setting, trial or channel at fault, or if the refinement was
    /// cancelled.
    fn add_candidates(
        &self,
        problem: &RefinementProblem<'_>,
        variants: &[TermVariant],
        candidates: &mut Vec<CandidateFit>,
        progress: Progress<'_>,
    ) -> Result<(), RefineError>;
}
