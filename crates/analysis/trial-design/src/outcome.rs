//! What a plan says.

use serde::{Deserialize, Serialize};

use crate::instruments::Instruments;

/// A plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// The model by which it was made.
    pub model: String,
    /// The time that there is, min.
    pub budget_min: f64,
    /// The time that it takes, min.
    pub takes_min: f64,
    /// The trials, in the order in which each gains most a minute.
    pub trials: Vec<PlannedTrial>,
    /// By what share the bands are expected to be narrower in the geometric mean.
    pub narrower: f64,
    /// What is to be narrowed, with the bands that are expected.
    pub bands: Vec<ExpectedBand>,
    /// The manoeuvres of IMO in the same time.
    pub standard: StandardProgramme,
    /// What the trials are expected to be read by; absent where earlier trials say it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub instruments: Option<Instruments>,
    /// What was taken for granted.
    pub remarks: Vec<String>,
}

/// A trial of a plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlannedTrial {
    /// The manoeuvre, such as `turn 35 deg` or `zigzag -10/10`.
    pub manoeuvre: String,
    /// Rudder, deg, positive to starboard.
    pub rudder_deg: f64,
    /// Change of heading at which it is reversed, deg; absent for a turn.
    pub switch_deg: Option<f64>,
    /// Approach speed, m/s.
    pub speed_m_s: f64,
    /// Heading of the approach, deg; absent where none is better than another.
    pub heading_deg: Option<f64>,
    /// From the execution of the rudder to the end, min.
    pub manoeuvre_min: f64,
    /// With the approach, and until the ship is steady at its full speed again, min.
    pub takes_min: f64,
    /// By what share the bands are narrower in the geometric mean with this trial and those before
    /// it.
    pub narrower: f64,
}

/// A figure or parameter with the bands that are expected, all half widths of 95 %.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ExpectedBand {
    /// The figure, such as `turn 35 deg: advance`, or `effect/form: parameter`.
    pub figure: String,
    /// Its unit; empty where the name says it.
    pub unit: String,
    /// What the model says.
    pub value: f64,
    /// Now.
    pub now: f64,
    /// After the trials of the plan.
    pub after: f64,
    /// After the manoeuvres of IMO in the same time.
    pub after_standard: f64,
}

/// The manoeuvres of IMO MSC.137(76) in the same time: turns at 35 deg, zigzags 10/10 and 20/20 to
/// both sides, again from the first where time is left.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StandardProgramme {
    /// The manoeuvres.
    pub trials: Vec<PlannedTrial>,
    /// The time that they take, min.
    pub takes_min: f64,
    /// By what share the bands are narrower in the geometric mean.
    pub narrower: f64,
}
