//! The search without slopes as an estimator.

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

/// Integration step and length of a subsequence by the time in which the ship sails its length: the paper's 0.1 s and 100 s, for a
/// ship of 3 m at 0.4 m/s.
const STEP: f64 = 75.0;
const SEGMENT: f64 = 10.0;
/// No subsequence is shorter, s (Miyauchi 2024, section 4).
const LEAST_SEGMENT_S: f64 = 100.0;

/// The search by covariance matrix adaptation; it alone is weighed against the source.
pub(in super::super) struct CovarianceMatrixAdaptation;

impl Estimator for CovarianceMatrixAdaptation {
    fn resolve(&self, settings: &mut Settings, length_s: Option<f64>) {
        // It is too dear to be repeated for families that nobody asked for.
        weak::resolve(settings, length_s, &[Family::Own]);
        settings.cma_es.get_or_insert_default();
        settings.step_s = settings.step_s.or(length_s.map(|s| s / STEP));
        settings.segment_s = settings.segment_s.or(length_s.map(|s| (SEGMENT * s).max(LEAST_SEGMENT_S)));
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
