//! The published estimator: one-step differences and the ridge with the source as its prior
//! (Kanazawa 2023, Eqs. 5.4-5.17), with tuning ranges that widen step by step from the source
//! outwards.

use super::candidate::CandidateFit;
use super::equations::EquationForm;
use super::estimator::Estimator;
use super::outcome::RefineError;
use super::problem::RefinementProblem;
use super::progress::{PartProgress, Progress};
use super::ridge::{RegressionFold, tune_choices};
use super::ridge_candidates::{for_each_variant, ridge_candidate};
use super::settings::RefinementSettings;
use super::variant::TermVariant;
use sistership_model::law::Law;

/// `T_d`: time over which accelerations are differenced, in units of the time in which the ship
/// travels its own length, dimensionless. Source: decision 2, with the table of errors from one
/// sample to twice the value.
const DIFFERENCE: f64 = 0.1;

/// The published estimator.
pub(super) struct PublishedEstimator;

impl Estimator for PublishedEstimator {
    fn resolve_settings(&self, settings: &mut RefinementSettings, _: &Law, length_s: Option<f64>) {
        settings.difference_s = settings.difference_s.or(length_s.map(|s| DIFFERENCE * s));
    }

    fn equation_form(&self, settings: &RefinementSettings) -> EquationForm {
        EquationForm::Differences(settings.difference_s)
    }

    fn add_candidates(
        &self,
        problem: &RefinementProblem<'_>,
        variants: &[TermVariant],
        candidates: &mut Vec<CandidateFit>,
        progress: Progress<'_>,
    ) -> Result<(), RefineError> {
        let mut ranges =
            |at: (usize, &TermVariant), folds: &[RegressionFold<'_>], told: PartProgress<'_>| {
                by_range(problem, at, folds, told, candidates)
            };
        for_each_variant(problem, variants, progress, &mut ranges)
    }
}

/// Adds one candidate for each range; a single trial allows the first range only.
fn by_range(
    problem: &RefinementProblem<'_>,
    at: (usize, &TermVariant),
    folds: &[RegressionFold<'_>],
    told: PartProgress<'_>,
    candidates: &mut Vec<CandidateFit>,
) -> Result<(), RefineError> {
    let ranges = &problem.settings.ranges;
    let allowed = if problem.training.len() == 1 { 1 } else { ranges.len() };
    for (index, range) in ranges.iter().take(allowed).enumerate() {
        let what = format!("lambda from {:.0e}: simulating held-out manoeuvres", range.lambda_min);
        told(index as f64 / allowed as f64, &what)?;
        let choices = tune_choices(folds, range, problem.settings.lambda_count)?;
        let name = ((index + 1).to_string(), range.lambda_min);
        candidates.push(ridge_candidate(problem, name, at, choices, folds)?);
    }
    Ok(())
}
