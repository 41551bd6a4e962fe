//! Constants of the posterior, with symbol, meaning, unit and source.
//!
//! A source that begins with "chosen" has not been measured at half and at double the value; the
//! reason given is a mathematical one.

/// Constants by which residuals and the source's deviations are measured.
#[derive(Debug, Clone, Copy)]
pub(super) struct PosteriorThresholds {
    /// `lambda_r`: strength of the prior at which residuals are taken, dimensionless. Source:
    /// `docs/evidence/intervals.md`: at the chosen strength the source's error would count as
    /// noise; at this one the source has no influence where the trials have information.
    pub residual_strength: f64,
    /// `f_0`: smallest share of the residuals' variance that coefficients may leave for it to be
    /// corrected, dimensionless. Source: chosen; below it residuals have no information on their
    /// own size.
    pub least_left: f64,
    /// `b`: number of lags that count, relative to the lag at which residuals are uncorrelated, a
    /// count. Source: chosen; Bartlett's weights have then fallen to half at that lag.
    pub bandwidth: usize,
    /// Deviations of the source's coefficients that are tried, relative to their own size,
    /// dimensionless. Source: chosen, from a thousandth to three times a coefficient.
    pub relative: LogGrid,
    /// Deviations of all coefficients alike that are tried, relative to the root mean square of the
    /// target, dimensionless. Source: chosen, from less than trials can resolve to ten times the
    /// target.
    pub common: LogGrid,
    /// `e_0`: ratio to the largest eigenvalue below which a direction of the regressors has no
    /// information, dimensionless. Source: derived: its root is far below any ratio of noise to
    /// signal, and it is far above rounding.
    pub silent: f64,
    /// `e_d`: added to the diagonal of a covariance of unit size, dimensionless. Source: derived,
    /// as [`Self::silent`].
    pub ridge: f64,
}

/// Values evenly spaced in their logarithm.
#[derive(Debug, Clone, Copy)]
pub(super) struct LogGrid {
    /// Least value.
    pub least: f64,
    /// Greatest value.
    pub most: f64,
    /// Number of values.
    pub count: usize,
}

impl LogGrid {
    /// Returns the values, from the least to the greatest.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        let (low, step) =
            (self.least.ln(), (self.most / self.least).ln() / (self.count - 1) as f64);
        (0..self.count).map(move |k| (low + k as f64 * step).exp())
    }
}

/// The values.
pub(super) const POSTERIOR: PosteriorThresholds = PosteriorThresholds {
    residual_strength: 1e-5,
    least_left: 0.1,
    bandwidth: 2,
    relative: LogGrid { least: 1e-3, most: 3.0, count: 13 },
    common: LogGrid { least: 1e-4, most: 10.0, count: 13 },
    silent: 1e-9,
    ridge: 1e-9,
};
