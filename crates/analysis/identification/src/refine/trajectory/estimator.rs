//! The trajectory form as an estimator.

use super::super::candidate::CandidateFit;
use super::super::equations::Equations;
use super::super::estimator::Estimator;
use super::super::family::Family;
use super::super::outcome::RefineError;
use super::super::problem::Problem;
use super::super::progress::Progress;
use super::super::settings::Settings;
use super::super::steps::step_s;
use super::super::variant::Variant;
use super::super::weak::{self, WeakForm};
use super::candidates::from_weak_form;
use super::thresholds::TRAJECTORY;
use sistership_model::law::Law;

/// The trajectory form, started from the weak form.
pub(in super::super) struct TrajectoryForm;

impl Estimator for TrajectoryForm {
    fn resolve(&self, settings: &mut Settings, law: &Law, length_s: Option<f64>) {
        weak::resolve(settings, length_s, &Family::ALL);
        let economical = settings.economical;
        settings.step_s = settings.step_s.or(length_s.map(|s| step_s(law, s, economical)));
        settings.segment_s = settings.segment_s.or(length_s.map(|s| TRAJECTORY.segment * s));
        let residuals_a_length = match economical {
            true => TRAJECTORY.residuals_a_length_economical,
            false => TRAJECTORY.residuals_a_length,
        };
        settings.residual_s = settings.residual_s.or(length_s.map(|s| s / residuals_a_length));
    }

    fn equations(&self, settings: &Settings) -> Equations {
        weak::equations(settings)
    }

    fn candidates(
        &self,
        problem: &Problem<'_>,
        variants: &[Variant],
        candidates: &mut Vec<CandidateFit>,
        progress: Progress<'_>,
    ) -> Result<(), RefineError> {
        // Trajectories start from a ridge of the weak form, which must be among the candidates.
        WeakForm.candidates(problem, variants, candidates, progress)?;
        from_weak_form(problem, variants, candidates, progress)
    }
}
