//! Thresholds of detection limits.

/// When an effect would have been shown.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LimitThresholds {
    /// `z_d`: quantile of the normal distribution by which the evidence must be enough,
    /// dimensionless. Source: derived: 90 % of cases.
    pub quantile: f64,
    /// `k_max`: the largest size that is tried, by the usual one, dimensionless. Source: chosen; what
    /// would have to be thirty times as large as usual is not looked for.
    pub largest: f64,
    /// `q`: ratio of one size to the next smaller, dimensionless. Source: chosen: a limit is known
    /// within 5 %, far finer than the factor of three between half and one and a half of it.
    pub ratio: f64,
    /// `n_d`: sizes at most, a count. Source: derived: with [`Self::ratio`] down to 1e-4 of the
    /// largest.
    pub steps: usize,
}

/// Their values.
pub(super) const LIMITS: LimitThresholds =
    LimitThresholds { quantile: 1.2816, largest: 30.0, ratio: 1.1, steps: 97 };
