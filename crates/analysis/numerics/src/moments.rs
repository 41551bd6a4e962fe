//! Sufficient statistics of a linear regression: counts, means and centred products, which can be
//! merged without the samples.

use nalgebra::{DMatrix, DVector};

/// Statistics of `p` regressors and `q` targets over a number of samples.
#[derive(Debug, Clone, PartialEq)]
pub struct RegressionMoments {
    /// Number of samples.
    pub count: f64,
    /// Means of the regressors, then of the targets.
    mean: DVector<f64>,
    /// Centred products of regressors and targets, `(p + q) x (p + q)`, symmetric.
    products: DMatrix<f64>,
    /// Number of regressors.
    regressors: usize,
}

/// Number of rows accumulated at a time: their columns stay in the first-level cache.
const CHUNK: usize = 128;

impl RegressionMoments {
    /// Creates the statistics of no samples.
    pub fn with_sizes(regressors: usize, targets: usize) -> Self {
        let size = regressors + targets;
        Self {
            count: 0.0,
            mean: DVector::zeros(size),
            products: DMatrix::zeros(size, size),
            regressors,
        }
    }

    /// Computes the statistics of samples given by column: each column holds one regressor or
    /// target over all samples.
    pub fn from_columns(columns: &[Vec<f64>], regressors: usize) -> Self {
        let rows = columns.first().map_or(0, Vec::len);
        let mut all = Self::with_sizes(regressors, columns.len() - regressors);
        for start in (0..rows).step_by(CHUNK) {
            let end = (start + CHUNK).min(rows);
            let chunk: Vec<&[f64]> = columns.iter().map(|column| &column[start..end]).collect();
            all.merge_samples(&Self::from_chunk(&chunk, regressors));
        }
        all
    }

    /// Computes the statistics of samples given by column, about zero instead of their means, for
    /// models without intercept; each sample counts as the share `weight` of an independent one.
    pub fn about_zero(columns: &[Vec<f64>], regressors: usize, weight: f64) -> Self {
        let size = columns.len();
        let rows = columns.first().map_or(0, Vec::len);
        let mut products = DMatrix::zeros(size, size);
        for i in 0..size {
            for j in i..size {
                // Only the upper triangle is computed.
                let product = weight * dot_product(&columns[i], &columns[j]);
                products[(i, j)] = product;
                products[(j, i)] = product;
            }
        }
        Self { count: weight * rows as f64, mean: DVector::zeros(size), products, regressors }
    }

    /// Computes the statistics of a few rows in two passes, means first.
    fn from_chunk(columns: &[&[f64]], regressors: usize) -> Self {
        let size = columns.len();
        let count = columns[0].len() as f64;
        let mean = DVector::from_iterator(
            size,
            columns.iter().map(|column| column.iter().sum::<f64>() / count),
        );
        let centre =
            |(column, mean): (&&[f64], &f64)| column.iter().map(|x| x - mean).collect::<Vec<f64>>();
        let centred: Vec<Vec<f64>> = columns.iter().zip(mean.iter()).map(centre).collect();
        let mut products = DMatrix::zeros(size, size);
        for i in 0..size {
            for j in i..size {
                let product = dot_product(&centred[i], &centred[j]);
                products[(i, j)] = product;
                products[(j, i)] = product;
            }
        }
        Self { count, mean, products, regressors }
    }

    /// Adds the statistics of other samples (Chan, Golub and LeVeque 1979, Eq. 2.1: without
    /// cancellation).
    pub fn merge_samples(&mut self, other: &Self) {
        let total = self.count + other.count;
        if other.count == 0.0 {
            return;
        }
        let shift = &other.mean - &self.mean;
        // Products of the shift between the two means, weighted by both counts.
        let weight = self.count * other.count / total;
        self.products += &other.products;
        self.products.ger(weight, &shift, &shift, 1.0);
        self.mean += &shift * (other.count / total);
        self.count = total;
    }

