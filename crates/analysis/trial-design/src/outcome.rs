//! Result of a trial design.

use serde::{Deserialize, Serialize};

use crate::instruments::InstrumentAccuracy;

/// Result of a trial design.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrialPlan {
    /// Name of the model.
    pub model: String,
    /// Available time, min.
    pub budget_min: f64,
    /// Required time, min.
    pub takes_min: f64,
    /// Trials, most informative per minute first.
    pub trials: Vec<PlannedTrial>,
    /// Expected share by which the bands are narrower in the geometric mean.
    pub narrower: f64,
    /// Targets of the design, with their expected bands.
    pub bands: Vec<ExpectedBand>,
    /// Manoeuvres of IMO in the same time.
    pub standard: StandardProgramme,
    /// Expected noise of the instruments; absent where earlier trials determine it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub instruments: Option<InstrumentAccuracy>,
    /// Assumptions.
    pub remarks: Vec<String>,
}

/// A trial of a design.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlannedTrial {
    /// Manoeuvre, such as `turn 35 deg` or `zigzag -10/10`.
    pub manoeuvre: String,
    /// Rudder angle, deg, positive to starboard.
    pub rudder_deg: f64,
    /// Change of heading at which the rudder is reversed, deg; absent for a turn.
    pub switch_deg: Option<f64>,
    /// Approach speed, m/s.
    pub speed_m_s: f64,
    /// Heading of the approach, deg; absent where all headings are equal.
    pub heading_deg: Option<f64>,
    /// Time from the execution of the rudder to the end, min.
    pub manoeuvre_min: f64,
    /// Time with the approach, and until the ship is steady at its full speed again, min.
    pub takes_min: f64,
    /// Share by which the bands are narrower in the geometric mean with this trial and those before
    /// it.
    pub narrower: f64,
}

/// A figure or parameter with its expected bands, all half widths of 95 %.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ExpectedBand {
    /// Name of the figure, such as `turn 35 deg: advance`, or `effect/form: parameter`.
    pub figure: String,
    /// Unit; empty where the name contains it.
    pub unit: String,
    /// Value by the model.
    pub value: f64,
    /// Half width at present.
    pub now: f64,
    /// Half width after the trials of the design.
    pub after: f64,
    /// Half width after the manoeuvres of IMO in the same time.
    pub after_standard: f64,
}

/// Manoeuvres of IMO MSC.137(76) in the same time: turns at 35 deg, zigzags 10/10 and 20/20 to both
/// sides, repeated from the first where time is left.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StandardProgramme {
    /// Trials.
    pub trials: Vec<PlannedTrial>,
    /// Required time, min.
    pub takes_min: f64,
    /// Share by which the bands are narrower in the geometric mean.
    pub narrower: f64,
}
