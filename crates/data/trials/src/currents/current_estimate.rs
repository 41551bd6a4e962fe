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

/// Multiple of the standard error beyond which a current is stated, and two currents differ: 0.1 % of
/// normal errors of two components are beyond (chi-squared of two degrees of freedom, 13.8).
const CLEAR_ERRORS: f64 = 3.7;
/// Largest standard error of an estimate that is used, m/s.
pub(super) const LARGEST_ERROR: f64 = 0.05;

impl CurrentEstimate {
    /// Speed, m/s.
    pub fn speed(&self) -> f64 {
        self.north.hypot(self.east)
    }

    /// True if the current is distinguishable from none.
    pub fn is_stated(&self) -> bool {
        self.speed() > CLEAR_ERRORS * self.error
    }

    /// True if two estimates may be of one current.
    pub fn agrees_with(&self, other: &Self) -> bool {
        let distance = (self.north - other.north).hypot(self.east - other.east);
        distance <= CLEAR_ERRORS * self.error.hypot(other.error)
    }
}

/// Returns the mean of estimates weighted by their errors, if all may be of one current.
pub(super) fn common_current(known: &[CurrentEstimate]) -> Option<CurrentEstimate> {
    // Inverse variances, so that a short turn counts less than a long one.
    let weights: f64 = known.iter().map(|one| one.error.powi(-2)).sum();
    let mean = |of: fn(&CurrentEstimate) -> f64| {
        known.iter().map(|one| of(one) * one.error.powi(-2)).sum::<f64>() / weights
    };
    let common = CurrentEstimate {
        north: mean(|one| one.north),
        east: mean(|one| one.east),
        error: weights.powf(-0.5),
    };
    // Turns that disagree were in different water: none of them speaks for the others.
    let alike = known.iter().all(|one| one.agrees_with(&common));
    (alike && !known.is_empty()).then_some(common)
}
