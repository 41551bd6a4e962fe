//! Every constant of the weak form, with symbol, meaning, unit and source. A window is as long as
//! the ship takes to sail its length: of windows of 10, 14, 20 and 28 s the errors left out differ
//! by less than one per cent pooled and by seven per cent single (`docs/evidence/estimators.md`).
//!
//! A source that begins with "chosen" has no measurement of how results move at half and at double
//! the value: the reason that can be given is the one of the mathematics.

/// How windows follow each other.
#[derive(Debug, Clone, Copy)]
pub(super) struct WeakThresholds {
    /// `h/T`: from one window to the next, by a window, dimensionless. Source: chosen; windows that
    /// overlap by nine tenths repeat each other, so that more of them say nothing new.
    pub hop: f64,
    /// Strengths that a single trial allows, from the source outwards, a count. Source: chosen: it
    /// cannot be left out.
    pub strengths_of_one_trial: usize,
    /// Least intervals in a window, a count. Source: chosen: fewer cannot tell the bump from a
    /// spike.
    pub least_intervals: f64,
    /// `n_w`: intervals of a window beyond which neighbouring samples are taken in the mean, a
    /// count. Source: derived: the mean over a sixtieth of a window takes `(pi/60)^2/6`, less than
    /// a thousandth, from what goes to and fro within the window.
    pub most_intervals: f64,
    /// `(int b)^2 / int b^2` by the length of a window for `b = (1 - s^2)^3`, dimensionless: a bump
    /// weighs its window as if it were this share of it. Source: derived: `(32/35)^2 / (2 *
    /// 2048/3003)`.
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
