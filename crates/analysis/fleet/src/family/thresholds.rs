//! All constants of learning a family, with symbol, meaning, unit and source.
//!
//! A source that begins with "chosen" has no measurement of how results move at half and at double
//! the value: the reason that can be given is the one of the mathematics.

/// Constants of learning a family.
#[derive(Debug, Clone, Copy)]
pub(super) struct FamilyThresholds {
    /// `N_0`: members with trials at least, a count. Source: derived: of two members the difference
    /// is one number, which does not determine how members differ.
    pub least_members: usize,
    /// `n_i`: most steps of expectation and maximisation, a count. Source: chosen;
    /// [`Self::settled`] ends them earlier.
    pub steps: usize,
    /// `e_s`: relative change of the deviations at which steps end, dimensionless. Source: chosen,
    /// far below the relative error of a deviation over `N` members, `1/sqrt(2 N)`.
    pub settled: f64,
    /// `d_0`: deviation at the start, in units in which a coefficient of 1 would explain its axis
    /// alone, dimensionless. Source: chosen; wide, so that members are determined by their own
    /// trials in the first step.
    pub start: f64,
    /// `d_1`: least deviation, in the same units, dimensionless. Source: chosen; less changes
    /// nothing, and keeps a covariance positive.
    pub least: f64,
    /// `e_t`: information of the trials on a direction, relative to the best one, below which it is
    /// left to the family, dimensionless. Source: derived: far above rounding, and far below what a
    /// prior of the family's width would leave to trials.
    pub telling: f64,
}

/// Values of the constants.
pub(super) const FAMILY: FamilyThresholds = FamilyThresholds {
    least_members: 3,
    steps: 200,
    settled: 2e-3,
    start: 0.5,
    least: 1e-4,
    telling: 1e-8,
};
