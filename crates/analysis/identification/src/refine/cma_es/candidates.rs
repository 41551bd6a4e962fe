//! The search by CMA-ES as a candidate of a refinement.

use std::collections::BTreeMap;

use sistership_model::Model;
use sistership_model::trial::Channel;
use sistership_simulation::candidates::CandidateSystem;
use sistership_simulation::state::at;

use super::super::candidate::{CandidateFit, CandidateSolution};
use super::super::errors::CoefficientErrors;
use super::super::outcome::RefineError;
use super::super::problem::RefinementProblem;
use super::super::progress::{FitIterate, PartProgress, Progress, report_progress};
use super::super::ridge::{CoefficientFit, FittedCoefficient};
use super::super::ridge_candidates::progress_fraction;
use super::super::simulated::simulate_training;
use super::super::trajectory::{
    ComparisonPlan, SegmentLengths, TrialSegment, WeakFormPrior, compared_states,
    divide_into_segments,
};
use super::super::variant::TermVariant;
use super::deviation::DeviationPenalty;
use super::objective::{SearchObjective, SubsequenceSet};
use super::thresholds::OBJECTIVE;
use super::{CmaEs, SearchReport};
use sistership_numerics::cma_es::{
    CmaEsSearch, SearchBudget, SearchCancelled, SearchOutcome, SearchState,
};
use sistership_priors::transfer::prepare_ship;

/// The search over the coefficients of one variant.
struct VariantSearch<'a> {
    problem: &'a RefinementProblem<'a>,
    variant: &'a TermVariant,
    settings: &'a CmaEs,
    objective: SearchObjective,
    segments: Vec<TrialSegment>,
    /// Places of the coefficients on which the trials have information.
    moved: Vec<usize>,
}

/// Coefficients of the fit on all trials and of the fits with held-out trials.
struct SearchSolution {
    all: Vec<f64>,
    left_out: Vec<Vec<f64>>,
    report: SearchReport,
}

impl CandidateSolution for CoefficientFit {
    fn fit(&self, _: &[TermVariant]) -> Result<Option<CoefficientFit>, RefineError> {
        Ok(Some(self.clone()))
    }

    /// A search without derivatives gives no errors.
    fn coefficient_errors(
        &self,
        _: &RefinementProblem<'_>,
        _: &[TermVariant],
    ) -> Result<Option<CoefficientErrors>, RefineError> {
        Ok(None)
    }
}

/// Adds a candidate for each family of terms.
///
/// # Errors
/// Returns an error if a trial lacks a channel, if the trials are too short, or if it was
/// cancelled.
pub(super) fn add_search_candidates(
    problem: &RefinementProblem<'_>,
    variants: &[TermVariant],
    candidates: &mut Vec<CandidateFit>,
    progress: Progress<'_>,
) -> Result<(), RefineError> {
    let settings = problem.settings.cma_es.clone().unwrap_or_default();
    for (index, variant) in variants.iter().enumerate() {
        let told = |done: f64, what: &str| {
            report_progress(progress, progress_fraction(index, done, variants.len()), what)
        };
        let searching = VariantSearch::new(problem, variant, &settings)?;
        let found = searching.run_search(&told)?;
        candidates.push(searching.build_candidate(found)?);
    }
    Ok(())
}

/// Lengths by which trials are divided into subsequences, with comparisons on samples.
fn subsequence_lengths(problem: &RefinementProblem<'_>) -> SegmentLengths {
    let (interval, settings) = (problem.interval_s(), &problem.settings);
    let wanted = settings.step_s.unwrap_or(interval);
    // Steps are whole intervals or whole parts of one, so that every sample falls on a step.
    let step_s = if wanted >= interval {
        interval * (wanted / interval).round()
    } else {
        interval / (interval / wanted).ceil()
    };
    let residual_s = settings.residual_s.unwrap_or(interval).max(step_s);
    SegmentLengths {
        segment_s: settings.segment_s.unwrap_or(OBJECTIVE.fallback_steps * step_s),
        residual_s,
        step_s,
    }
}

