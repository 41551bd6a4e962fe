//! Estimate of a current with its error, and the limits within which it is used.

/// Components of a current with their largest standard error, m/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CurrentEstimate {
    /// To the north.
    pub north: f64,
    /// To the east.
    pub east: f64,
    /// Standard error.
    pub error: f64,
}

/// Least current that is stated, as a multiple of its standard error and in m/s. The standard error
/// is too small where a turn is not steady: a simulated log without a current shows 0.09 m/s with one
/// of 0.021.
const LEAST_ERRORS: f64 = 4.0;
const LEAST_M_S: f64 = 0.1;
/// Largest standard error of an estimate that is used, m/s.
pub(super) const LARGEST_ERROR: f64 = 0.05;

impl CurrentEstimate {
    /// Speed, m/s.
    pub fn speed(&self) -> f64 {
        self.north.hypot(self.east)
    }

    /// True if the current is large enough to be stated, and beyond its error.
    pub fn is_stated(&self) -> bool {
        self.speed() > LEAST_M_S.max(LEAST_ERRORS * self.error)
    }
}
