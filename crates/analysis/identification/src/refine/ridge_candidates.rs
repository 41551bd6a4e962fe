//! Ridge candidates, from the source outwards.

use rayon::prelude::*;
use sistership_model::Model;

use super::candidate::{CandidateFit, CandidateSolution, UnchangedSource};
use super::errors::CoefficientErrors;
use super::outcome::{RefineError, SOURCE_STEP};
use super::problem::RefinementProblem;
use super::progress::{PartProgress, Progress, report_progress};
use super::ridge::{CoefficientFit, RegressionFold, RidgeChoices, fit_regressions};
use super::simulated::{SimulatedErrors, simulate_training};
use super::variant::TermVariant;
use crate::constraints::LimitError;

/// Ridge of a variant at its choices, as a solution.
struct RidgeSolution {
    variant: usize,
    choices: RidgeChoices,
}

impl CandidateSolution for RidgeSolution {
    fn fit(&self, variants: &[TermVariant]) -> Result<Option<CoefficientFit>, RefineError> {
        let variant = &variants[self.variant];
        let all = variant.merged_moments(|_| true)?;
        let mut fitted = fit_regressions(&variant.blocks, &all, &variant.model, &self.choices);
        // The condition numbers are those of the unconstrained fit; the coefficients become the
        // nearest within the limits.
        if variant.limits.is_some() {
            let fold = RegressionFold::new(&variant.blocks, &variant.model, &all, &[]);
            fitted.coefficients = variant.solve(&fold, &self.choices)?;
        }
        Ok(Some(fitted))
    }

    fn coefficient_errors(
        &self,
        problem: &RefinementProblem<'_>,
        variants: &[TermVariant],
    ) -> Result<Option<CoefficientErrors>, RefineError> {
        variants[self.variant].ridge_errors(&problem.training, &self.choices)
    }

    fn effective_count(&self, variants: &[TermVariant]) -> Result<Option<f64>, RefineError> {
        let variant = &variants[self.variant];
        let all = variant.merged_moments(|_| true)?;
        let fold = RegressionFold::new(&variant.blocks, &variant.model, &all, &[]);
        Ok(Some(fold.effective_count(&self.choices)))
    }

    fn ridge_choices(&self) -> Option<(usize, &RidgeChoices)> {
        Some((self.variant, &self.choices))
    }
}

/// Returns the source as a candidate; a refused one if it does not keep the constraints.
///
/// # Errors
/// Returns an error if a trial lacks a channel.
pub(super) fn source_candidate(
    problem: &RefinementProblem<'_>,
    variants: &[TermVariant],
) -> Result<CandidateFit, RefineError> {
    let limits = variants.iter().find_map(|variant| variant.limits.as_ref());
    let simulated = match limits.map(|limits| limits.check(&problem.transferred)) {
        Some(Err(reason)) => SimulatedErrors::with_refusal(reason.to_string()),
        _ => simulate_training(problem, std::slice::from_ref(&problem.transferred), &|_| 0)?,
    };
    Ok(CandidateFit::new(problem, (SOURCE_STEP.into(), None), UnchangedSource, 0, simulated))
}

/// Returns the ridge of a variant at its choices as a candidate, each held-out trial simulated by
/// the model of its fold.
///
/// # Errors
/// Returns an error if a trial lacks a channel.
pub(super) fn ridge_candidate(
    problem: &RefinementProblem<'_>,
    (name, lambda_min): (String, f64),
    (index, variant): (usize, &TermVariant),
    choices: RidgeChoices,
    folds: &[RegressionFold<'_>],
) -> Result<CandidateFit, RefineError> {
    let step = (name, Some(lambda_min));
    let model = |fold: &RegressionFold<'_>| Ok(problem.model_with(&variant.solve(fold, &choices)?));
    let models: Vec<Model> = match folds.par_iter().map(model).collect::<Result<_, LimitError>>() {
        Ok(models) => models,
        Err(reason) => {
            let ridge = RidgeSolution { variant: index, choices };
            return Ok(CandidateFit::new(
                problem,
                step,
                ridge,
                0,
                SimulatedErrors::with_refusal(reason.to_string()),
            ));
        }
    };
    let simulated = simulate_training(problem, &models, &|trial| problem.fold_of(trial))?;
    let size = models.first().map_or(0, |model| model.coefficients.len());
    let candidate = CandidateFit::new(
        problem,
        step,
        RidgeSolution { variant: index, choices },
        size,
        simulated,
    );
    Ok(CandidateFit { left_out: models, ..candidate })
}

/// Work on a variant: its place and itself, its folds, and the callback for progress.
pub(super) type VariantWork<'a> = &'a mut dyn FnMut(
    (usize, &TermVariant),
    &[RegressionFold<'_>],
    PartProgress<'_>,
) -> Result<(), RefineError>;

/// Does some work on each variant with its folds, one after the other.
///
/// # Errors
/// Returns an error if a fold has no sample, or the error of `work`.
pub(super) fn for_each_variant(
    problem: &RefinementProblem<'_>,
    variants: &[TermVariant],
    progress: Progress<'_>,
    work: VariantWork<'_>,
) -> Result<(), RefineError> {
    for (index, variant) in variants.iter().enumerate() {
        let folds = variant.training_folds(problem)?;
        let told = |done: f64, what: &str| {
            report_progress(progress, progress_fraction(index, done, variants.len()), what)
        };
        work((index, variant), &folds, &told)?;
    }
    Ok(())
}

/// Fraction of a refinement at the fraction `done` of a variant: candidates are seven tenths of the
/// work.
pub(super) fn progress_fraction(index: usize, done: f64, variants: usize) -> f64 {
    0.1 + 0.7 / variants as f64 * (index as f64 + done)
}
