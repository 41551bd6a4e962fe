//! Successive runs with a growing population, until the budget is used up.

use std::collections::VecDeque;

use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;
use rayon::prelude::*;

use super::bounds::BoundPenalty;
use super::budget::{SearchBudget, SearchUsage};
use super::strategy::EvolutionStrategy;

/// Settings of a search, which starts from zero in a box about it.
#[derive(Debug, Clone)]
pub struct CmaEsSearch {
    /// Half widths of the box.
    pub widths: Vec<f64>,
    /// Standard deviation of the first candidates of every run.
    pub sigma: f64,
    /// Population of the first run.
    pub population: usize,
    /// Largest population.
    pub largest_population: usize,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Budget of the search.
    pub budget: SearchBudget,
}

/// State of a search after a generation.
#[derive(Debug)]
pub struct SearchState<'a> {
    /// Resources used so far.
    pub spent: &'a SearchUsage,
    /// Best point so far, with its cost.
    pub best: (&'a [f64], f64),
    /// Mean of the present run, inside the box.
    pub mean: &'a [f64],
    /// Population of the present run.
    pub population: usize,
    /// Number of runs before it.
    pub restarts: usize,
}

/// Error of a search that was stopped by its caller.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SearchCancelled;

/// Result of a search.
#[derive(Debug, Clone)]
pub struct SearchOutcome {
    /// Best point.
    pub best: Vec<f64>,
    /// Cost of the best point.
    pub cost: f64,
    /// Distribution of the run that found it, at the end of that run.
    pub strategy: EvolutionStrategy,
    /// Resources used.
    pub spent: SearchUsage,
    /// Population of each run.
    pub populations: Vec<usize>,
}

