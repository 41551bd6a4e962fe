//! What an estimator is: a way from trials to candidates.

use super::candidate::CandidateFit;
use super::equations::Equations;
use super::outcome::RefineError;
use super::problem::Problem;
use super::progress::Progress;
use super::settings::Settings;
use super::variant::Variant;
use sistership_model::law::Law;

/// A way from trials to candidates, each a fit with its errors on trials left out.
pub(super) trait Estimator: Sync {
    /// Fills in what the settings leave open, so that a version records what was used. `length_s`
    /// is the time in which the ship sails its length, s.
    fn resolve(&self, settings: &mut Settings, law: &Law, length_s: Option<f64>);

    /// How it makes rows of the equations of motion.
    fn equations(&self, settings: &Settings) -> Equations;

    /// Adds its candidates to `candidates`, the first of which is the source.
    ///
    /// # Errors
    /// Says which setting, trial or channel is at fault, or that it was cancelled.
    fn candidates(
        &self,
        problem: &Problem<'_>,
        variants: &[Variant],
        candidates: &mut Vec<CandidateFit>,
        progress: Progress<'_>,
    ) -> Result<(), RefineError>;
}
