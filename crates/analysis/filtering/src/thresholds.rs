//! Constants of the filter, each with its symbol, meaning, unit and source.
//!
//! `sigma` is the standard deviation of an instrument's noise. A source that begins with "chosen"
//! has no measurement of the results at half and at double the value: only the mathematical reason
//! is given.

/// Assumptions of the filter, its instruments and its linearisation.
#[derive(Debug, Clone, Copy)]
pub(super) struct ResidualThresholds {
    /// `k_0`: standard deviation of the first sample about the smooth path, by `sigma`,
    /// dimensionless. Source: derived: so large that the first reading decides (a diffuse start).
    pub start: f64,
    /// Root of the density by which a state without an instrument drifts, SI units by the root of a
    /// second. Source: derived: negligible, and above zero, so that a covariance has a root.
    pub unread_drift: f64,
    /// Initial variance of a state without an instrument, SI units squared. Source: derived, as
    /// [`Self::unread_drift`].
    pub unread_variance: f64,
    /// `d_0`: drift of an instrument of which only the noise is known, by `sigma` and the root of a
    /// second. Source: chosen; it limits the trust of a filter in noise-free readings, and
    /// calibration learns it.
    pub drift: f64,
    /// `n_e`: samples per reading where readings were smoothed, a count. Source: chosen, as long as
    /// the parabola along which a model is linearised (five samples).
    pub sparse: usize,
    /// `k_e`: least ratio of the noise of sparse readings to that of adjacent used samples at which
    /// readings count as smoothed, dimensionless. Source: chosen; of white noise it is 1. Used for
    /// models without [`Self::smoothed`].
    pub grows: f64,
    /// `k_s`: least ratio of the noise of sparse readings to that of adjacent recorded samples at
    /// which readings count as smoothed, dimensionless. Source: white noise has 1, Esso Osaka's
    /// velocities 2.9 to 5.0 across and 5.3 to 9.2 ahead, each trial by itself; their geometric
    /// middle (`docs/evidence/diagnosis_unseen.md`, "Random divisions", with half and double).
    pub smoothed: f64,
    /// `e_n`: least noise of an instrument, by the ship's length, speed or rate, or in rad:
    /// noise-free simulations are trials too, dimensionless. Source: chosen, far below any
    /// instrument's.
    pub floor: f64,
    /// `k_j`: disagreement of a step with the velocities from which it is a jump, in standard
    /// deviations of these disagreements, dimensionless. Source: chosen; no normal noise comes near
    /// it. The rule was derived from the Esso Osaka trials, whose positions jump by 0.1 to 0.7 m
    /// and headings by 1 to 7 deg (`docs/evidence/diagnosis.md`).
    pub jump: f64,
    /// `s_j`: share of the fastest movement within a step below which no disagreement is a jump,
    /// dimensionless. Source: chosen: a position that is held between fixes is no jump (a test).
    pub least_jump: f64,
    /// `s_l`: largest share of a trial that may be lost to jumps, dimensionless; a trial with more
    /// is used whole. Source: chosen.
    pub most_lost: f64,
    /// `h_t`: increment of a lag for its derivative, by the lag, dimensionless. Source: chosen;
    /// with [`Self::lag_step_s`] a secant that is long enough to move a sample.
    pub lag_share: f64,
    /// `h_0`: least increment of a lag, s. Source: as [`Self::lag_share`].
    pub lag_step_s: f64,
    /// `h_b`: least increment of half of a dead band, in the unit of the input. Source: derived: a
    /// sixteenth of a degree, the resolution of a rudder's reading.
    pub band_step: f64,
    /// `n_b`: samples of the running mean of a record before a play, a count. Source: derived:
    /// white noise falls to a third, and a rudder that is recorded as often as usual moves for
    /// longer.
    pub band_mean: usize,
    /// Least change of a reading by a unit of a rate and of a parameter, in units of both. Source:
    /// derived: a delay's is 1, and smaller values are rounding.
    pub least_rate_response: f64,
}

/// Values in use.
pub(super) const RESIDUAL: ResidualThresholds = ResidualThresholds {
    start: 1e3,
    unread_drift: 1e-9,
    unread_variance: 1e-12,
    drift: 1e-3,
    sparse: 5,
    grows: 4.0,
    smoothed: 2.0,
    floor: 1e-5,
    jump: 15.0,
    least_jump: 0.5,
    most_lost: 0.3,
    lag_share: 0.05,
    lag_step_s: 0.01,
    band_step: 1e-3,
    band_mean: 9,
    least_rate_response: 1e-9,
};
