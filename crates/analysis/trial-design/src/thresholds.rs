//! Constants by which a design decides, each with its symbol, meaning, unit and source. `L/U` is
//! the time in which the ship covers its length at the approach speed.

/// Constants of a trial design.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlanThresholds {
    /// `T_0`: steady approach that is recorded before the rudder is executed, by `L/U`,
    /// dimensionless. Source: as the diagnosis' next trial, two lengths of straight course.
    pub run_in: f64,
    /// `a_0`: change of heading at which a turning circle ends, deg. Source: ITTC 7.5-04-02-01,
    /// turning tests: one and a half circles.
    pub turned_deg: f64,
    /// `T_max`: longest turning circle, by `L/U`, dimensionless. Source: derived: one and a half
    /// circles of ten lengths' diameter at half the speed take some 90.
    pub longest: f64,
    /// `e_U`: share of the approach speed within which a ship is steady again, dimensionless.
    /// Source: chosen; 2 % of the speed change a tactical diameter by less, for it hardly depends
    /// on the speed.
    pub steady_speed: f64,
    /// `e_r`: yaw rate below which it is steady, by `U/L`, dimensionless. Source: chosen, a
    /// twentieth of that of a hard turn, whose diameter of some 4 lengths means 0.5.
    pub steady_rate: f64,
    /// `T_s`: longest time of recovering, by `L/U`, dimensionless. Source: chosen; a ship that is
    /// not steady after a hundred lengths begins the next trial as it is.
    pub recovery: f64,
    /// `delta_h`: largest rudder that holds the course, deg. Source: chosen, as a helmsman uses to
    /// steady a ship.
    pub helm_deg: f64,
    /// `K_h`, `T_h`: rudder by error of heading, and by yaw rate times `L/U`, dimensionless.
    /// Source: chosen; rudder equal to the error, with rate as strong as keeps it from swinging.
    pub helm: [f64; 2],
    /// `U_k/U`: approach speeds, dimensionless. Source: those of the diagnosis' next trial.
    pub speeds: [f64; 2],
    /// `psi_k`: headings with an external influence, deg. Source: those of the diagnosis' next
    /// trial.
    pub headings_deg: [f64; 3],
    /// `T_i`: interval of recording, by `L/U`, dimensionless. Source: the diagnosis' shortest
    /// interval.
    pub interval: f64,
    /// `s`: relative error of coefficients of a model without a posterior, by their value,
    /// dimensionless. Source: measured derivatives scatter about regressions by 15 to 25 % (Clarke
    /// 1983).
    pub unknown_share: f64,
    /// `q`: accelerations that no coefficient of such a model explains, by the typical ones,
    /// dimensionless. Source: `docs/evidence/plan.md`: manoeuvres of another law leave 0.5 % in
    /// surge, 1.0 % in sway and 2.5 % in yaw.
    pub discrepancy_level: f64,
    /// `e_v`: scatter of a figure by its value below which it is known, dimensionless. Source: as
    /// `bands`: below it is rounding.
    pub least_scatter: f64,
    /// `e_s`: least gain of the mean logarithm by an exchange, dimensionless. Source: chosen: a
    /// hundredth of a percent of a band.
    pub least_gain: f64,
    /// `n_t`: most trials of a design, a count. Source: chosen; a day of trials has some twenty.
    pub most_trials: usize,
    /// `B_max`: the longest budget, s. Source: derived: a day.
    pub longest_budget_s: f64,
    /// `n_x`: rounds of exchanges, a count. Source: chosen; after each, every candidate is the best
    /// in its place given the others, and the second round changes little.
    pub rounds: usize,
}

/// Values in use.
pub(crate) const THRESHOLDS: PlanThresholds = PlanThresholds {
    run_in: 2.0,
    turned_deg: 540.0,
    longest: 90.0,
    steady_speed: 0.02,
    steady_rate: 0.025,
    recovery: 100.0,
    helm_deg: 20.0,
    helm: [1.0, 2.0],
    speeds: [1.0, 0.6],
    headings_deg: [0.0, 90.0, 180.0],
    interval: 0.02,
    unknown_share: 0.2,
    discrepancy_level: 0.01,
    least_scatter: 1e-9,
    least_gain: 1e-4,
    most_trials: 40,
    longest_budget_s: 86_400.0,
    rounds: 4,
};
