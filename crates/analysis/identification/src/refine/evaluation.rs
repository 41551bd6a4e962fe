//! Evaluations by which candidates are compared with those of other sources, laws and estimators.

use std::collections::BTreeMap;

use sistership_model::Model;
use sistership_model::trial::Trial;

use super::candidate::{CandidateFit, best_candidate};
use super::family::TermFamily;
use super::fold_variance::fold_variance;
use super::problem::RefinementProblem;
use super::variant::TermVariant;

/// Extent of a refinement before its candidates are evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RefinementExtent {
    /// The transferred source alone.
    Source,
    /// All candidates of the estimator.
    Estimator,
}

/// Evaluation of a candidate on held-out manoeuvres. Errors are scaled by the standard deviations
/// of the measured channels over all training trials, so that candidates on the same trials can be
/// compared whatever their source, law and estimator.
#[derive(Debug, Clone, PartialEq)]
pub struct CandidateEvaluation {
    /// Name for reports.
    pub step: String,
    /// Standardised mean squared error, the geometric mean over restart intervals; none if a
    /// simulation diverged at the shortest.
    pub error: Option<f64>,
    /// Error at the shortest restart interval.
    pub shortest: Option<f64>,
    /// Error by trial.
    pub each: BTreeMap<String, f64>,
    /// Jackknife variance of the states that are simulated under rudder orders that no trial had,
    /// on the same scales: 0 for the transferred source, infinite if a fold's model cannot be
    /// simulated to the end, none if folds have no models.
    pub variance: Option<f64>,
    /// Number of fitted coefficients; 0 for the transferred source.
    pub coefficients: usize,
    /// Effective number of coefficients and parameters that the trials determine, where it is
    /// known; 0 for the transferred source.
    pub effective: Option<f64>,
    /// Family of terms and strength of the prior, for a ridge.
    pub ridge: Option<(TermFamily, f64)>,
    /// Model of each fold, fitted without it; empty for the transferred source, and if trials were
    /// held out in parts.
    pub folds: Vec<FoldModel>,
    /// Reason why it cannot be chosen, if any.
    pub reason: Option<String>,
}

/// A model with the trials that it was fitted without.
#[derive(Debug, Clone, PartialEq)]
pub struct FoldModel {
    /// The model.
    pub model: Model,
    /// Places of those trials among the trials that are used.
    pub held_out: Vec<usize>,
}

impl CandidateEvaluation {
    /// Returns the evaluation of a candidate that cannot be fitted.
    pub fn with_refusal(reason: String) -> Self {
        Self {
            step: String::new(),
            error: None,
            shortest: None,
            each: BTreeMap::new(),
            variance: None,
            coefficients: 0,
            effective: None,
            ridge: None,
            folds: Vec::new(),
            reason: Some(reason),
        }
    }
}

/// Returns the evaluations of the source and of the best other candidate; if all others diverge, of
/// the first of them.
pub(super) fn evaluate_best(
    problem: &RefinementProblem<'_>,
    candidates: &[CandidateFit],
    variants: &[TermVariant],
) -> Vec<CandidateEvaluation> {
    let Some((source, fits)) = candidates.split_first() else { return Vec::new() };
    let fit = best_candidate(fits).and_then(|index| fits.get(index)).or_else(|| fits.first());
    std::iter::once(source)
        .chain(fit)
        .map(|candidate| evaluate_candidate(problem, candidate, variants))
        .collect()
}

/// Evaluation of one candidate.
fn evaluate_candidate(
    problem: &RefinementProblem<'_>,
    candidate: &CandidateFit,
    variants: &[TermVariant],
) -> CandidateEvaluation {
    let ridge =
        |(place, _): (usize, _)| Some((variants.get(place)?.family, candidate.option.lambda_min?));
    CandidateEvaluation {
        step: candidate.option.step.clone(),
        error: candidate.option.error.filter(|error| error.is_finite()),
        shortest: candidate.horizons.first().map(|horizon| horizon.mean),
        each: errors_by_trial(problem, &candidate.each),
        // The source is no fit, so that no trial affects it.
        variance: match candidate.size {
            0 => Some(0.0),
            _ => fold_variance(problem, &candidate.left_out),
        },
        coefficients: candidate.size,
        effective: match candidate.size {
            0 => Some(0.0),
            _ => candidate.solution.effective_count(variants).ok().flatten(),
        },
        ridge: candidate.solution.ridge_choices().and_then(ridge),
        folds: fold_models(problem, &candidate.left_out),
        reason: candidate.option.reason.clone(),
    }
}

/// Models of the folds with the trials that each was fitted without; none if trials were held out
/// in parts, since every model has then seen a part of each trial.
fn fold_models(problem: &RefinementProblem<'_>, left_out: &[Model]) -> Vec<FoldModel> {
    if problem.training.len() != problem.whole.len() || problem.training.len() < 2 {
        return Vec::new();
    }
    let one = |(fold, model): (usize, &Model)| {
        let trials = 0..problem.training.len();
        let held_out = trials.filter(|trial| problem.fold_of(*trial) == fold).collect();
        FoldModel { model: model.clone(), held_out }
    };
    left_out.iter().enumerate().map(one).collect()
}

/// Mean errors by trial. Parts of one trial count together, since they depend on each other, unless
/// only parts of one or two trials can show a scatter.
fn errors_by_trial(problem: &RefinementProblem<'_>, each: &[f64]) -> BTreeMap<String, f64> {
    if problem.settings.hold_out_parts {
        let named = |(k, (trial, error)): (usize, (&&Trial, &f64))| {
            (format!("{} ({})", trial.name, k + 1), *error)
        };
        return problem.training.iter().zip(each).enumerate().map(named).collect();
    }
    let mut sums: BTreeMap<String, (f64, f64)> = BTreeMap::new();
    for (trial, error) in problem.training.iter().zip(each) {
        let sum = sums.entry(trial.name.clone()).or_default();
        *sum = (sum.0 + error, sum.1 + 1.0);
    }
    sums.into_iter().map(|(name, (sum, count))| (name, sum / count)).collect()
}
