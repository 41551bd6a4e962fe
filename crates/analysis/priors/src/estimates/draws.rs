//! Draws from a covariance.

use nalgebra::DMatrix;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;
use rand_distr::StandardNormal;

/// Generator of deviations from the mean, in antithetic pairs.
pub struct DeviationDraws {
    root: DMatrix<f64>,
    rng: ChaCha12Rng,
    mirrored: Option<Vec<f64>>,
}

impl DeviationDraws {
    /// Creates a generator from a covariance; a billionth is added to the diagonal against
    /// rounding.
    pub fn new(covariance: &DMatrix<f64>, seed: u64) -> Self {
        let mut raised = covariance.clone();
        for k in 0..raised.nrows() {
            raised[(k, k)] *= 1.0 + 1e-9;
        }
        // Without a Cholesky factor the correlations are dropped.
        let diagonal = || DMatrix::from_diagonal(&covariance.diagonal().map(f64::sqrt));
        let root = raised.cholesky().map_or_else(diagonal, |cholesky| cholesky.l());
        Self { root, rng: ChaCha12Rng::seed_from_u64(seed), mirrored: None }
    }

    /// Next deviations.
    pub fn next_deviations(&mut self) -> Vec<f64> {
        if let Some(mirrored) = self.mirrored.take() {
            return mirrored;
        }
        let size = self.root.nrows();
        let normal = nalgebra::DVector::from_fn(size, |_, _| self.rng.sample(StandardNormal));
        // x = L z with z standard normal; -x is returned next.
        let moved: Vec<f64> = (&self.root * normal).iter().copied().collect();
        self.mirrored = Some(moved.iter().map(|x| -x).collect());
        moved
    }
}
