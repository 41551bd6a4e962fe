//! Evolution strategy of one run: a normal distribution that draws candidates and adapts to their
//! costs.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;
use rand_distr::StandardNormal;

use super::weights::RecombinationWeights;

/// Distribution of candidates, with the evolution paths by which it adapts.
#[derive(Debug, Clone)]
pub struct EvolutionStrategy {
    weights: RecombinationWeights,
    mean: DVector<f64>,
    sigma: f64,
    covariance: DMatrix<f64>,
    /// Eigenvectors of the covariance times the roots of its eigenvalues.
    axes: DMatrix<f64>,
    vectors: DMatrix<f64>,
    roots: DVector<f64>,
    step_path: DVector<f64>,
    path: DVector<f64>,
    generation: usize,
    decomposed: usize,
    /// Last candidates: standard normal, and transformed by the axes.
    normal: DMatrix<f64>,
    shaped: DMatrix<f64>,
    rng: ChaCha12Rng,
}

impl EvolutionStrategy {
    /// Creates a distribution about a point, with the same standard deviation for every coordinate.
    /// A population below 4 is raised to 4.
    pub fn new(start: &[f64], sigma: f64, population: usize, seed: u64) -> Self {
        let (n, population) = (start.len(), population.max(4));
        let identity = || DMatrix::identity(n, n);
        Self {
            weights: RecombinationWeights::new(n, population),
            mean: DVector::from_column_slice(start),
            sigma,
            covariance: identity(),
            axes: identity(),
            vectors: identity(),
            roots: DVector::repeat(n, 1.0),
            step_path: DVector::zeros(n),
            path: DVector::zeros(n),
            generation: 0,
            decomposed: 0,
            normal: DMatrix::zeros(n, population),
            shaped: DMatrix::zeros(n, population),
            rng: ChaCha12Rng::seed_from_u64(seed),
        }
    }

    /// Returns a distribution of the same shape about another mean with other random numbers,
    /// without its paths. The mean standard deviation over the coordinates is at least `deviation`,
    /// so that a converged distribution moves again.
    #[must_use]
    pub fn restart_at(&self, mean: &[f64], deviation: f64, seed: u64) -> Self {
        let mut renewed = self.clone();
        let variance = self.covariance.diagonal().mean().max(f64::MIN_POSITIVE);
        let sigma = self.sigma.max(deviation / variance.sqrt());
        renewed.mean = DVector::from_column_slice(mean);
        renewed.step_path.fill(0.0);
        renewed.path.fill(0.0);
        renewed.generation = 0;
        renewed.decomposed = 0;
        renewed.sigma = sigma;
        renewed.rng = ChaCha12Rng::seed_from_u64(seed);
        renewed
    }

    /// Draws candidates, one per column.
    pub fn draw_candidates(&mut self) -> DMatrix<f64> {
        let rng = &mut self.rng;
        self.normal.iter_mut().for_each(|value| *value = rng.sample(StandardNormal));
        self.shaped = &self.axes * &self.normal;
        let mut candidates = &self.shaped * self.sigma;
        candidates.column_iter_mut().for_each(|mut candidate| candidate += &self.mean);
        candidates
    }

    /// Updates the distribution by the costs of the last candidates; only their order counts.
    pub fn update_from_costs(&mut self, costs: &[f64]) {
        let mut order: Vec<usize> = (0..costs.len()).collect();
        order.sort_by(|a, b| costs[*a].total_cmp(&costs[*b]));
        self.generation += 1;
        let parents = self.weights.parents;
        // Only the parents, which have positive weights, move the mean.
        let weighted = |of: &DMatrix<f64>| {
            let sum = |sum: DVector<f64>, (k, w): (&usize, &f64)| sum + of.column(*k) * *w;
            order[..parents].iter().zip(&self.weights.all).fold(DVector::zeros(of.nrows()), sum)
        };
        // Steps of the mean by weighted recombination of the best candidates.
        let (moved, normal) = (weighted(&self.shaped), weighted(&self.normal));
        self.mean += &moved * self.sigma;
        let steady = self.extend_paths(&moved, &normal);
        self.adapt_covariance(&order, steady);
        let RecombinationWeights { step_rate, step_damping, expected_length, .. } = self.weights;
        // Cumulative step-size adaptation: sigma grows if the path is longer than that of random
        // steps.
        self.sigma *= (step_rate / step_damping * (self.step_path.norm() / expected_length - 1.0))
            .min(1.0)
            .exp();
        if self.generation - self.decomposed >= self.weights.decomposition_interval(self.mean.len())
        {
            self.decompose_covariance();
        }
    }

