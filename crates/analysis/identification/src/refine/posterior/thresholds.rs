//! Every constant of the posterior, with symbol, meaning, unit and source.
//!
//! A source that begins with "chosen" has no measurement of how results move at half and at double
//! the value: the reason that can be given is the one of the mathematics.

/// How residuals and the source's deviations are measured.
#[derive(Debug, Clone, Copy)]
pub(super) struct PosteriorThresholds {
    /// `lambda_r`: strength at which residuals are taken, dimensionless. Source:
    /// `docs/evidence/intervals.md`: at the chosen strength the source's error would count as
    /// noise; this one holds nothing that the trials can tell.
    pub residual_strength: f64,
    /// `f_0`: least share of the residuals' variance that coefficients may leave for it to be
    /// corrected, dimensionless. Source: chosen; below it residuals say nothing of their own size.
    pub least_left: f64,
    /// `b`: lags that count, by the lag at which residuals have forgotten, a count. Source: chosen;
    /// Bartlett's weights have then fallen to half at that lag.
    pub bandwidth: usize,
    /// Deviations tried of the source's coefficients by their own size, dimensionless. Source:
    /// chosen, from a thousandth to three times a coefficient.
    pub relative: LogGrid,
    /// Deviations tried of all coefficients alike, by the root mean square of the target,
    /// dimensionless. Source: chosen, from what no trial can tell to ten times all of the target.
    pub common: LogGrid,
    /// `e_0`: eigenvalue by the largest below which a direction of the regressors says nothing,
    /// dimensionless. Source: derived: the root of it is far below any noise by its signal, and it
    /// is far above rounding.
    pub silent: f64,
    /// `e_d`: added to the diagonal of a covariance of unit size, dimensionless. Source: derived,
    /// as [`Self::silent`].
    pub ridge: f64,
}

/// Values evenly spaced in their logarithm.
#[derive(Debug, Clone, Copy)]
pub(super) struct LogGrid {
    /// The least.
    pub least: f64,
    /// The greatest.
    pub most: f64,
    /// How many.
    pub count: usize,
}

impl LogGrid {
    /// The values, from the least on.
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
