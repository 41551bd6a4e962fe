//! Thresholds of detection limits.

/// Detectability of an effect.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LimitThresholds {
    /// `z_d`: quantile of the normal distribution with which the evidence must be sufficient,
    /// dimensionless. Source: derived: 90 % of cases.
    pub quantile: f64,
    /// `q`: ratio of one size to the next smaller, dimensionless. Source: chosen: a limit is known
    /// within 5 %, far finer than the factor of three between half and one and a half of it.
    pub ratio: f64,
    /// `n_d`: most sizes that are evaluated, a count, from the bound of the parameter down. Source:
    /// derived: with [`Self::ratio`] down to 1e-5 of the bound, which is a thousandth of a usual
    /// size where the library's bounds are widest (100 times the usual).
    pub steps: usize,
}

/// Values of detection limits.
pub(super) const LIMITS: LimitThresholds =
    LimitThresholds { quantile: 1.2816, ratio: 1.1, steps: 121 };
