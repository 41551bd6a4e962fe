//! Every constant of the residual, with its symbol, meaning, unit and source.
//!
//! `sigma` is the standard deviation of an instrument's noise. A source that begins with "chosen"
//! has no measurement of how results move at half and at double the value: the reason that can be
//! given is the one of the mathematics.

/// What the filter, its instruments and its linearisation assume.
#[derive(Debug, Clone, Copy)]
pub(super) struct ResidualThresholds {
    /// `k_0`: how far the first sample may be from the smooth path, by `sigma`, dimensionless.
    /// Source: derived: practically anywhere, so that the first reading decides (a diffuse start).
    pub start: f64,
    /// Root of the density by which a state that nobody reads drifts, SI units by the root of a
    /// second. Source: derived: as good as none, and above zero, so that a covariance has a root.
    pub unread_drift: f64,
    /// Variance of the start of a state that nobody reads, SI units squared. Source: derived, as
    /// [`Self::unread_drift`].
    pub unread_variance: f64,
    /// `d_0`: drift of an instrument of which nothing is known but its scatter, by `sigma` and the
    /// root of a second. Source: chosen; it keeps a filter from trusting arithmetic, and
    /// calibration learns it.
    pub drift: f64,
    /// `n_e`: samples of which one is read where readings were smoothed, a count. Source: chosen,
    /// as long as the parabola along which a model is linearised (five samples).
    pub sparse: usize,
    /// `k_e`: how many times more sparse readings must scatter for that than the next samples that
    /// are used, dimensionless. Source: chosen; of white noise it is 1. For models of before
    /// [`Self::smoothed`].
    pub grows: f64,
    /// `k_s`: how many times more sparse readings must scatter for that than neighbours as they
    /// were recorded, dimensionless. Source: white noise has 1, Esso Osaka's velocities 2.9 to 5.0
    /// across and 5.3 to 9.2 ahead, each trial by itself; their geometric middle
    /// (`docs/evidence/diagnosis_unseen.md`, "Random divisions", with half and double).
    pub smoothed: f64,
    /// `e_n`: least noise that is believed of an instrument, by the ship's length, speed or rate,
    /// or in rad: noise-free simulations are trials too, dimensionless. Source: chosen, far below
    /// any instrument's.
    pub floor: f64,
    /// `k_j`: by how many deviations of its own scatter a step must disagree with the velocities to
    /// be a jump, dimensionless. Source: chosen; no normal noise comes near it. The rule came of
    /// the Esso Osaka trials, whose positions jump by 0.1 to 0.7 m and headings by 1 to 7 deg
    /// (`docs/evidence/diagnosis.md`).
    pub jump: f64,
    /// `s_j`: share of what the fastest sample moves in a step below which no disagreement is a
    /// jump, dimensionless. Source: chosen: a position that is held between fixes is no jump (a
    /// test).
    pub least_jump: f64,
    /// `s_l`: share of a trial that may be lost to jumps, dimensionless; what jumps more often is
    /// recorded so. Source: chosen.
    pub most_lost: f64,
    /// `h_t`: by how much longer a lag is for its derivative, by the lag, dimensionless. Source:
    /// chosen; with [`Self::lag_step_s`] a secant that is long enough to move a sample.
    pub lag_share: f64,
    /// `h_0`: and by how much at least, s. Source: as [`Self::lag_share`].
    pub lag_step_s: f64,
    /// `h_b`: by how much half of a dead band is wider at least, in the unit of the input. Source:
    /// derived: a sixteenth of a degree, what a rudder's reading shows.
    pub band_step: f64,
    /// `n_b`: samples over which a record is taken in the mean before a play, a count. Source:
    /// derived: white noise falls to a third, and a rudder that is recorded as often as usual moves
    /// for longer.
    pub band_mean: usize,
    /// Least of what an instrument says more by a unit of a rate and of a parameter, in units of
    /// both. Source: derived: a delay's is 1, and what stands below is rounding.
    pub least_rate_response: f64,
}

/// The values.
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
