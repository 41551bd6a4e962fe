//! Constants by which estimators are compared, with symbol, meaning, unit and source; each
//! estimator has its own in its module.
//!
//! `L/U` is the time in which the ship travels its own length at the approach speed of its trials.
//! A source that begins with "chosen" has not been measured at half and at double the value; the
//! reason given is a mathematical one.

/// Constants by which candidates are compared and chosen.
#[derive(Debug, Clone, Copy)]
pub(super) struct SelectionThresholds {
    /// `r_e`: ratio to the error of an earlier candidate below which a later one is better,
    /// dimensionless. Source: chosen; a difference of less than one per cent is statistically tied.
    pub better: f64,
    /// `k_se`: standard errors of the difference over the trials by which a candidate with more
    /// coefficients must win, dimensionless. Source: decision 6, after the rule of one standard
    /// error (Breiman et al. 1984, section 3.4.3); it was settled while the errors of Paper V were
    /// in sight (`docs/evidence/estimators.md`).
    pub standard_errors: f64,
    /// `lambda_f`: strength of a prior that changes nothing, at which the noise of rows is measured,
    /// dimensionless. Source: derived: far below any share of noise in measured rows.
    pub free_strength: f64,
    /// `lambda_h`: strength at which a source is kept as it is, dimensionless. Source: derived: the
    /// effect of the trials is smaller than the rounding of its coefficients.
    pub held: f64,
    /// `s_l`: share of the strongest prior from which on it counts as reached, dimensionless.
    /// Source: derived: 1 less the rounding of a strength that was spaced in its logarithm.
    pub strongest_share: f64,
    /// `e_c`: ratio to the largest eigenvalue below which regressors cannot be distinguished,
    /// dimensionless. Source: chosen; their coefficients then have a thousand times the standard
    /// error of the best one.
    pub collinear: f64,
    /// `n_c`: samples for each coefficient of an axis where rows are differences, dimensionless;
    /// windows count once. Source: chosen; neighbouring differences share most of their
    /// information.
    pub samples_a_coefficient: f64,
    /// `lambda_k`: strengths of the weak form from which trajectories start where effects are
    /// fitted with the coefficients, dimensionless. Source: chosen, half decades from 10 down to
    /// where trials alone decide.
    pub alternatives: [f64; 6],
    /// `T_r`: restart interval of simulations of held-out trials, in units of `L/U`, dimensionless.
    /// Source: decision 2.
    pub restart: f64,
    /// `g_s`: ratio to the least error at the shortest restart interval up to which longer
    /// simulations are made, dimensionless. Source: chosen: a ratio that trials distinguish; errors
    /// on held-out trials have standard errors of a tenth to a third of them.
    pub near_least: f64,
    /// `r_lambda`: ratio of the strengths with which asymmetric terms are tried to the best
    /// strength of other terms, to both sides, dimensionless. Source: chosen: a decade, the next
    /// strengths of those that the default search tries.
    pub near_strength: f64,
    /// `n_h`: steps of the classical Runge-Kutta method in `L/U`, and samples that a simulation
    /// needs, where the ship does not roll, a count. Source: derived: sway and yaw settle in some
    /// 0.3 `L/U`, of which a step is a fifth; the error of such a step, `(h/T)^5/120`, is 2e-6 of a
    /// motion. `docs/evidence/plain.md` has half and double.
    pub steps_a_length: f64,
    /// The same where the ship rolls, a count. Source: derived: natural periods of roll are from
    /// half of `L/U` on, and a step is then a fifteenth of one.
    pub steps_a_length_with_roll: f64,
    /// `[lambda_0, lambda_1]`: range of roll's own strength, dimensionless. Source: chosen, from
    /// nothing to the common strength at which a source counts as much as all samples; the marginal
    /// likelihood decides within.
    pub roll_strengths: [f64; 2],
    /// Strengths tried in it, a count. Source: chosen, five a decade.
    pub roll_strength_count: usize,
}

/// The values.
pub(super) const SELECTION: SelectionThresholds = SelectionThresholds {
    better: 0.99,
    standard_errors: 2.0,
    free_strength: 1e-10,
    held: 1e9,
    strongest_share: 0.999,
    collinear: 1e-6,
    samples_a_coefficient: 4.0,
    alternatives: [10.0, 1.0, 0.3, 0.1, 0.03, 0.01],
    restart: 10.0,
    near_least: 1.5,
    near_strength: 10.0,
    steps_a_length: 18.0,
    steps_a_length_with_roll: 30.0,
    roll_strengths: [1e-9, 1.0],
    roll_strength_count: 50,
};

/// Position of the mean of least variance between the source (0) and the estimate from particulars.
pub(super) const LEARNED_POSITION: f64 = 0.5;
/// Position of the estimate from particulars.
pub(super) const ESTIMATE_POSITION: f64 = 1.0;

/// Covariance of the errors of a source and an estimate in a ship's acceleration, relative to the
/// mean square of that acceleration over its standard manoeuvres, dimensionless.
#[derive(Debug, Clone, Copy)]
pub(super) struct ErrorCovariance {
    /// Mean square of the source's error.
    pub source: f64,
    /// Mean square of the estimate's error.
    pub estimate: f64,
    /// Mean product of both errors.
    pub common: f64,
}

