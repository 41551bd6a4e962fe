//! The search by CMA-ES as an estimator.

use super::super::candidate::CandidateFit;
use super::super::equations::Equations;
use super::super::estimator::Estimator;
use super::super::family::Family;
use super::super::outcome::RefineError;
use super::super::problem::Problem;
use super::super::progress::Progress;
use super::super::settings::Settings;
use super::super::variant::Variant;
use super::super::weak;
use super::candidates::search;
use super::thresholds::OBJECTIVE;
use sistership_model::law::Law;

/// The search by covariance matrix adaptation; its only competitor is the source.
pub(in super::super) struct CovarianceMatrixAdaptation;

impl Estimator for CovarianceMatrixAdaptation {
    fn resolve(&self, settings: &mut Settings, _: &Law, length_s: Option<f64>) {
        // It is too expensive to be repeated for families that were not requested.
        weak::resolve(settings, length_s, &[Family::Own]);
        settings.cma_es.get_or_insert_default();
        settings.step_s = settings.step_s.or(length_s.map(|s| s / OBJECTIVE.steps_a_length));
        settings.segment_s = settings
            .segment_s
            .or(length_s.map(|s| (OBJECTIVE.segment * s).max(OBJECTIVE.least_segment_s)));
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
        search(problem, variants, candidates, progress)
    }
}
