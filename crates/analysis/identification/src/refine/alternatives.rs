//! Alternative fits of a model's coefficients, each with the models fitted without one trial.

use sistership_model::law::Law;
use sistership_model::trial::Trial;
use sistership_model::{Model, particulars};

use super::candidate::CandidateFit;
use super::estimators::estimator;
use super::family::Family;
use super::outcome::RefineError;
use super::problem::Problem;
use super::ridge_candidates::source_candidate;
use super::selection::resolved;
use super::settings::{Method, Settings};
use super::thresholds::SELECTION;
use super::variant::variants;
use sistership_assessment::uncertainty::Sampling;

/// A fit by the weak form or by trajectories.
pub struct Alternative {
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
pub fn alternatives(
    model: &Model,
    law: &Law,
    trials: &[&Trial],
    restart_s: f64,
) -> Result<Vec<Alternative>, RefineError> {
    let settings = Settings {
        method: Method::Trajectory,
        families: vec![Family::Own],
        strengths: SELECTION.alternatives.to_vec(),
        // One fold a trial, so that `without` has a model for each of them.
        folds: trials.len(),
        restart_s: Some(restart_s),
        // No posterior is needed here.
        bands: Sampling { samples: 0, ..Sampling::default() },
        ..Settings::default()
    };
    let lpp_m = particulars::value(&model.particulars, "lpp_m");
    let settings = resolved(&settings, law, lpp_m, trials);
    let problem = Problem::of_model(model, law, trials, settings);
    let estimator = estimator(problem.settings.method);
    let variants = variants(&problem, estimator.equations(&problem.settings))?;
    let mut candidates = vec![source_candidate(&problem, &variants)?];
    estimator.candidates(&problem, &variants, &mut candidates, &|_, _| true)?;
    // The source itself has no fold models and is no alternative.
    let left_out =
        candidates.into_iter().filter(|one| one.option.error.is_some() && !one.left_out.is_empty());
    let one = |one: CandidateFit| {
        let all = one.solution.fit(&variants)?.map(|fit| problem.model_with(&fit.coefficients));
        Ok(all.map(|all| Alternative { label: one.option.step, all, without: one.left_out }))
    };
    left_out.filter_map(|candidate| one(candidate).transpose()).collect()
}
