//! The search by CMA-ES as an estimator.

use super::super::candidate::CandidateFit;
use super::super::equations::EquationForm;
use super::super::estimator::Estimator;
use super::super::family::TermFamily;
use super::super::outcome::RefineError;
use super::super::problem::RefinementProblem;
use super::super::progress::Progress;
use super::super::settings::RefinementSettings;
use super::super::variant::TermVariant;
use super::super::weak;
use super::candidates::add_search_candidates;
use super::thresholds::OBJECTIVE;
use sistership_model::law::Law;

/// The search by covariance matrix adaptation; its only competitor is the source.
pub(in super::super) struct CovarianceMatrixAdaptation;

impl Estimator for CovarianceMatrixAdaptation {
    fn resolve_settings(&self, settings: &mut RefinementSettings, _: &Law, length_s: Option<f64>) {
        // It is too expensive to be repeated for families that were not requested.
        weak::resolve_windows(settings, length_s, &[TermFamily::Own]);
        settings.cma_es.get_or_insert_default();
        settings.step_s = settings.step_s.or(length_s.map(|s| s / OBJECTIVE.steps_a_length));
        settings.segment_s = settings
            .segment_s
            .or(length_s.map(|s| (OBJECTIVE.segment * s).max(OBJECTIVE.least_segment_s)));
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
        add_search_candidates(problem, variants, candidates, progress)
    }
}
