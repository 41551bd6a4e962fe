//! A candidate: a fit with its errors on held-out trials, and the choice of the best one.

use sistership_model::Model;
use sistership_simulation::error::SquaredError;
use sistership_simulation::horizons::{HorizonErrors, combine_horizons};

use super::cma_es::SearchReport;
use super::errors::CoefficientErrors;
use super::outcome::{RefineError, StepOption};
use super::problem::RefinementProblem;
use super::ridge::{CoefficientFit, RidgeChoices};
use super::simulated::SimulatedErrors;
use super::thresholds::SELECTION;
use super::variant::TermVariant;
use sistership_numerics::RidgeChoice;

/// The fit of a candidate on all trials, evaluated where the candidate is chosen.
pub(super) trait CandidateSolution: Sync {
    /// Returns the coefficients without their errors; `None` if the source stays as it is.
    ///
    /// # Errors
    /// Returns an error if the trials have no sample, or the constraints cannot be kept.
    fn fit(&self, variants: &[TermVariant]) -> Result<Option<CoefficientFit>, RefineError>;

    /// Returns the joint errors of the coefficients, where the estimator has them.
    ///
    /// # Errors
    /// Returns an error if a trial lacks a channel.
    fn coefficient_errors(
        &self,
        problem: &RefinementProblem<'_>,
        variants: &[TermVariant],
    ) -> Result<Option<CoefficientErrors>, RefineError>;

    /// Returns the effective number of coefficients and parameters that the trials determine; the
    /// prior determines the others. `None` if it is not known.
    ///
    /// # Errors
    /// Returns an error if the trials have no sample.
    fn effective_count(&self, _: &[TermVariant]) -> Result<Option<f64>, RefineError> {
        Ok(None)
    }

    /// Returns the place of its variant and its choices if the solution is a ridge.
    fn ridge_choices(&self) -> Option<(usize, &RidgeChoices)> {
        None
    }
}

/// The solution that leaves the source as it is.
pub(super) struct UnchangedSource;

impl CandidateSolution for UnchangedSource {
    fn fit(&self, _: &[TermVariant]) -> Result<Option<CoefficientFit>, RefineError> {
        Ok(None)
    }

    fn coefficient_errors(
        &self,
        _: &RefinementProblem<'_>,
        _: &[TermVariant],
    ) -> Result<Option<CoefficientErrors>, RefineError> {
        Ok(None)
    }
}

/// A fit with the results by which it is compared with others.
pub(super) struct CandidateFit {
    pub option: StepOption,
    pub solution: Box<dyn CandidateSolution>,
    /// Squared errors at the shortest restart interval.
    pub errors: SquaredError,
    /// Standardised errors by restart interval, the shortest first.
    pub horizons: Vec<HorizonErrors>,
    /// Standardised errors by trial, over every restart interval.
    pub each: Vec<f64>,
    /// True if these are errors of parts of so few trials that even the source is replaced only by
    /// a clearly better fit.
    pub few: bool,
    /// Number of coefficients that are fitted.
    pub size: usize,
    /// Models of the folds, each fitted without the fold's trials; empty for the source.
    pub left_out: Vec<Model>,
    /// Report of a search.
    pub search: Option<SearchReport>,
}

impl CandidateFit {
    /// Creates a candidate from a solution and the simulations of its held-out trials; `size` is
    /// the number of its coefficients.
    pub fn new(
        problem: &RefinementProblem<'_>,
        (step, lambda_min): (String, Option<f64>),
        solution: impl CandidateSolution + 'static,
        size: usize,
        simulated: SimulatedErrors,
    ) -> Self {
        let SimulatedErrors { total: errors, horizons, reason } = simulated;
        let (error, each) = combine_horizons(&horizons);
        // A divergence at the shortest restart interval, or a refusal, excludes the candidate.
        let error = reason.is_none().then_some(error);
        // One value an acceleration, in the order of the regressions and their targets.
        let flat = |of: &dyn Fn(&RidgeChoice) -> f64| {
            solution
                .ridge_choices()
                .into_iter()
                .flat_map(|(_, choices)| choices.iter().flatten())
                .map(of)
                .collect()
        };
        let (lambda, alpha) = (flat(&|c| c.lambda), flat(&|c| c.alpha));
        let option = StepOption { step, lambda_min, lambda, alpha, error, chosen: false, reason };
        Self {
            option,
            solution: Box::new(solution),
            errors,
            horizons,
            each,
            few: problem.settings.hold_out_parts,
            size,
            left_out: Vec::new(),
            search: None,
        }
    }

    /// Adds errors at further restart intervals and combines all of them anew.
    pub fn add_horizons(&mut self, horizons: Vec<HorizonErrors>) {
        self.horizons.extend(horizons);
        let (error, each) = combine_horizons(&self.horizons);
        (self.option.error, self.each) = (Some(error), each);
    }
}

/// The place of the option with the least error. An earlier option is preferred unless a later one
/// is better by more than one per cent, and an option with fewer coefficients unless the other is
/// better by more than two standard errors of the difference over the trials (Breiman et al. 1984,
/// Classification and regression trees, section 3.4.3). `None` if no option has a finite error.
pub(super) fn best_candidate(options: &[CandidateFit]) -> Option<usize> {
    let mut best: Option<(usize, f64)> = None;
    for (index, error) in
        options.iter().enumerate().filter_map(|(index, o)| Some((index, o.option.error?)))
    {
        let better = |(at, least): (usize, f64)| {
            error < SELECTION.better * least && is_clearly_better(&options[index], &options[at])
        };
        if error.is_finite() && best.is_none_or(better) {
            best = Some((index, error));
        }
    }
    best.map(|(index, _)| index)
}

/// Returns true if an option may replace one that has fewer coefficients. The source has no fitted
/// coefficients and is replaced by any better option, unless there are few trials.
fn is_clearly_better(new: &CandidateFit, old: &CandidateFit) -> bool {
    let is_larger = old.size > 0 && new.size > old.size;
    if !(new.few || is_larger) || new.each.len() != old.each.len() || new.each.len() < 2 {
        return true;
    }
    // Paired differences by trial: what a difficult trial adds to both errors cancels.
    let gains: Vec<f64> = old.each.iter().zip(&new.each).map(|(old, new)| old - new).collect();
    let count = gains.len() as f64;
    let mean = gains.iter().sum::<f64>() / count;
    let variance = gains.iter().map(|gain| (gain - mean).powi(2)).sum::<f64>() / (count - 1.0);
    mean > SELECTION.standard_errors * (variance / count).sqrt()
}
