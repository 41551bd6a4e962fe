//! Constants of the search's objective, with symbol, meaning, unit and source; those that a user
//! may set are in the settings.
//!
//! `L/U` is the time in which the ship travels its own length. The paper is Miyauchi, Akimoto and
//! Maki (2024): a ship of 3 m at 0.4 m/s, so that its `L/U` is 7.5 s. A source that begins with
//! "chosen" has not been measured at half and at double the value; the reason given is a
//! mathematical one.

/// Constants by which trials are divided, compared and bounded.
#[derive(Debug, Clone, Copy)]
pub(super) struct ObjectiveThresholds {
    /// `n_h`: integration steps in `L/U`, a count. Source: the paper's 0.1 s.
    pub steps_a_length: f64,
    /// `t_f`: length of a subsequence by `L/U`, dimensionless. Source: the paper's 100 s, rounded
    /// down.
    pub segment: f64,
    /// The same at least, s. Source: the paper, section 4.
    pub least_segment_s: f64,
    /// The same in steps where no length of the ship is known, a count. Source: the paper's 100 s
    /// by its 0.1 s.
    pub fallback_steps: f64,
    /// Steps over which accelerations are means, a count. Source: the paper's moving average of one
    /// second (section 3.1.2).
    pub mean_steps: f64,
    /// `r_l`: standardised difference that is counted where a simulation has ended early. Source:
    /// chosen, more than the error of any state within the physical range; a longer simulation is
    /// then better, as by the paper's Eq. 25.
    pub lost: f64,
    /// `m`: distance of the extreme states beyond the range that the trials covered, as a share of
    /// that range, dimensionless. Source: chosen; the paper's own extremes are of its ship.
    pub beyond: f64,
    /// Most controls whose extremes are combined, a count. Source: chosen; combinations grow as
    /// three to that power.
    pub controls: usize,
    /// `Q`: percentile of the measured accelerations that is allowed, as a share, dimensionless.
    /// Source: the paper, Eq. 33.
    pub percentile: f64,
    /// `s_f`: spread of a search with held-out trials relative to that of the first search, at
    /// whose optimum it starts, dimensionless. Source: chosen; decision 14 gives it a tenth of the
    /// evaluations.
    pub fold_spread: f64,
}

/// The values.
pub(super) const OBJECTIVE: ObjectiveThresholds = ObjectiveThresholds {
    steps_a_length: 75.0,
    segment: 10.0,
    least_segment_s: 100.0,
    fallback_steps: 1000.0,
    mean_steps: 10.0,
    lost: 30.0,
    beyond: 0.2,
    controls: 4,
    percentile: 0.997,
    fold_spread: 0.1,
};
