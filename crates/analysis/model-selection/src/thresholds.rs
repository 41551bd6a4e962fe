//! Constants of the search, with symbol, meaning, unit and source.

/// How entrants go on, and when trials are cut.
#[derive(Debug, Clone, Copy)]
pub(super) struct SearchThresholds {
    /// `1/eta`: of so many sources of a law one goes on, a count. Source: Jamieson and Talwalkar
    /// 2016 and its successors halve or take a third; `docs/evidence/plain.md`.
    pub share: usize,
    /// `g_t`: error in weak form by the least of it up to which trajectories are fitted,
    /// dimensionless. Source: `docs/evidence/plain.md`.
    pub trajectory_gain: f64,
    /// Most entrants of which trajectories are fitted, beside a population, a count. Source:
    /// `docs/evidence/plain.md`.
    pub trajectories: usize,
    /// Fewer trials are left out in parts, a count. Source: derived: of two, each is fitted by the
    /// other alone, and a scatter has one degree of freedom.
    pub few: usize,
    /// `lambda_k`: strengths of the prior that are tried in weak form, dimensionless. Source:
    /// derived: every second to fourth of those that a named method tries; the next rung tries
    /// their neighbours.
    pub strengths: [f64; 8],
    /// Strengths that trajectories begin with, by the best in weak form, dimensionless. Source:
    /// derived: half a decade to either side.
    pub near: [f64; 3],
    /// By how much stronger a prior is tried where the choice cannot be taken, dimensionless.
    /// Source: derived: half decades, as a named method tries them, over three decades.
    pub stronger: [f64; 6],
    /// By how much stronger roll's own prior is then, each time, dimensionless. Source:
    /// `docs/evidence/plain.md`, which has the root and the square of it.
    pub roll_stronger: f64,
    /// `lambda_h`: strength of a prior that keeps the source, dimensionless. Source: derived: what
    /// the trials say counts for less than the rounding of its coefficients.
    pub kept: f64,
    /// Most sources that enter, by rank of correlation, a count. Source: chosen; each costs a fit
    /// for every law, and correlation has ranked them.
    pub sources: usize,
    /// Most ships of a population, by rank of similarity, a count. Source: chosen, more than the
    /// zoo has; each is asked at every state.
    pub population: usize,
    /// `k_v`: weight of the variance where no trial reaches beside the error on trials left out,
    /// dimensionless. Source: `docs/evidence/plain.md`, which has half and double.
    pub elsewhere: f64,
    /// `T_r`: how often simulations of trials left out start anew, by `L/U`, dimensionless. Source:
    /// `docs/evidence/plain.md`, which has half and double; as long as trajectories are fitted.
    pub restart: f64,
    /// `T_p`: how long a part is where three trials or more are left out part by part, by `L/U`,
    /// dimensionless. Source: `docs/evidence/plain.md`, which has half and double.
    pub part: f64,
    /// `T_w`: window in which motions are smoothed that simulations are compared with, by `L/U`,
    /// dimensionless. Source: less than the 0.3 `L/U` in which sway and yaw settle;
    /// `docs/evidence/population.md` has half and double.
    pub smoothing: f64,
    /// `n_c`: samples of the trials on which the noise model is learned, a count. Source: memory;
    /// `docs/evidence/plain.md`.
    pub calibration: usize,
    /// `n_b`: fewest trials of which branches are tried, a count. Source:
    /// `docs/evidence/branches.md`, which has a third to two thirds of it, not its double.
    pub branch_trials: usize,
}

/// The values.
pub(super) const SEARCH: SearchThresholds = SearchThresholds {
    share: 3,
    trajectory_gain: 3.0,
    trajectories: 2,
    few: 3,
    strengths: [10.0, 1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8],
    near: [3.16, 1.0, 0.316],
    stronger: [3.16, 10.0, 31.6, 100.0, 316.0, 1000.0],
    roll_stronger: 10.0,
    kept: 1e9,
    sources: 5,
    population: 48,
    elsewhere: 5.0,
    restart: 5.0,
    part: 10.0,
    smoothing: 0.2,
    calibration: 30_000,
    branch_trials: 12,
};

/// What a model must sail before it is taken.
#[derive(Debug, Clone, Copy)]
pub(super) struct SailedThresholds {
    /// Records of rudders at random, a count. Source: chosen; simulated side by side they cost as
    /// much as one.
    pub records: usize,
    /// Angles of turns, to both sides, by the gear's limit, dimensionless. Source: between those of
    /// the standard manoeuvres; docs/evidence/plain.md.
    pub turns: [f64; 3],
    /// How long each of these lasts, by `L/U`, dimensionless. Source: chosen, five times as long as
    /// models of folds are compared; docs/evidence/plain.md.
    pub lengths: f64,
    /// Angles of zigzags, evenly to the gear's limit, a count. Source: derived: every five degrees
    /// of 35.
    pub zigzags: usize,
    /// Motions of the trials from which the rudder goes hard over and about at random, a count.
    /// Source: docs/evidence/plain.md.
    pub motions: usize,
    /// For how long, by `L/U`, dimensionless. Source: as long as models of folds are compared.
    pub motion_lengths: f64,
}

/// The values.
pub(super) const SAILED: SailedThresholds = SailedThresholds {
    records: 8,
    turns: [0.25, 0.5, 0.75],
    lengths: 50.0,
    zigzags: 7,
    motions: 24,
    motion_lengths: 10.0,
};