impl<'a> VariantSearch<'a> {
    fn new(
        problem: &'a RefinementProblem<'a>,
        variant: &'a TermVariant,
        settings: &'a CmaEs,
    ) -> Result<Self, RefineError> {
        let system = CandidateSystem::new(&variant.model, problem.law)?;
        let cutting = subsequence_lengths(problem);
        let plan = comparison_plan(problem, &system, cutting)?;
        let segments = divide_into_segments(
            &problem.training,
            problem.law,
            system.input_names(),
            cutting,
            &plan,
        )?;
        if segments.is_empty() {
            return Err(RefineError::Data(
                "all trials are shorter than a third of a subsequence; give longer trials or a \
                 shorter subsequence"
                    .into(),
            ));
        }
        // The ship is needed for its physical range only.
        let ship = prepare_ship(&variant.model, problem.law, &problem.training)?;
        let sizes = natural_sizes(variant, system.names())?;
        // A coefficient of size zero has no effect on the trials and keeps the source's value.
        let moved = (0..sizes.len()).filter(|k| sizes[*k] > 0.0).collect();
        let objective = SearchObjective {
            // Accelerations are means over a few steps, as the measured ones that limit them.
            deviation: DeviationPenalty::new(
                &system,
                problem.law,
                &problem.training,
                cutting.step_s,
                OBJECTIVE.mean_steps * cutting.step_s,
            ),
            source: system.names().iter().map(|name| variant.model.coefficient(name)).collect(),
            system,
            plan,
            method: settings.integration,
            envelope: *ship.envelope(),
            weights: (settings.deviation, settings.absolute),
            sizes,
            width: settings.box_width,
        };
        Ok(Self { problem, variant, settings, objective, segments, moved })
    }

    /// Searches on all trials, then without those of each fold.
    fn run_search(&self, told: PartProgress<'_>) -> Result<SearchSolution, RefineError> {
        let given = self.settings;
        let budget = SearchBudget {
            evaluations: given.evaluations,
            wall_s: given.wall_s,
            cpu_s: given.cpu_s,
        };
        let sequences = SubsequenceSet::new(&self.objective, self.segments.iter());
        let search = self.new_search(budget, given.seed);
        let cost =
            |parameters: &[f64]| self.objective.cost(&sequences, &self.all_parameters(parameters));
        let mut tell = |standing: &SearchState<'_>| self.report_state(standing, &budget, told);
        let outcome = search
            .find_minimum(&cost, &mut tell)
            .map_err(|SearchCancelled| RefineError::Cancelled)?;
        // The budget of folds counts evaluations only: it is a share of those that were made, so
        // that the result can be reproduced.
        let budget = SearchBudget {
            evaluations: (given.fold_share * outcome.spent.evaluations as f64).ceil() as usize,
            wall_s: None,
            cpu_s: None,
        };
        let mut fold_evaluations = 0;
        let mut left_out = Vec::new();
        for fold in 0..self.problem.fold_count() {
            told(
                0.7 + 0.3 * fold as f64 / self.problem.fold_count() as f64,
                "searching without the trials of each fold",
            )?;
            let again = self.search_fold(fold, &outcome, budget, told)?;
            fold_evaluations += again.spent.evaluations;
            left_out.push(self.objective.coefficients_at(&self.all_parameters(&again.best)));
        }
        let all = self.objective.coefficients_at(&self.all_parameters(&outcome.best));
        // Error and deviation are reported without their weights.
        let report = SearchReport {
            seed: given.seed,
            evaluations: outcome.spent.evaluations,
            fold_evaluations,
            restarts: outcome.populations.len() - 1,
            populations: outcome.populations,
            objective: outcome.cost,
            error: self.objective.mean_error(&sequences, &all),
            deviation: self.objective.deviation_penalty(&all),
        };
        Ok(SearchSolution { all, left_out, report })
    }

    /// Continues from the optimum for all trials with those of a fold held out.
    fn search_fold(
        &self,
        fold: usize,
        optimum: &SearchOutcome,
        budget: SearchBudget,
        told: PartProgress<'_>,
    ) -> Result<SearchOutcome, RefineError> {
        let inside = |segment: &&TrialSegment| self.problem.is_fitted(segment.trial, fold);
        let sequences = SubsequenceSet::new(&self.objective, self.segments.iter().filter(inside));
        let cost =
            |parameters: &[f64]| self.objective.cost(&sequences, &self.all_parameters(parameters));
        let search =
            // Folds have different seeds, so that they draw different candidates.
            self.new_search(budget, self.settings.seed.wrapping_add(1000 * (fold as u64 + 1)));
        // The shape of the distribution is kept; its spread is at least the given one, so that a
        // converged search moves again.
        let first = optimum.strategy.restart_at(
            &optimum.best,
            OBJECTIVE.fold_spread * self.settings.spread,
            search.seed,
        );
        let mut tell =
            |_: &SearchState<'_>| told(0.7, "searching without the trials of each fold").is_ok();
        search
            .search_from(first, &cost, &mut tell)
            .map_err(|SearchCancelled| RefineError::Cancelled)
    }

    /// The settings of one search over the coefficients in `moved`.
    fn new_search(&self, budget: SearchBudget, seed: u64) -> CmaEsSearch {
        let CmaEs { population, largest_population, spread, box_width, .. } = *self.settings;
        CmaEsSearch {
            widths: vec![box_width; self.moved.len()],
            sigma: spread,
            population,
            largest_population,
            seed,
            budget,
        }
    }