impl CmaEsSearch {
    /// Searches for the minimum of a cost. `cost` must depend on the point alone; the callback is
    /// called after each generation and returns false to stop.
    ///
    /// # Errors
    /// Returns an error if the caller asked to stop.
    pub fn find_minimum(
        &self,
        cost: &(dyn Fn(&[f64]) -> f64 + Sync),
        told: &mut dyn FnMut(&SearchState<'_>) -> bool,
    ) -> Result<SearchOutcome, SearchCancelled> {
        let start = vec![0.0; self.widths.len()];
        self.search_from(
            EvolutionStrategy::new(&start, self.sigma, self.population, self.seed),
            cost,
            told,
        )
    }

    /// The same search with a given initial distribution of the first run.
    ///
    /// # Errors
    /// Returns an error if the caller asked to stop.
    pub fn search_from(
        &self,
        first: EvolutionStrategy,
        cost: &(dyn Fn(&[f64]) -> f64 + Sync),
        told: &mut dyn FnMut(&SearchState<'_>) -> bool,
    ) -> Result<SearchOutcome, SearchCancelled> {
        // The first mean counts as a candidate, so the result is never worse than the start.
        let start: Vec<f64> =
            BoundPenalty::new(&self.widths).nearest_inside(first.mean().as_slice());
        let (mut spent, worth) = (SearchUsage::start_now(), cost(&start));
        spent.evaluations += 1;
        let mut outcome = SearchOutcome {
            best: start,
            cost: worth,
            strategy: first.clone(),
            spent,
            populations: Vec::new(),
        };
        let mut strategy = first;
        loop {
            outcome.populations.push(strategy.population_size());
            let found = self.run_once(&mut strategy, cost, &mut outcome, told)?;
            if found {
                outcome.strategy = strategy.clone();
            }
            if outcome.spent.used_share(&self.budget) >= 1.0 {
                return Ok(outcome);
            }
            strategy = self.restart_strategy(outcome.populations.len(), strategy.population_size());
        }
    }

    /// Distribution of a restart: a random point in the box, and twice the population.
    fn restart_strategy(&self, restart: usize, population: usize) -> EvolutionStrategy {
        // Another seed for each run, reproducible from the first.
        let seed = self.seed.wrapping_add(restart as u64);
        let mut rng = ChaCha12Rng::seed_from_u64(seed);
        let start: Vec<f64> =
            self.widths.iter().map(|width| rng.random_range(-1.0..=1.0) * width).collect();
        EvolutionStrategy::new(
            &start,
            self.sigma,
            (2 * population).min(self.largest_population.max(self.population)),
            seed,
        )
    }

    /// Runs one strategy until it has converged or the budget is used up. Returns true if it found
    /// a better point.
    fn run_once(
        &self,
        strategy: &mut EvolutionStrategy,
        cost: &(dyn Fn(&[f64]) -> f64 + Sync),
        outcome: &mut SearchOutcome,
        told: &mut dyn FnMut(&SearchState<'_>) -> bool,
    ) -> Result<bool, SearchCancelled> {
        let mut bounds = BoundPenalty::new(&self.widths);
        let (mut recent, mut found) = (VecDeque::new(), false);
        // Stagnation test over 10 + 30 n / population generations (Auger and Hansen 2005).
        let patience = 10 + (30 * self.widths.len()).div_ceil(strategy.population_size());
        while outcome.spent.used_share(&self.budget) < 1.0 {
            let candidates = strategy.draw_candidates();
            let (mut points, mut costs) =
                evaluate_candidates(&bounds, &candidates, strategy.mean(), cost);
            outcome.spent.evaluations += costs.len();
            // In hundreds of dimensions the mean is better than most candidates drawn about it, so
            // it is evaluated, too.
            let of_mean = costs.pop().zip(points.pop());
            // The strategy ranks candidates by penalised cost; the penalty weights follow the plain
            // cost.
            let penalised: Vec<f64> = candidates
                .column_iter()
                .zip(&costs)
                .map(|(x, cost)| cost + bounds.penalty_at(x.as_slice()))
                .collect();
            let generation = costs.iter().copied().zip(points).chain(of_mean);
            if let Some((cost, point)) = generation.min_by(|a, b| a.0.total_cmp(&b.0)) {
                recent.push_front(cost);
                if cost < outcome.cost {
                    (outcome.best, outcome.cost, found) = (point, cost, true);
                }
            }
            recent.truncate(patience);
            strategy.update_from_costs(&penalised);
            bounds.adapt_weights(strategy, &costs);
            let mean = bounds.nearest_inside(strategy.mean().as_slice());
            let standing = SearchState {
                spent: &outcome.spent,
                best: (&outcome.best, outcome.cost),
                mean: &mean,
                population: strategy.population_size(),
                restarts: outcome.populations.len() - 1,
            };
            if !told(&standing) {
                return Err(SearchCancelled);
            }
            if has_converged(&recent, patience) || strategy.is_exhausted() {
                break;
            }
        }
        Ok(found)
    }
}

/// Candidates and the mean moved into the box, and their costs there.
fn evaluate_candidates(
    bounds: &BoundPenalty,
    candidates: &DMatrix<f64>,
    mean: &DVector<f64>,
    cost: &(dyn Fn(&[f64]) -> f64 + Sync),
) -> (Vec<Vec<f64>>, Vec<f64>) {
    let inside = candidates.column_iter().map(|x| bounds.nearest_inside(x.as_slice()));
    let points: Vec<Vec<f64>> = inside.chain([bounds.nearest_inside(mean.as_slice())]).collect();
    let costs = points
        .par_iter()
        .map(|point| cost(point))
        // Not a number would have no rank.
        .map(|cost| if cost.is_nan() { f64::INFINITY } else { cost });
    let costs = costs.collect();
    (points, costs)
}

/// True if the best cost of a generation has not changed for a long time: Auger and Hansen 2005,
/// with a tolerance relative to its own size.
fn has_converged(recent: &VecDeque<f64>, patience: usize) -> bool {
    let (low, high) = recent
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), c| (low.min(*c), high.max(*c)));
    recent.len() >= patience && high - low <= 1e-12 + 1e-9 * low.abs()
}

#[cfg(test)]
#[path = "restarts_tests.rs"]
mod tests;
