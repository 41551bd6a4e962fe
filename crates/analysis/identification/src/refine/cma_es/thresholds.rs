//! Every constant of the search's objective, with symbol, meaning, unit and source; what a user may
//! set is in the settings.
//!
//! `L/U` is the time in which the ship sails its length. The paper is Miyauchi, Akimoto and Maki
//! (2024): a ship of 3 m at 0.4 m/s, so that its `L/U` is 7.5 s. A source that begins with "chosen"
//! has no measurement of how results move at half and at double the value: the reason that can be
//! given is the one of the mathematics.

/// How trials are cut, compared and bounded.
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
    /// `r_l`: what a standardised difference counts that a simulation never came to. Source:
    /// chosen, more than any state within the physical range is off; who goes on longer is then
    /// better, as by the paper's Eq. 25.
    pub lost: f64,
    /// `m`: by how much of the range that the trials covered the extremes of the states are beyond
    /// it, dimensionless. Source: chosen; the paper's own extremes are of its ship.
    pub beyond: f64,
    /// Most controls whose extremes are combined, a count. Source: chosen; combinations grow as
    /// three to that power.
    pub controls: usize,
    /// `Q`: the share of measured accelerations that may be, dimensionless. Source: the paper, Eq.
    /// 33.
    pub percentile: f64,
    /// `s_f`: spread of a search with trials left out by that of the first, at whose optimum it
    /// starts, dimensionless. Source: chosen; decision 14 gives it a tenth of the evaluations.
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