    /// Parameters of all coefficients from those that are searched; 0 for the others.
    fn all_parameters(&self, searched: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0; self.objective.source.len()];
        self.moved.iter().zip(searched).for_each(|(&k, value)| all[k] = *value);
        all
    }

    /// Reports the state of the search to the observer and the callback; returns false if it is
    /// cancelled.
    fn report_state(
        &self,
        standing: &SearchState<'_>,
        budget: &SearchBudget,
        told: PartProgress<'_>,
    ) -> bool {
        let (best, cost) = standing.best;
        let model = || self.model_with(&self.objective.coefficients_at(&self.all_parameters(best)));
        self.problem.notify_observer(&FitIterate {
            evaluations: standing.spent.evaluations,
            objective: cost,
            model: &model,
        });
        let what = format!(
            "{} evaluations, objective {cost:.4}, restarts {}",
            standing.spent.evaluations, standing.restarts
        );
        told(0.7 * standing.spent.used_share(budget).min(1.0), &what).is_ok()
    }

    /// The model of the variant with these coefficients.
    fn model_with(&self, coefficients: &[f64]) -> Model {
        let values: BTreeMap<String, f64> = self
            .objective
            .system
            .names()
            .iter()
            .cloned()
            .zip(coefficients.iter().copied())
            .collect();
        self.variant.model_at(&values)
    }

    /// The candidate of a finished search, with its held-out trials simulated.
    fn build_candidate(&self, found: SearchSolution) -> Result<CandidateFit, RefineError> {
        let models: Vec<Model> =
            found.left_out.iter().map(|coefficients| self.model_with(coefficients)).collect();
        let simulated =
            simulate_training(self.problem, &models, &|trial| self.problem.fold_of(trial))?;
        let one = |(k, name): (usize, &String)| {
            let deviation = self.objective.sizes[k];
            (
                name.clone(),
                // A search gives no standard errors; the natural size takes the place of the
                // prior's deviation.
                FittedCoefficient {
                    value: found.all[k],
                    standard_error: 0.0,
                    prior_deviation: deviation,
                },
            )
        };
        let coefficients = self.objective.system.names().iter().enumerate().map(one).collect();
        // The search has no regression whose condition could be reported.
        let fit = CoefficientFit {
            coefficients,
            parameters: BTreeMap::new(),
            condition_number: 1.0,
            collinear_groups: Vec::new(),
            errors: None,
        };
        let label = format!("cma-es, {}", self.variant.family.name());
        let candidate =
            CandidateFit::new(self.problem, (label, None), fit, self.moved.len(), simulated);
        Ok(CandidateFit { left_out: models, search: Some(found.report), ..candidate })
    }
}

/// The plan of comparisons: of u, v and r.
fn comparison_plan(
    problem: &RefinementProblem<'_>,
    system: &CandidateSystem,
    cutting: SegmentLengths,
) -> Result<ComparisonPlan, RefineError> {
    let all = compared_states(system.state_places(), &problem.deviations);
    // The objective of the paper has u, v and r only.
    let velocities: Vec<_> =
        all.into_iter().filter(|&(_, place, _)| [at::U, at::V, at::R].contains(&place)).collect();
    if velocities.len() < 3 {
        let missing = [Channel::U, Channel::V, Channel::R]
            .into_iter()
            .find(|channel| !problem.deviations.contains_key(channel));
        let message = missing
            .map_or("a velocity is constant in all trials".to_owned(), |channel| {
                format!("no trial has `{channel}`")
            });
        return Err(RefineError::Data(message));
    }
    let stride = (cutting.residual_s / cutting.step_s).round().max(1.0) as usize;
    Ok(ComparisonPlan { compared: velocities, stride, step_s: cutting.step_s })
}

/// The change of each coefficient that changes an acceleration by the acceleration's own root mean
/// square; zero where the trials have no information on it.
fn natural_sizes(variant: &TermVariant, names: &[String]) -> Result<Vec<f64>, RefineError> {
    let all = variant.merged_moments(|_| true)?;
    // Without a source (`lambda` of 0) the diagonal of the weak form's Hessian is the square of
    // each coefficient's effect, relative to the acceleration's mean square.
    let prior = WeakFormPrior::new(names, &variant.blocks, &all, &|_| (0.0, 0.0), 0.0);
    let size =
        |square: &f64| if *square > 0.0 && square.is_finite() { 1.0 / square.sqrt() } else { 0.0 };
    Ok(prior.hessian.diagonal().iter().map(size).collect())
}