    /// Extends both evolution paths by a step. Returns true unless the covariance path is stalled
    /// because the step-size path is too long.
    fn extend_paths(&mut self, moved: &DVector<f64>, normal: &DVector<f64>) -> bool {
        let RecombinationWeights { step_rate, path_rate, mass, expected_length, .. } = self.weights;
        self.step_path *= 1.0 - step_rate;
        // The standard normal step rotated by the eigenvectors equals C^(-1/2) times the step.
        self.step_path += (&self.vectors * normal) * (step_rate * (2.0 - step_rate) * mass).sqrt();
        // Bias correction of the path in the first generations.
        let settled =
            (1.0 - (1.0 - step_rate).powi(2 * self.generation.min(1 << 20) as i32)).sqrt();
        let longest = (1.4 + 2.0 / (self.mean.len() as f64 + 1.0)) * expected_length;
        let steady = self.step_path.norm() / settled < longest;
        self.path *= 1.0 - path_rate;
        if steady {
            self.path += moved * (path_rate * (2.0 - path_rate) * mass).sqrt();
        }
        steady
    }

    /// Updates the covariance towards good candidates and away from bad ones.
    fn adapt_covariance(&mut self, order: &[usize], steady: bool) {
        let RecombinationWeights { rank_one_rate, rank_mu_rate, path_rate, .. } = self.weights;
        let n = self.mean.len() as f64;
        // Compensates the variance that a stalled path does not contribute.
        let missed = if steady { 0.0 } else { path_rate * (2.0 - path_rate) };
        let kept = 1.0 + rank_one_rate * missed
            - rank_one_rate
            - rank_mu_rate * self.weights.all.iter().sum::<f64>();
        let mut scaled = self.shaped.clone();
        for (k, w) in order.iter().zip(&self.weights.all) {
            let factor = if *w >= 0.0 {
                *w
            } else {
                // Negative weights are scaled by the candidate's length, which keeps the covariance
                // positive.
                w * n / self.normal.column(*k).norm_squared().max(f64::MIN_POSITIVE)
            };
            scaled.column_mut(*k).scale_mut(factor);
        }
        self.covariance.gemm(rank_mu_rate, &scaled, &self.shaped.transpose(), kept);
        self.covariance.ger(rank_one_rate, &self.path, &self.path, 1.0);
    }

    /// Recomputes axes and eigenvectors of the covariance.
    fn decompose_covariance(&mut self) {
        self.decomposed = self.generation;
        self.covariance = (&self.covariance + self.covariance.transpose()) * 0.5;
        let SymmetricEigen { eigenvectors, eigenvalues } =
            self.covariance.clone().symmetric_eigen();
        // Rounding may leave eigenvalues at or below zero.
        let least = 1e-14 * eigenvalues.max();
        self.roots = eigenvalues.map(|value| value.max(least).sqrt());
        self.axes = &eigenvectors * DMatrix::from_diagonal(&self.roots);
        self.vectors = eigenvectors;
    }

    /// Number of candidates per generation.
    pub fn population_size(&self) -> usize {
        self.normal.ncols()
    }

    /// The mean of the distribution.
    pub fn mean(&self) -> &DVector<f64> {
        &self.mean
    }

    /// The step size.
    pub fn sigma(&self) -> f64 {
        self.sigma
    }

    /// Variances of the coordinates.
    pub fn coordinate_variances(&self) -> DVector<f64> {
        self.covariance.diagonal() * self.sigma.powi(2)
    }

    /// Variance effective selection mass.
    pub(super) fn selection_mass(&self) -> f64 {
        self.weights.mass
    }

    /// True if no axis changes the mean any more, or the covariance is nearly singular (Auger and
    /// Hansen 2005).
    pub(super) fn is_exhausted(&self) -> bool {
        let (low, high) = (self.roots.min(), self.roots.max());
        let still = self
            .mean
            .iter()
            .zip(self.coordinate_variances().iter())
            .all(|(m, v)| m + 0.2 * v.sqrt() == *m);
        still || !self.sigma.is_finite() || high >= 1e7 * low
    }
}

#[cfg(test)]
#[path = "strategy_tests.rs"]
mod tests;
