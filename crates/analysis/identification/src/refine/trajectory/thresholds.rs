//! Every constant of the trajectory form, with symbol, meaning, unit and source.
//!
//! `L/U` is the time in which the ship sails its length at the approach speed of its trials. A
//! source that begins with "chosen" has no measurement of how results move at half and at double
//! the value: the reason that can be given is the one of the mathematics.

/// How trajectories are cut, fitted and held.
#[derive(Debug, Clone, Copy)]
pub(super) struct TrajectoryThresholds {
    /// `n_r`: residuals in `L/U`, a count. Source: chosen, every fourth step; neighbours say the
    /// same.
    pub residuals_a_length: f64,
    /// The same where no more is computed than needed, a count. Source: chosen, every third step,
    /// or fifth where the ship rolls.
    pub residuals_a_length_economical: f64,
    /// `T_s`: length of a segment by `L/U`, dimensionless. Source: chosen, long enough to turn by a
    /// manoeuvre's angles and short enough for a wrong model to stay in range.
    pub segment: f64,
    /// `n_s`: steps of a segment where no length of the ship is known, a count. Source: chosen, of
    /// the order of [`Self::segment`].
    pub fallback_steps: f64,
    /// `n_d`: steps from one residual to the next where no length is known, a count. Source:
    /// derived: `n_h/n_r`.
    pub fallback_stride: f64,
    /// `s_t`: a rest of at least one such part of a segment is kept, a count. Source: chosen.
    pub least_part: f64,
    /// `mu_k`: pulls towards the weak form, strongest first, dimensionless; each starts where the
    /// one before has ended. Source: chosen, decades from where the weak form is given; errors on
    /// trials left out end them (`is_past_best`).
    pub pulls: [f64; 6],
    /// `lambda_s`: how strongly the source holds trajectories at most, however much of it the weak
    /// form needs, dimensionless. Source: `docs/evidence/estimators.md`, "How the source holds
    /// trajectories": errors left out are 0.0275 on all files of the Esso Osaka and 0.435 on
    /// Train-TZRB; on the ten calmer trials of the diagnosis, where the weak form takes a tenth,
    /// all of that as the share gives 0.51, the next pull diverges and wind is not always named,
    /// and with a hundredth it always is.
    pub source_share: f64,
    /// `r_p`: error by that of another pull from which on it is clearly worse, dimensionless.
    /// Source: chosen, twice the share by which candidates count as different; ends the pulls early
    /// (Train-TZRB in 0.24 s in place of 0.56).
    pub clearly_worse: f64,
    /// `k_H`: Huber's threshold in robust standard deviations of a state's residuals,
    /// dimensionless. Source: derived: of normal residuals 99.7 % count in full, so that nothing is
    /// lost where there are no outliers.
    pub huber: f64,
    /// `n_m`: a median is taken of every so many blocks of segments, a count. Source: chosen; its
    /// error grows by the root of that.
    pub median_stride: usize,
    /// `n_i`: most steps of a descent, a count. Source: chosen; [`Self::least_gain`] ends it
    /// earlier.
    pub steps: usize,
    /// `e_g`: share of the cost below which a step gains nothing, dimensionless. Source: chosen, a
    /// fifth of the share by which candidates count as different.
    pub least_gain: f64,
    /// `d_0`: damping of the first step by each curvature, dimensionless. Source: chosen; near the
    /// weak form equations are nearly linear.
    pub damping: f64,
    /// What damping is multiplied by after a step that gains, dimensionless. Source: chosen, a
    /// decade.
    pub damping_falls: f64,
    /// What it is multiplied by after one that does not, dimensionless. Source: chosen; more than
    /// one step that gains takes back.
    pub damping_grows: f64,
    /// What it is then at least, dimensionless. Source: chosen; less would hardly shorten the step.
    pub damping_least: f64,
    /// From where on a descent has ended, dimensionless. Source: derived: a step of a millionth
    /// changes nothing.
    pub damping_most: f64,
    /// `d_f`: damping of the one step from the fit on all trials to one with trials left out,
    /// dimensionless. Source: derived: as good as none, so that it is a Gauss-Newton step.
    pub fold_damping: f64,
    /// `r_l`: what a residual counts that a simulation never came to, in standard deviations of its
    /// state. Source: chosen, more than any state within the physical range is off.
    pub lost: f64,
    /// `e_d`: added to the diagonal of ones before equations are solved, dimensionless. Source:
    /// derived: far below what matters, and far above rounding.
    pub ridge: f64,
}

/// The values.
pub(super) const TRAJECTORY: TrajectoryThresholds = TrajectoryThresholds {
    residuals_a_length: 7.5,
    residuals_a_length_economical: 6.0,
    segment: 5.0,
    fallback_steps: 120.0,
    fallback_stride: 4.0,
    least_part: 3.0,
    pulls: [10.0, 1.0, 0.1, 0.01, 1e-3, 1e-4],
    source_share: 0.01,
    clearly_worse: 1.02,
    huber: 3.0,
    median_stride: 4,
    steps: 12,
    least_gain: 2e-3,
    damping: 1e-3,
    damping_falls: 0.1,
    damping_grows: 30.0,
    damping_least: 1e-2,
    damping_most: 1e6,
    fold_damping: 1e-6,
    lost: 10.0,
    ridge: 1e-12,
};
