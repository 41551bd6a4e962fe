//! Constants of the weak form, with symbol, meaning, unit and source. A window is as long as the
//! ship takes to travel its own length: for windows of 10, 14, 20 and 28 s the errors on held-out
//! trials differ by less than one per cent pooled and by seven per cent single
//! (`docs/evidence/estimators.md`).
//!
//! A source that begins with "chosen" has not been measured at half and at double the value; the
//! reason given is a mathematical one.

/// Constants of the windows.
#[derive(Debug, Clone, Copy)]
pub(super) struct WeakThresholds {
    /// `h/T`: distance from one window to the next as a share of a window, dimensionless. Source:
    /// chosen; windows that overlap by nine tenths share their information, so that more of them
    /// add none.
    pub hop: f64,
    /// Strengths that a single trial allows, from the source outwards, a count. Source: chosen: it
    /// cannot be left out.
    pub strengths_of_one_trial: usize,
    /// Least intervals in a window, a count. Source: chosen: fewer do not resolve the bump.
    pub least_intervals: f64,
    /// `n_w`: intervals of a window beyond which means of neighbouring samples are used, a count.
    /// Source: derived: the mean over a sixtieth of a window takes `(pi/60)^2/6`, less than a
    /// thousandth, from an oscillation within the window.
    pub most_intervals: f64,
    /// `(int b)^2 / int b^2` divided by the length of a window for `b = (1 - s^2)^3`,
    /// dimensionless: the effective share of a window with the weights of a bump. Source: derived:
    /// `(32/35)^2 / (2 * 2048/3003)`.
    pub equivalent: f64,
}

/// The values.
pub(super) const WEAK: WeakThresholds = WeakThresholds {
    hop: 0.1,
    strengths_of_one_trial: 3,
    least_intervals: 8.0,
    most_intervals: 60.0,
    equivalent: 0.612_9,
};
