//! Thresholds of trials: reading, display and proposal.

use sistership_model::trial::Channel;

/// Reading and simulation of trials.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TrialThresholds {
    /// `T_s`: shortest interval between samples that are used, by `L/U`, dimensionless. Source:
    /// chosen; a ship moves by a fiftieth of its length, so that a shorter step changes the
    /// linearisation by less than noise.
    pub least_step: f64,
    /// `T_j`: time before and after a jump in which readings are not used, by `L/U`, dimensionless:
    /// smoothing spreads the jump. Source: chosen; the rule was derived from the Esso Osaka trials
    /// (`docs/evidence/diagnosis.md`, "Positions and headings jump").
    pub settles: f64,
    /// `T_r`: interval between restarts of the simulations that judge, by `L/U`, dimensionless.
    /// Source: decision 2 (`restart_s`).
    pub restart: f64,
}

/// Values of trials.
pub(super) const TRIALS: TrialThresholds =
    TrialThresholds { least_step: 0.02, settles: 0.2, restart: 10.0 };

/// Rudder and switching angle of a manoeuvre, deg; a turn has no switching angle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlannedHelm {
    /// Name.
    pub name: &'static str,
    /// Rudder angle, deg.
    pub rudder_deg: f64,
    /// Heading at which the rudder is switched, deg.
    pub switch_deg: Option<f64>,
}

/// Proposed trial.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NextTrialThresholds {
    /// Possible manoeuvres. Source: the standard manoeuvres of IMO MSC.137(76), and a turning
    /// circle at 15 deg, which is gentler.
    pub manoeuvres: [PlannedHelm; 4],
    /// `U_k/U`: approach speeds by that of the trials, dimensionless. Source: chosen, full and
    /// reduced speed.
    pub speeds: [f64; 2],
    /// `psi_k`: headings of the approach, deg. Source: chosen; external influences turn with the
    /// heading, and quarter turns are furthest apart.
    pub headings_deg: [f64; 3],
    /// `T`: duration by `L/U`, dimensionless. Source: chosen; a turning circle of a diameter of 5
    /// to 8 lengths is 16 to 25 lengths long.
    pub duration: f64,
    /// `T_0`: run-in by `L/U`, dimensionless. Source: chosen, two lengths of straight course.
    pub run_in: f64,
}

/// Values of the next trial.
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

/// Series for plots, which decide nothing.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SeriesThresholds {
    /// `n_t`: most points of a series, a count. Source: chosen, about as many as a plot of a report
    /// can resolve.
    pub points: usize,
    /// `n_q`: number of classes of a variable for the share of a residual that it explains, a
    /// count. Source: chosen, 30 deg each of a heading.
    pub classes: usize,
    /// `z_b`: half width of the band by the smoother's standard deviation, dimensionless. Source:
    /// derived: 95 % of a normal distribution.
    pub band: f64,
    /// Variables that are examined. Source: chosen, the recorded channels that a residual may
    /// follow.
    pub variables: [Channel; 8],
}

/// Values of the series.
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