/// Constants by which the parts of a mixture are weighted.
#[derive(Debug, Clone, Copy)]
pub(super) struct MixtureThresholds {
    /// `C_a`: covariance of both errors by axis, in the order of `Axis`; none for roll, on which an
    /// estimate gives no information. Source: medians over the zoo's ships for work, each left out
    /// (`cargo run -p sistership-tests --example strangers -- misfit`, docs/evidence/strangers.md).
    pub misfit: [Option<ErrorCovariance>; 4],
}

/// The values.
pub(super) const MIXTURE: MixtureThresholds = MixtureThresholds {
    misfit: [
        Some(ErrorCovariance { source: 6.744, estimate: 0.707, common: -0.162 }),
        Some(ErrorCovariance { source: 3.139, estimate: 2.339, common: 0.798 }),
        None,
        Some(ErrorCovariance { source: 7.824, estimate: 4.620, common: 3.040 }),
    ],
};

/// Constants by which ships become a prior.
#[derive(Debug, Clone, Copy)]
pub(super) struct PopulationThresholds {
    /// `e`: share of the prior's variance in directions in which the ships do not differ,
    /// dimensionless. Source: `docs/evidence/population.md`, which has a tenth and three times it.
    pub outside: f64,
    /// Fewest ships, a count. Source: chosen: a scatter of fewer has little information.
    pub least: usize,
    /// Rounds of the iteration for a robust mean, a count. Source: chosen; it has converged by
    /// then.
    pub rounds: usize,
}

/// The values.
pub(super) const POPULATION: PopulationThresholds =
    PopulationThresholds { outside: 0.1, least: 5, rounds: 10 };

/// Constants of the evaluation of a source, and of the weight of its accelerations.
#[derive(Debug, Clone, Copy)]
pub(super) struct SourceThresholds {
    /// `n_s`: largest number of samples of a trial or manoeuvre, a count. Source: chosen;
    /// neighbours have the same information.
    pub samples: usize,
    /// `s_U`: share of the approach speed below which a law that is expanded about it does not
    /// hold, dimensionless. Source: decision 15 ("those below 0.3 of it"); chosen.
    pub least_speed: f64,
    /// `e_r`: ratio to the largest regressor below which one is rounding error, dimensionless.
    /// Source: derived: some hundred times the spacing of doubles.
    pub rounding: f64,
    /// `n_f`: largest number of folds of groups, a count. Source: chosen, as many as the default
    /// folds.
    pub folds: usize,
    /// `c_D`: strength of the prior on a coefficient on which the source has no information,
    /// relative to one that it determines, dimensionless. Source: the Esso Osaka trials, few fitted
    /// and the others simulated (`cargo test --release -p sistership-tests --test accuracy
    /// another_law -- --nocapture`): with 0.3 and 0.03 errors are alike, and more files leave the
    /// physical range (`docs/evidence/across_laws.md`).
    pub ignorance: f64,
    /// `lambda_z`: strengths of the ridge about zero that are tried, dimensionless. Source: chosen,
    /// decades; held-out groups decide among them.
    pub ridges: [f64; 8],
}

/// The values.
pub(super) const SOURCE: SourceThresholds = SourceThresholds {
    samples: 400,
    least_speed: 0.3,
    rounding: 1e-13,
    folds: 8,
    ignorance: 0.1,
    ridges: [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8],
};

/// Speeds and revolutions, by those of the approach, at which sources are asked and models are
/// checked, dimensionless. Trials at one speed do not tell a force in its square from
/// one in another power. Source: one half is between half and slow ahead, at which harbours are
/// entered; without it and with it in docs/evidence/foreign_ships.md.
pub(super) const SPEED_SCALES: [f64; 2] = [1.0, 0.5];

/// Constants of the rudder orders that no trial had, under which the models of folds are compared.
#[derive(Debug, Clone, Copy)]
pub(super) struct HelmThresholds {
    /// Records, a count. Source: chosen; half and double are not measured yet.
    pub records: usize,
    /// `T_h`: duration of each record, in units of `L/U`, dimensionless. Source:
    /// [`SelectionThresholds::restart`]; half and double are not measured yet.
    pub lengths: f64,
    /// Samples in `L/U`, a count. Source: chosen; states are compared there, while the steps are
    /// those of every simulation.
    pub samples_a_length: f64,
    /// Shortest and longest time for which an order is held, by `L/U`, dimensionless. Source:
    /// chosen: a zigzag holds its rudder for two to three, and a turn is steady after five.
    pub held: [f64; 2],
}

/// The values.
pub(super) const HELM: HelmThresholds =
    HelmThresholds { records: 4, lengths: 10.0, samples_a_length: 10.0, held: [1.0, 5.0] };

/// Constants of the manoeuvres in which a fitted model must stay within the physical range.
#[derive(Debug, Clone, Copy)]
pub(super) struct RangeCheckThresholds {
    /// Step of the angles of turns up to the gear's limit, deg. Source: derived: a fourth of the least
    /// angle of the standard manoeuvres.
    pub turn_step_deg: f64,
    /// Turns by zigzags, a count. Source: derived: zigzags at the angles of the standard ones, and
    /// at 30 degrees.
    pub every: usize,
    /// Step, by `L/U`, dimensionless. Source: as of steady motions in `simulation::manoeuvre`.
    pub step: f64,
}

/// The values.
pub(super) const RANGE_CHECK: RangeCheckThresholds =
    RangeCheckThresholds { turn_step_deg: 2.5, every: 4, step: 0.05 };
