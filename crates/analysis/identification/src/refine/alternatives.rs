//! Alternative fits of a model's coefficients, each with the models fitted without one trial.

use sistership_model::law::Law;
use sistership_model::trial::Trial;
use sistership_model::{Model, particulars};

use super::candidate::CandidateFit;
use super::estimators::estimator_for;
use super::family::TermFamily;
use super::outcome::RefineError;
use super::problem::RefinementProblem;
use super::ridge_candidates::source_candidate;
use super::selection::resolve_settings;
use super::settings::{EstimationMethod, RefinementSettings};
use super::thresholds::SELECTION;
use super::variant::family_variants;
use sistership_assessment::uncertainty::Sampling;

/// A fit by the weak form or by trajectories.
pub struct AlternativeFit {
    /// Label for reports.
    pub label: String,
    /// Model fitted on all trials.
    pub all: Model,
    /// Models fitted without one trial each.
    pub without: Vec<Model>,
}

/// Returns the fits of a model's coefficients, with the model itself as the source, whose
/// simulations of held-out trials run to their end.
///
/// # Errors
/// Returns an error with the trial or channel at fault.
pub fn alternative_fits(
    model: &Model,
    law: &Law,
    trials: &[&Trial],
    restart_s: f64,
) -> Result<Vec<AlternativeFit>, RefineError> {
    let settings = RefinementSettings {
        method: EstimationMethod::Trajectory,
        families: vec![TermFamily::Own],
        strengths: SELECTION.alternatives.to_vec(),
        // One fold a trial, so that `without` has a model for each of them.
        folds: trials.len(),
        restart_s: Some(restart_s),
        // No posterior is needed here.
        bands: Sampling { samples: 0, ..Sampling::default() },
        ..RefinementSettings::default()
    };
    let lpp_m = particulars::particular_value(&model.particulars, "lpp_m");
    let settings = resolve_settings(&settings, law, lpp_m, trials);
    let problem = RefinementProblem::from_model(model, law, trials, settings);
    let estimator = estimator_for(problem.settings.method);
    let variants = family_variants(&problem, estimator.equation_form(&problem.settings))?;
    let mut candidates = vec![source_candidate(&problem, &variants)?];
    estimator.add_candidates(&problem, &variants, &mut candidates, &|_, _| true)?;
    // The source itself has no fold models and is no alternative.
    let left_out =
        candidates.into_iter().filter(|one| one.option.error.is_some() && !one.left_out.is_empty());
    let one = |one: CandidateFit| {
        let all = one.solution.fit(&variants)?.map(|fit| problem.fitted_model(&fit));
        Ok(all.map(|all| AlternativeFit { label: one.option.step, all, without: one.left_out }))
    };
    left_out.filter_map(|candidate| one(candidate).transpose()).collect()
}
