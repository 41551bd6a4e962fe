//! Constants of the search, with symbol, meaning, unit and source.

/// Constants by which candidates pass the stages, and trials are divided.
#[derive(Debug, Clone, Copy)]
pub(super) struct SearchThresholds {
    /// `1/eta`: number of sources of a law of which one goes on, a count. Source: Jamieson and
    /// Talwalkar 2016 and its successors halve or take a third; `docs/evidence/plain.md`.
    pub share: usize,
    /// `g_t`: ratio to the least error in weak form up to which trajectories are fitted,
    /// dimensionless. Source: `docs/evidence/plain.md`.
    pub trajectory_gain: f64,
    /// Largest number of candidates of which trajectories are fitted, besides a population, a
    /// count. Source: `docs/evidence/plain.md`.
    pub trajectories: usize,
    /// Number of trials below which they are held out in parts, a count. Source: derived: of two,
    /// each is fitted by the other alone, and a scatter has one degree of freedom.
    pub few: usize,
    /// `lambda_k`: strengths of the prior that are tried in weak form, dimensionless. Source:
    /// derived: every second to fourth of those that a named method tries; the next stage tries
    /// their neighbours.
    pub strengths: [f64; 8],
    /// Strengths from which trajectories start, relative to the best in weak form, dimensionless.
    /// Source: derived: half a decade to either side.
    pub near: [f64; 3],
    /// Factors of a stronger prior that is tried if the chosen candidate is refused, dimensionless.
    /// Source: derived: half decades, as a named method tries them, over three decades.
    pub stronger: [f64; 6],
    /// Factor of roll's own prior at each such refusal, dimensionless. Source:
    /// `docs/evidence/plain.md`, which has the root and the square of it.
    pub roll_stronger: f64,
    /// `g_p`: ratio of errors up to which a model that stops and goes astern replaces one that does
    /// not, dimensionless. Source: derived: one standard error of the mean squared error of four
    /// manoeuvres, `1 + 1/sqrt(4)` for a squared error that scatters as much as its mean.
    pub propulsion: f64,
    /// `lambda_h`: strength of a prior that keeps the source, dimensionless. Source: derived: the
    /// effect of the trials is smaller than the rounding of its coefficients.
    pub kept: f64,
    /// Largest number of sources, by rank of correlation, a count. Source: chosen; each costs a fit
    /// for every law, and correlation has ranked them.
    pub sources: usize,
    /// Largest number of ships of a population, by rank of similarity, a count. Source: chosen,
    /// more than the zoo has; each is evaluated at every state.
    pub population: usize,
    /// Ratio by which the error plus the variance elsewhere of a model of few physical parameters is
    /// less than that of the selected one where it replaces it, dimensionless. Source:
    /// `docs/evidence/physical_law.md`, which has half and double.
    pub surer: f64,
    /// `k_v`: weight of the variance where no trial reaches, relative to the error on held-out
    /// trials, dimensionless. Source: `docs/evidence/plain.md`, which has half and double.
    pub elsewhere: f64,
    /// Ratio to the least error up to which a model whose folds complete random rudder orders
    /// replaces those whose do not, dimensionless. Source: `docs/evidence/physical_law.md`; as
    /// [`Self::trajectory_gain`].
    pub unsafe_ratio: f64,
    /// `T_r`: restart interval of simulations of held-out trials, in units of `L/U`, dimensionless.
    /// Source: `docs/evidence/plain.md`, which has half and double; the length of the segments of
    /// trajectories.
    pub restart: f64,
    /// `T_p`: length of a part where three trials or more are held out part by part, in units of
    /// `L/U`, dimensionless. Source: `docs/evidence/plain.md`, which has half and double.
    pub part: f64,
    /// `T_w`: window over which the motions are smoothed with which simulations are compared, in
    /// units of `L/U`, dimensionless. Source: less than the 0.3 `L/U` in which sway and yaw settle;
    /// `docs/evidence/population.md` has half and double.
    pub smoothing: f64,
    /// `n_c`: samples of the trials on which the noise model is learned, a count. Source: memory;
    /// `docs/evidence/plain.md`.
    pub calibration: usize,
    /// `n_b`: fewest trials for which learned corrections are tried, a count. Source:
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
    propulsion: 1.5,
    kept: 1e9,
    sources: 5,
    population: 48,
    surer: 2.0,
    elsewhere: 5.0,
    unsafe_ratio: 3.0,
    restart: 5.0,
    part: 10.0,
    smoothing: 0.2,
    calibration: 30_000,
    branch_trials: 12,
};

/// Constants of the simulations that a model must complete before it is chosen.
#[derive(Debug, Clone, Copy)]
pub(super) struct SimulationCheckThresholds {
    /// Records of random rudder orders, a count. Source: chosen; simulated in lockstep they cost as
    /// much as one.
    pub records: usize,
    /// Angles of turns, to both sides, as shares of the gear's limit, dimensionless. Source:
    /// between those of the standard manoeuvres; docs/evidence/plain.md.
    pub turns: [f64; 4],
    /// Duration of each of these, in units of `L/U`, dimensionless. Source: chosen, five times as
    /// long as models of folds are compared; docs/evidence/plain.md.
    pub lengths: f64,
    /// Angles of zigzags, evenly to the gear's limit, a count. Source: derived: every five degrees
    /// of 35.
    pub zigzags: usize,
    /// Motions of the trials from which the rudder goes hard over and moves at random, a count.
    /// Source: docs/evidence/plain.md.
    pub motions: usize,
    /// Duration of these, in units of `L/U`, dimensionless. Source: as long as models of folds are
    /// compared.
    pub motion_lengths: f64,
}

/// The values.
pub(super) const SIMULATION_CHECK: SimulationCheckThresholds = SimulationCheckThresholds {
    records: 8,
    turns: [0.25, 0.5, 0.75, 1.0],
    lengths: 50.0,
    zigzags: 7,
    motions: 24,
    motion_lengths: 10.0,
};
