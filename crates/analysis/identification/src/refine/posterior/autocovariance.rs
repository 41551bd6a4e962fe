//! Autocovariance of residuals within each equation, and their covariance between equations.

use nalgebra::DVector;

use super::thresholds::POSTERIOR;

/// Weighted autocovariances up to the lag at which their weights vanish.
pub(super) struct ResidualAutocovariance {
    /// Values by pair of equations (rows of the lower triangle), then by lag.
    pairs: Vec<Vec<f64>>,
}

impl ResidualAutocovariance {
    /// Computes the autocovariances of residuals by equation and sequence.
    pub fn from_residuals(residuals: &[Vec<DVector<f64>>]) -> Self {
        let longest = residuals.iter().flatten().map(DVector::len).max().unwrap_or(0);
        let own = |own: &Vec<DVector<f64>>| {
            correlation_length(longest, &|lag| lag_covariance(own, own, lag))
        };
        let last = residuals.iter().map(own).max().unwrap_or(0);
        // The equation with the longest memory sets the lags of all.
        let lags = (POSTERIOR.bandwidth * (last + 1)).min(longest.max(1));
        let pair = |i: usize, j: usize| {
            // Bartlett's weights keep every variance made of them above zero (Newey and West 1987,
            // Theorem 1).
            let weight = |lag: usize| 1.0 - lag as f64 / lags as f64;
            (0..lags)
                .map(|lag| weight(lag) * symmetric_covariance(&residuals[i], &residuals[j], lag))
                .collect()
        };
        let pairs = (0..residuals.len()).flat_map(|i| (0..=i).map(move |j| (i, j)));
        Self { pairs: pairs.map(|(i, j)| pair(i, j)).collect() }
    }

    /// Returns the weighted covariance of two equations' residuals by lag, for `other <= one`.
    pub fn weighted_kernel(&self, one: usize, other: usize) -> Vec<f64> {
        self.pairs[one * (one + 1) / 2 + other].clone()
    }

    /// Returns the mean square of an equation's residuals.
    pub fn residual_variance(&self, one: usize) -> f64 {
        self.weighted_kernel(one, one).first().copied().unwrap_or(0.0)
    }
}

/// The lag until which sums of two neighbouring autocovariances stay above zero (Geyer 1992,
/// Statistical Science 7, 473-483, section 3.3), at most a third of the longest sequence.
fn correlation_length(longest: usize, covariance: &dyn Fn(usize) -> f64) -> usize {
    let most = longest / 3;
    let pair = |m: usize| covariance(2 * m) + covariance(2 * m + 1);
    2 * (1..=most / 2).find(|&m| pair(m) <= 0.0).unwrap_or(most / 2)
}

/// Covariance at a lag over all sequences, divided by the number of rows rather than of products,
/// so that covariances of all lags together are those of some process.
fn lag_covariance(one: &[DVector<f64>], other: &[DVector<f64>], lag: usize) -> f64 {
    let count: usize = one.iter().map(DVector::len).sum();
    let product = |(a, b): (&DVector<f64>, &DVector<f64>)| {
        a.iter().zip(b.iter().skip(lag)).map(|(x, y)| x * y).sum::<f64>()
    };
    one.iter().zip(other).map(product).sum::<f64>() / (count as f64).max(1.0)
}

/// Mean of the covariances at a positive and a negative lag.
fn symmetric_covariance(one: &[DVector<f64>], other: &[DVector<f64>], lag: usize) -> f64 {
    0.5 * (lag_covariance(one, other, lag) + lag_covariance(other, one, lag))
}
