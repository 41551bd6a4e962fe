//! Thresholds of trials: how they are read and shown, and which is proposed.

use sistership_model::trial::Channel;

/// How trials are read and replayed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TrialThresholds {
    /// `T_s`: shortest interval between samples that are used, by `L/U`, dimensionless. Source:
    /// chosen; a ship moves by a fiftieth of its length, so that a shorter step changes the
    /// linearisation by less than noise.
    pub least_step: f64,
    /// `T_j`: how long before and after a jump readings are not used, by `L/U`, dimensionless: what
    /// was smoothed carries the jump on. Source: chosen; the rule came of the Esso Osaka trials
    /// (`docs/evidence/diagnosis.md`, "Positions and headings jump").
    pub settles: f64,
    /// `T_r`: how often simulations that judge start anew, by `L/U`, dimensionless. Source:
    /// decision 2 (`restart_s`).
    pub restart: f64,
}

/// The trials' values.
pub(super) const TRIALS: TrialThresholds =
    TrialThresholds { least_step: 0.02, settles: 0.2, restart: 10.0 };

/// Rudder and switching angle of a manoeuvre, deg; none of a turn.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlannedHelm {
    /// What it is called.
    pub name: &'static str,
    /// Rudder angle, deg.
    pub rudder_deg: f64,
    /// Heading at which the rudder is switched, deg.
    pub switch_deg: Option<f64>,
}

/// The trial that is proposed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NextTrialThresholds {
    /// What can be sailed. Source: the standard manoeuvres of IMO MSC.137(76), and a turning circle
    /// at 15 deg, which is gentler.
    pub manoeuvres: [PlannedHelm; 4],
    /// `U_k/U`: approach speeds by that of the trials, dimensionless. Source: chosen, full and
    /// reduced speed.
    pub speeds: [f64; 2],
    /// `psi_k`: headings of the approach, deg. Source: chosen; what comes from outside turns with
    /// the heading, and quarter turns are furthest apart.
    pub headings_deg: [f64; 3],
    /// `T`: duration by `L/U`, dimensionless. Source: chosen; a turning circle of a diameter of 5
    /// to 8 lengths is 16 to 25 lengths long.
    pub duration: f64,
    /// `T_0`: run-in by `L/U`, dimensionless. Source: chosen, two lengths of straight course.
    pub run_in: f64,
}

/// The next trial's values.
pub(super) const NEXT_TRIAL: NextTrialThresholds = NextTrialThresholds {
    manoeuvres: [
        PlannedHelm { name: "zigzag 10/10", rudder_deg: 10.0, switch_deg: Some(10.0) },
        PlannedHelm { name: "zigzag 20/20", rudder_deg: 20.0, switch_deg: Some(20.0) },
        PlannedHelm { name: "turning circle 15", rudder_deg: 15.0, switch_deg: None },
        PlannedHelm { name: "turning circle 35", rudder_deg: 35.0, switch_deg: None },
    ],
    speeds: [1.0, 0.6],
    headings_deg: [0.0, 90.0, 180.0],
    duration: 25.0,
    run_in: 2.0,
};

/// Series for plots; nothing is decided by them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SeriesThresholds {
    /// `n_t`: points of a series at most, a count. Source: chosen, about what a plot of a report
    /// can resolve.
    pub points: usize,
    /// `n_q`: classes of a variable when it is asked how much of a residual it explains, a count.
    /// Source: chosen, 30 deg each of a heading.
    pub classes: usize,
    /// `z_b`: half width of the band by the smoother's standard deviation, dimensionless. Source:
    /// derived: 95 % of a normal distribution.
    pub band: f64,
    /// The variables that are asked. Source: chosen, the recorded channels that a residual may
    /// follow.
    pub variables: [Channel; 8],
}

/// The series' values.
pub(super) const SERIES: SeriesThresholds = SeriesThresholds {
    points: 240,
    classes: 12,
    band: 2.0,
    variables: [
        Channel::Psi,
        Channel::Delta,
        Channel::U,
        Channel::V,
        Channel::R,
        Channel::N,
        Channel::WindSpeed,
        Channel::WindFrom,
    ],
};
