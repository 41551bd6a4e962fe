//! Candidates as they are weighed against those of other sources, laws and estimators.

use std::collections::BTreeMap;

use sistership_model::Model;
use sistership_model::trial::Trial;

use super::candidate::{CandidateFit, best};
use super::family::Family;
use super::fold_variance::fold_variance;
use super::problem::Problem;
use super::variant::Variant;

/// How much of a refinement is done before its candidates are weighed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// The source as carried over.
    Source,
    /// Everything that the estimator tries.
    Estimator,
}

/// What a candidate gives on manoeuvres left out. The scales are the deviations of the measured
/// channels over all trials fitted, so that candidates on the same trials can be compared whatever
/// their source, law and estimator.
#[derive(Debug, Clone, PartialEq)]
pub struct Weighed {
    /// What it is, for people.
    pub step: String,
    /// Standardised mean squared error, the geometric mean over restart intervals; none where a
    /// simulation diverged at the shortest.
    pub error: Option<f64>,
    /// That at the shortest restart interval.
    pub shortest: Option<f64>,
    /// The same by trial.
    pub each: BTreeMap<String, f64>,
    /// Jackknife variance of what is simulated under rudders that no trial had, on the same scales:
    /// 0 of the source as carried over, infinite where a fold does not sail, none where folds made
    /// no models.
    pub variance: Option<f64>,
    /// Number of coefficients fitted; 0 of the source as carried over.
    pub coefficients: usize,
    /// Of a ridge, its family of terms and the strength of its prior.
    pub ridge: Option<(Family, f64)>,
    /// The model of each fold, fitted without it; none of the source as carried over, and where
    /// trials were held out in parts.
    pub folds: Vec<FoldModel>,
    /// Why it cannot be taken, if so.
    pub reason: Option<String>,
}

/// A model with the trials that it was fitted without.
#[derive(Debug, Clone, PartialEq)]
pub struct FoldModel {
    /// The model.
    pub model: Model,
    /// The places of those trials among the ones that have a say.
    pub held_out: Vec<usize>,
}

impl Weighed {
    /// What cannot be fitted.
    pub fn refused(reason: String) -> Self {
        Self {
            step: String::new(),
            error: None,
            shortest: None,
            each: BTreeMap::new(),
            variance: None,
            coefficients: 0,
            ridge: None,
            folds: Vec::new(),
            reason: Some(reason),
        }
    }
}

/// The source, and the best of the others where there is one; where all of them diverge, the first.
pub(super) fn weighed(
    problem: &Problem<'_>,
    candidates: &[CandidateFit],
    variants: &[Variant],
) -> Vec<Weighed> {
    let Some((source, fits)) = candidates.split_first() else { return Vec::new() };
    let fit = best(fits).and_then(|index| fits.get(index)).or_else(|| fits.first());
    std::iter::once(source).chain(fit).map(|candidate| one(problem, candidate, variants)).collect()
}

fn one(problem: &Problem<'_>, candidate: &CandidateFit, variants: &[Variant]) -> Weighed {
    let ridge =
        |(place, _): (usize, _)| Some((variants.get(place)?.family, candidate.option.lambda_min?));
    Weighed {
        step: candidate.option.step.clone(),
        error: candidate.option.error.filter(|error| error.is_finite()),
        shortest: candidate.horizons.first().map(|horizon| horizon.mean),
        each: by_trial(problem, &candidate.each),
        variance: match candidate.size {
            0 => Some(0.0),
            _ => fold_variance(problem, &candidate.left_out),
        },
        coefficients: candidate.size,
        ridge: candidate.solution.ridge().and_then(ridge),
        folds: folds(problem, &candidate.left_out),
        reason: candidate.option.reason.clone(),
    }
}

fn folds(problem: &Problem<'_>, left_out: &[Model]) -> Vec<FoldModel> {
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

/// Means by trial: parts of one count together, for they depend on each other; of one or two trials
/// there is nothing else to tell a scatter from.
fn by_trial(problem: &Problem<'_>, each: &[f64]) -> BTreeMap<String, f64> {
    if problem.settings.in_parts {
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
