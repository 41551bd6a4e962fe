//! Constants of the trajectory form, with symbol, meaning, unit and source.
//!
//! `L/U` is the time in which the ship travels its own length at the approach speed of its trials.
//! A source that begins with "chosen" has not been measured at half and at double the value; the
//! reason given is a mathematical one.

/// Constants by which trajectories are divided and fitted.
#[derive(Debug, Clone, Copy)]
pub(super) struct TrajectoryThresholds {
    /// `n_r`: residuals in `L/U`, a count. Source: chosen, every third step, or fifth where the
    /// ship rolls; neighbours have the same information.
    pub residuals_a_length: f64,
    /// `T_s`: length of a segment by `L/U`, dimensionless. Source: chosen, long enough to turn by a
    /// manoeuvre's angles and short enough for a wrong model to stay in range.
    pub segment: f64,
    /// `T_l`: the same for a law whose coefficients have typical values, dimensionless. Source:
    /// `docs/evidence/physical_law.md`: a bias shows in long segments alone, and a model near a
    /// typical ship stays in range.
    pub long_segment: f64,
    /// `n_s`: steps of a segment where no length of the ship is known, a count. Source: chosen, of
    /// the order of [`Self::segment`].
    pub fallback_steps: f64,
    /// `n_d`: steps from one residual to the next where no length is known, a count. Source:
    /// chosen, about `n_h/n_r`.
    pub fallback_stride: f64,
    /// `n_t`: a rest of a trial is kept as a segment if it has at least this number of residuals, a
    /// count. Source: chosen, a third of a segment of [`Self::segment`].
    pub least_residuals: f64,
    /// `mu_k`: pulls towards the weak form, strongest first, dimensionless; each starts at the
    /// result of the one before. Source: chosen, decades from the value that gives the weak form;
    /// errors on held-out trials end them (`is_past_best`).
    pub pulls: [f64; 6],
    /// `lambda_s`: largest strength of the source in trajectories, however much of it the weak form
    /// needs, dimensionless. Source: `docs/evidence/estimators.md`, "How the source holds
    /// trajectories": errors on held-out trials are 0.0275 on all files of the Esso Osaka and 0.435
    /// on Train-TZRB; on the ten calmer trials of the diagnosis, where the weak form takes a tenth,
    /// all of that as the share gives 0.51, the next pull diverges and wind is not always named,
    /// and with a hundredth it always is.
    pub source_share: f64,
    /// `lambda_p`: cost of a prior's deviation of a nonlinear parameter by that of a change of every
    /// acceleration by its own size, dimensionless. Source: derived, of the order of the square of
    /// that change: a deviation of an interaction factor changes accelerations by a tenth.
    pub parameter_share: f64,
    /// `lambda_t`: cost of a deviation over ships of a coefficient with a typical value, and of a
    /// parameter beside it, by that of a change of every state by its deviation, dimensionless.
    /// Source: `docs/evidence/physical_law.md`.
    pub typical_share: f64,
    /// `r_p`: ratio to the error of another pull from which on an error is clearly worse,
    /// dimensionless. Source: chosen, twice the share by which candidates count as different; ends
    /// the pulls early (Train-TZRB in 0.24 s in place of 0.56).
    pub clearly_worse: f64,
    /// `k_H`: Huber's threshold in robust standard deviations of a state's residuals,
    /// dimensionless. Source: derived: of normal residuals 99.7 % count in full, so that nothing is
    /// lost where there are no outliers.
    pub huber: f64,
    /// `n_m`: one in this number of blocks of segments is used for a median, a count. Source:
    /// chosen; the median's error grows by the root of it.
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
    /// Factor of the damping after a step that gains, dimensionless. Source: chosen, a decade.
    pub damping_falls: f64,
    /// Factor of the damping after a step that does not gain, dimensionless. Source: chosen; larger
    /// than the inverse of the other factor.
    pub damping_grows: f64,
    /// Least damping after such a step, dimensionless. Source: chosen; less would hardly shorten
    /// the step.
    pub damping_least: f64,
    /// Damping at which a descent has ended, dimensionless. Source: derived: a step of a millionth
    /// changes nothing.
    pub damping_most: f64,
    /// `d_f`: damping of the single step from the fit on all trials to one with held-out trials,
    /// dimensionless. Source: derived: so small that it is a Gauss-Newton step.
    pub fold_damping: f64,
    /// `r_l`: residual that is counted where a simulation has ended early, in standard deviations
    /// of its state. Source: chosen, more than the error of any state within the physical range.
    pub lost: f64,
    /// `e_d`: added to the diagonal of ones before equations are solved, dimensionless. Source:
    /// derived: far below any effect on the result, and far above rounding.
    pub ridge: f64,
}

/// The values.
pub(super) const TRAJECTORY: TrajectoryThresholds = TrajectoryThresholds {
    residuals_a_length: 6.0,
    segment: 5.0,
    long_segment: 30.0,
    fallback_steps: 120.0,
    fallback_stride: 4.0,
    least_residuals: 10.0,
    pulls: [10.0, 1.0, 0.1, 0.01, 1e-3, 1e-4],
    source_share: 0.01,
    parameter_share: 0.01,
    typical_share: 0.03,
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
