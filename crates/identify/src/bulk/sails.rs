//! Whether a model sails, at little cost: one hard turn and one zigzag in coarse steps. What diverges in the standard manoeuvres
//! diverges in these, and thousands of ships can be asked.

use serde::{Deserialize, Serialize};
use sistership_dynamics::Ship;
use sistership_dynamics::envelope::Stopped;
use sistership_dynamics::manoeuvre::{ManoeuvreSettings, turn, zigzag};
use sistership_model::{Law, Model};

/// Steps in which a ship sails her length.
const STEPS_A_LENGTH: f64 = 30.0;

/// What a model makes of a turn at 35 deg and a 20/20 zigzag, both to starboard.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Sailed {
    /// Tactical diameter, in lengths.
    pub tactical_diameter_l: Option<f64>,
    /// Advance, in lengths.
    pub advance_l: Option<f64>,
    /// First overshoot, deg.
    pub first_overshoot_deg: Option<f64>,
    /// Second overshoot, deg.
    pub second_overshoot_deg: Option<f64>,
    /// What left the physical range, with the reason.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub failures: Vec<String>,
}

impl Sailed {
    /// Whether it does everything that `before` does: nothing more leaves the physical range, and a turn that came round, or a
    /// zigzag that answered, still does.
    pub fn as_well_as(&self, before: &Self) -> bool {
        let kept = |was: Option<f64>, is: Option<f64>| was.is_none() || is.is_some();
        let metrics = [
            (before.tactical_diameter_l, self.tactical_diameter_l),
            (before.advance_l, self.advance_l),
            (before.first_overshoot_deg, self.first_overshoot_deg),
        ];
        self.failures.len() <= before.failures.len() && metrics.into_iter().all(|(was, is)| kept(was, is))
    }
}

/// Sails both.
pub fn sail(model: &Model, law: &Law) -> Sailed {
    let mut sailed = Sailed::default();
    let ship = match Ship::new(model, law) {
        Ok(ship) => ship,
        Err(error) => return Sailed { failures: vec![error.to_string()], ..sailed },
    };
    let length = ship.lpp_m();
    let step_s = length / (STEPS_A_LENGTH * ship.approach_speed_m_s());
    let settings = ManoeuvreSettings { step_s: Some(step_s), ..ManoeuvreSettings::default() };
    match turn(&ship, 35.0, &settings) {
        Ok(turn) => {
            sailed.tactical_diameter_l = turn.metrics.tactical_diameter_m.map(|diameter| diameter / length);
            sailed.advance_l = turn.metrics.advance_m.map(|advance| advance / length);
        }
        Err(stopped) => sailed.failures.push(failure("turn 35 deg", &stopped)),
    }
    match zigzag(&ship, 20.0, 20.0, &settings) {
        Ok(zigzag) => {
            sailed.first_overshoot_deg = zigzag.metrics.first_overshoot_deg;
            sailed.second_overshoot_deg = zigzag.metrics.second_overshoot_deg;
        }
        Err(stopped) => sailed.failures.push(failure("zigzag 20/20", &stopped)),
    }
    sailed
}

fn failure(manoeuvre: &str, stopped: &Stopped) -> String {
    format!("{manoeuvre}: {stopped}")
}