    /// Returns the statistics of several sets of samples together; `None` without any set.
    pub fn merge_all<'a>(parts: impl IntoIterator<Item = &'a Self>) -> Option<Self> {
        let mut parts = parts.into_iter();
        let mut all = parts.next()?.clone();
        parts.for_each(|part| all.merge_samples(part));
        Some(all)
    }

    /// Returns the statistics with each set of samples held out in turn, and those of all. Sums
    /// from both ends meet in the gap: nothing is subtracted, so that a regressor which only the
    /// held-out set excites has a variance of exactly zero.
    pub fn leave_one_out(parts: &[Self]) -> Option<(Vec<Self>, Self)> {
        let first = parts.first()?;
        let none = || Self::with_sizes(first.regressors, first.targets());
        let grown = |sum: &Self, part: &Self| {
            let mut sum = sum.clone();
            sum.merge_samples(part);
            sum
        };
        // after[k] holds the sum of the last k sets.
        let mut after = vec![none()];
        parts.iter().rev().for_each(|part| after.push(grown(&after[after.len() - 1], part)));
        let mut before = none();
        let mut without = Vec::with_capacity(parts.len());
        for (index, part) in parts.iter().enumerate() {
            without.push(grown(&before, &after[parts.len() - 1 - index]));
            before.merge_samples(part);
        }
        Some((without, after.swap_remove(parts.len())))
    }

    /// Returns the statistics of `map' z` where these are those of the samples `z`, regressors then
    /// targets; the first `regressors` columns of the map give the new regressors. Mapping and
    /// merging commute.
    pub fn map_linear(&self, map: &DMatrix<f64>, regressors: usize) -> Self {
        let transposed = map.transpose();
        Self {
            count: self.count,
            mean: &transposed * &self.mean,
            // Centred products transform as M' P M, whatever the mean is.
            products: &transposed * (&self.products * map),
            regressors,
        }
    }

    /// Returns the statistics of the same samples about zero instead of their means, for models
    /// without intercept.
    pub fn about_origin(&self) -> Self {
        let products = self.raw_products() * self.count;
        Self {
            count: self.count,
            mean: DVector::zeros(self.mean.len()),
            products,
            regressors: self.regressors,
        }
    }

    /// Returns the same statistics with the upper triangle of the products copied to the lower:
    /// summation leaves differences by rounding.
    pub fn symmetrize_products(mut self) -> Self {
        self.products.fill_lower_triangle_with_upper_triangle();
        self
    }

    /// Returns count, means and the upper triangle of the centred products, row by row.
    pub fn to_numbers(&self) -> Vec<f64> {
        let size = self.mean.len();
        let triangle =
            (0..size).flat_map(|i| (i..size).map(move |j| (i, j))).map(|at| self.products[at]);
        std::iter::once(self.count).chain(self.mean.iter().copied()).chain(triangle).collect()
    }

    /// Creates the statistics from such numbers. Returns `None` if their count does not match these
    /// regressors and targets, or if one is not finite.
    pub fn from_numbers(numbers: &[f64], regressors: usize, targets: usize) -> Option<Self> {
        let size = regressors + targets;
        if numbers.len() != 1 + size + size * (size + 1) / 2
            || numbers.iter().any(|x| !x.is_finite())
        {
            return None;
        }
        let mut triangle = numbers[1 + size..].iter();
        let mut products = DMatrix::zeros(size, size);
        for (i, j) in (0..size).flat_map(|i| (i..size).map(move |j| (i, j))) {
            let product = *triangle.next()?;
            products[(i, j)] = product;
            products[(j, i)] = product;
        }
        Some(Self {
            count: numbers[0],
            mean: DVector::from_column_slice(&numbers[1..=size]),
            products,
            regressors,
        })
    }

    /// Number of regressors.
    pub fn regressors(&self) -> usize {
        self.regressors
    }

    /// Number of targets.
    pub fn targets(&self) -> usize {
        self.mean.len() - self.regressors
    }

    /// Sum over the samples of regressors times residuals of the first target at `coefficients`,
    /// both about the means of `all`, of which these samples are a part.
    pub fn residual_score(&self, all: &Self, coefficients: &DVector<f64>) -> DVector<f64> {
        let p = self.regressors;
        let mut weights = DVector::zeros(self.mean.len());
        weights.rows_mut(0, p).copy_from(&-coefficients);
        // Residual = target - regressors' coefficients, as one linear combination of the columns.
        weights[p] = 1.0;
        let apart = &self.mean - &all.mean;
        let own = &self.products * &weights + &apart * (self.count * apart.dot(&weights));
        own.rows(0, p).into_owned()
    }

    /// Variance of a regressor.
    pub fn regressor_variance(&self, regressor: usize) -> f64 {
        self.products[(regressor, regressor)] / self.count
    }

    /// Mean of a regressor.
    pub fn regressor_mean(&self, regressor: usize) -> f64 {
        self.mean[regressor]
    }

    /// Covariance of two regressors.
    pub fn regressor_covariance(&self, i: usize, j: usize) -> f64 {
        self.products[(i, j)] / self.count
    }

    /// Covariance of a regressor and a target.
    pub fn covariance_with_target(&self, regressor: usize, target: usize) -> f64 {
        self.products[(regressor, self.regressors + target)] / self.count
    }

    /// Variance of a target.
    pub fn target_variance(&self, target: usize) -> f64 {
        let t = self.regressors + target;
        self.products[(t, t)] / self.count
    }

    /// Covariances of the regressors with each other, and with the targets.
    pub fn covariance_blocks(&self) -> (DMatrix<f64>, DMatrix<f64>) {
        let (p, q) = (self.regressors, self.targets());
        (
            self.products.view((0, 0), (p, p)) / self.count,
            self.products.view((0, p), (p, q)) / self.count,
        )
    }

    /// Mean products without centring, `E[x x']`, for the error of a model without intercept; zero
    /// without samples.
    pub fn raw_products(&self) -> DMatrix<f64> {
        let mut raw = &self.products / self.count.max(f64::MIN_POSITIVE);
        // E[x x'] = covariance + mean mean'.
        raw.ger(1.0, &self.mean, &self.mean, 1.0);
        raw
    }
}

/// Dot product in four independent sums, which the compiler turns into vector instructions.
fn dot_product(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (left, right) = (a.chunks_exact(4), b.chunks_exact(4));
    let tail: f64 = left.remainder().iter().zip(right.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in left.zip(right) {
        for k in 0..4 {
            sums[k] += x[k] * y[k];
        }
    }
    sums.iter().sum::<f64>() + tail
}

/// Returns the statistics of the trials for which `keep` is true, one set per regression; `None` if
/// there is no such trial.
pub fn merge_trials(
    moments: &[Vec<RegressionMoments>],
    keep: impl Fn(usize) -> bool,
) -> Option<Vec<RegressionMoments>> {
    let kept: Vec<&Vec<RegressionMoments>> =
        moments.iter().enumerate().filter(|(trial, _)| keep(*trial)).map(|(_, m)| m).collect();
    let blocks = kept.first()?.len();
    (0..blocks).map(|block| RegressionMoments::merge_all(kept.iter().map(|m| &m[block]))).collect()
}

#[cfg(test)]
#[path = "moments_tests.rs"]
mod tests;
