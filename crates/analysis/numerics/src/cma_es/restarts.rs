//! Runs one after the other with a growing population, until the budget is used up.

use std::collections::VecDeque;

use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;
use rayon::prelude::*;

use super::bounds::Bounds;
use super::budget::{Budget, Spent};
use super::strategy::Strategy;

/// What is searched, and how: from zero in a box about it.
#[derive(Debug, Clone)]
pub struct CmaEsSearch {
    /// Half widths of the box.
    pub widths: Vec<f64>,
    /// Standard deviation of the first candidates, of a restart's too.
    pub sigma: f64,
    /// Population of the first run.
    pub population: usize,
    /// Largest population.
    pub largest_population: usize,
    /// Seed of all random numbers.
    pub seed: u64,
    /// When to end.
    pub budget: Budget,
}

/// How a search stands after a generation.
#[derive(Debug)]
pub struct SearchState<'a> {
    /// What was spent.
    pub spent: &'a Spent,
    /// The best point so far, with its cost.
    pub best: (&'a [f64], f64),
    /// The mean of the present run.
    pub mean: &'a [f64],
    /// Its population.
    pub population: usize,
    /// Runs before it.
    pub restarts: usize,
}

/// The caller asked to stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SearchCancelled;

/// What a search found.
#[derive(Debug, Clone)]
pub struct SearchOutcome {
    /// The best point.
    pub best: Vec<f64>,
    /// Its cost.
    pub cost: f64,
    /// The distribution of the run that found it, when it ended.
    pub strategy: Strategy,
    /// What was spent.
    pub spent: Spent,
    /// The population of each run.
    pub populations: Vec<usize>,
}

impl CmaEsSearch {
    /// Searches for the least cost; `cost` must be a function of the point alone, `told` answers
    /// `false` to stop.
    ///
    /// # Errors
    /// The caller asked to stop.
    pub fn least(
        &self,
        cost: &(dyn Fn(&[f64]) -> f64 + Sync),
        told: &mut dyn FnMut(&SearchState<'_>) -> bool,
    ) -> Result<SearchOutcome, SearchCancelled> {
        let start = vec![0.0; self.widths.len()];
        self.from(Strategy::new(&start, self.sigma, self.population, self.seed), cost, told)
    }

    /// As [`CmaEsSearch::least`], where the first run begins with a given distribution.
    ///
    /// # Errors
    /// The caller asked to stop.
    pub fn from(
        &self,
        first: Strategy,
        cost: &(dyn Fn(&[f64]) -> f64 + Sync),
        told: &mut dyn FnMut(&SearchState<'_>) -> bool,
    ) -> Result<SearchOutcome, SearchCancelled> {
        let start: Vec<f64> = Bounds::new(&self.widths).inside(first.mean().as_slice());
        let (mut spent, worth) = (Spent::nothing(), cost(&start));
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
            outcome.populations.push(strategy.population());
            let found = self.run(&mut strategy, cost, &mut outcome, told)?;
            if found {
                outcome.strategy = strategy.clone();
            }
            if outcome.spent.share(&self.budget) >= 1.0 {
                return Ok(outcome);
            }
            strategy = self.restarted(outcome.populations.len(), strategy.population());
        }
    }

    /// A run from anywhere in the box with twice the population.
    fn restarted(&self, restart: usize, population: usize) -> Strategy {
        let seed = self.seed.wrapping_add(restart as u64);
        let mut rng = ChaCha12Rng::seed_from_u64(seed);
        let start: Vec<f64> =
            self.widths.iter().map(|width| rng.random_range(-1.0..=1.0) * width).collect();
        Strategy::new(
            &start,
            self.sigma,
            (2 * population).min(self.largest_population.max(self.population)),
            seed,
        )
    }

    /// One run until it has converged or the budget is used up; says whether it found something
    /// better.
    fn run(
        &self,
        strategy: &mut Strategy,
        cost: &(dyn Fn(&[f64]) -> f64 + Sync),
        outcome: &mut SearchOutcome,
        told: &mut dyn FnMut(&SearchState<'_>) -> bool,
    ) -> Result<bool, SearchCancelled> {
        let mut bounds = Bounds::new(&self.widths);
        let (mut recent, mut found) = (VecDeque::new(), false);
        let patience = 10 + (30 * self.widths.len()).div_ceil(strategy.population());
        while outcome.spent.share(&self.budget) < 1.0 {
            let candidates = strategy.ask();
            let (mut points, mut costs) = evaluated(&bounds, &candidates, strategy.mean(), cost);
            outcome.spent.evaluations += costs.len();
            // Among hundreds of coordinates the mean is better than most of what is drawn about it:
            // it is evaluated too.
            let of_mean = costs.pop().zip(points.pop());
            let penalised: Vec<f64> = candidates
                .column_iter()
                .zip(&costs)
                .map(|(x, cost)| cost + bounds.penalty(x.as_slice()))
                .collect();
            let generation = costs.iter().copied().zip(points).chain(of_mean);
            if let Some((cost, point)) = generation.min_by(|a, b| a.0.total_cmp(&b.0)) {
                recent.push_front(cost);
                if cost < outcome.cost {
                    (outcome.best, outcome.cost, found) = (point, cost, true);
                }
            }
            recent.truncate(patience);
            strategy.tell(&penalised);
            bounds.adapt(strategy, &costs);
            let mean = bounds.inside(strategy.mean().as_slice());
            let standing = SearchState {
                spent: &outcome.spent,
                best: (&outcome.best, outcome.cost),
                mean: &mean,
                population: strategy.population(),
                restarts: outcome.populations.len() - 1,
            };
            if !told(&standing) {
                return Err(SearchCancelled);
            }
            if converged(&recent, patience) || strategy.exhausted() {
                break;
            }
        }
        Ok(found)
    }
}

/// Candidates and the mean brought inside, and what they cost there.
fn evaluated(
    bounds: &Bounds,
    candidates: &DMatrix<f64>,
    mean: &DVector<f64>,
    cost: &(dyn Fn(&[f64]) -> f64 + Sync),
) -> (Vec<Vec<f64>>, Vec<f64>) {
    let inside = candidates.column_iter().map(|x| bounds.inside(x.as_slice()));
    let points: Vec<Vec<f64>> = inside.chain([bounds.inside(mean.as_slice())]).collect();
    let costs = points
        .par_iter()
        .map(|point| cost(point))
        .map(|cost| if cost.is_nan() { f64::INFINITY } else { cost });
    let costs = costs.collect();
    (points, costs)
}

/// Whether the best of a generation has not changed for long: Auger and Hansen 2005, with a
/// tolerance by its own size.
fn converged(recent: &VecDeque<f64>, patience: usize) -> bool {
    let (low, high) = recent
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), c| (low.min(*c), high.max(*c)));
    recent.len() >= patience && high - low <= 1e-12 + 1e-9 * low.abs()
}

#[cfg(test)]
#[path = "restarts_tests.rs"]
mod tests;
