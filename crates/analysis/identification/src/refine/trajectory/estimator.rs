//! The trajectory form as an estimator.

use super::super::candidate::CandidateFit;
use super::super::equations::EquationForm;
use super::super::estimator::Estimator;
use super::super::family::TermFamily;
use super::super::outcome::RefineError;
use super::super::problem::RefinementProblem;
use super::super::progress::Progress;
use super::super::settings::RefinementSettings;
use super::super::steps::step_s;
use super::super::variant::TermVariant;
use super::super::weak::{self, WeakForm};
use super::candidates::add_from_weak_form;
use super::thresholds::TRAJECTORY;
use sistership_model::law::Law;

/// The trajectory form, started from the weak form.
pub(in super::super) struct TrajectoryForm;

impl Estimator for TrajectoryForm {
    fn resolve_settings(
        &self,
        settings: &mut RefinementSettings,
        law: &Law,
        length_s: Option<f64>,
    ) {
        weak::resolve_windows(settings, length_s, &TermFamily::ALL);
        settings.step_s = settings.step_s.or(length_s.map(|s| step_s(law, s)));
        let lengths = match law.typical.is_empty() {
            true => TRAJECTORY.segment,
            false => TRAJECTORY.long_segment,
        };
        settings.segment_s = settings.segment_s.or(length_s.map(|s| lengths * s));
        settings.residual_s =
            settings.residual_s.or(length_s.map(|s| s / TRAJECTORY.residuals_a_length));
    }

    fn equation_form(&self, settings: &RefinementSettings) -> EquationForm {
        weak::window_form(settings)
    }

    fn add_candidates(
        &self,
        problem: &RefinementProblem<'_>,
        variants: &[TermVariant],
        candidates: &mut Vec<CandidateFit>,
        progress: Progress<'_>,
    ) -> Result<(), RefineError> {
        // Trajectories start from a ridge of the weak form, which must be among the candidates.
        WeakForm.add_candidates(problem, variants, candidates, progress)?;
        add_from_weak_form(problem, variants, candidates, progress)
    }
}
