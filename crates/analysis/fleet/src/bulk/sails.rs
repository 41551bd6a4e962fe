//! Whether a model sails, at little cost: one hard turn and one zigzag in coarse steps. What
//! diverges in the standard manoeuvres diverges in these, and thousands of ships can be asked.

use serde::{Deserialize, Serialize};
use sistership_model::{Law, Model};
use sistership_simulation::manoeuvre::{
    Manoeuvre, ManoeuvreSettings, Sailed as Track, Turn, Zigzag, sail_together,
};
use sistership_simulation::{PlantError, Ship, Stopped};

/// Steps in which a ship sails its length.
const STEPS_A_LENGTH: f64 = 30.0;

/// What a model makes of a turn at 35 deg and a 20/20 zigzag, both to starboard.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SailedFigures {
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

impl SailedFigures {
    /// Whether it does everything that `before` does: nothing more leaves the physical range, and a
    /// turn that came round, or a zigzag that answered, still does.
    pub fn as_well_as(&self, before: &Self) -> bool {
        let kept = |was: Option<f64>, is: Option<f64>| was.is_none() || is.is_some();
        let metrics = [
            (before.tactical_diameter_l, self.tactical_diameter_l),
            (before.advance_l, self.advance_l),
            (before.first_overshoot_deg, self.first_overshoot_deg),
        ];
        self.failures.len() <= before.failures.len()
            && metrics.into_iter().all(|(was, is)| kept(was, is))
    }
}

/// What is sailed: rudder and switching angle, deg.
const SAILED: [Manoeuvre; 2] =
    [Manoeuvre::Turn { rudder: 35.0 }, Manoeuvre::Zigzag { rudder: 20.0, switch: 20.0 }];

/// Sails both manoeuvres with each model of a ship; those that differ in the values of their
/// coefficients alone sail in lockstep.
pub fn sail(models: &[&Model], law: &Law) -> Vec<SailedFigures> {
    let alone = || {
        models
            .iter()
            .map(|model| together(Ship::new(model, law), &[Vec::new()]).remove(0))
            .collect()
    };
    let Some(Ok(ship)) = models.first().map(|model| Ship::sisters(model, law)) else {
        return alone();
    };
    let sisters: Option<Vec<Vec<f64>>> = models.iter().map(|model| ship.sister(model)).collect();
    sisters.map_or_else(alone, |sisters| together(Ok(ship), &sisters))
}

fn together(ship: Result<Ship, PlantError>, sisters: &[Vec<f64>]) -> Vec<SailedFigures> {
    let ship = match ship {
        Ok(ship) => ship,
        Err(error) => {
            return vec![
                SailedFigures {
                    failures: vec![error.to_string()],
                    ..SailedFigures::default()
                };
                sisters.len()
            ];
        }
    };
    let step_s = ship.lpp_m() / (STEPS_A_LENGTH * ship.approach_speed_m_s());
    let settings = ManoeuvreSettings { step_s: Some(step_s), ..ManoeuvreSettings::default() };
    let manoeuvres: Vec<(Manoeuvre, &[f64])> = sisters
        .iter()
        .flat_map(|sister| SAILED.map(|manoeuvre| (manoeuvre, sister.as_slice())))
        .collect();
    let mut sailed = sail_together(&ship, &manoeuvres, &settings).into_iter();
    sisters.iter().map(|_| SailedFigures::of(&ship, sailed.by_ref().take(SAILED.len()))).collect()
}

impl SailedFigures {
    fn of(ship: &Ship, sailed: impl Iterator<Item = Result<Track, Stopped>>) -> Self {
        let mut own = Self::default();
        for (manoeuvre, sailed) in SAILED.into_iter().zip(sailed) {
            let noted = match manoeuvre {
                Manoeuvre::Turn { rudder } => {
                    sailed.and_then(|track| Turn::of(track, rudder)).map(|turn| {
                        own.tactical_diameter_l = turn
                            .metrics
                            .tactical_diameter_m
                            .map(|diameter| diameter / ship.lpp_m());
                        own.advance_l =
                            turn.metrics.advance_m.map(|advance| advance / ship.lpp_m());
                    })
                }
                Manoeuvre::Zigzag { rudder, switch } => {
                    sailed.and_then(|track| Zigzag::of(track, rudder, switch)).map(|zigzag| {
                        own.first_overshoot_deg = zigzag.metrics.first_overshoot_deg;
                        own.second_overshoot_deg = zigzag.metrics.second_overshoot_deg;
                    })
                }
            };
            own.failures.extend(noted.err().map(|stopped| format!("{manoeuvre}: {stopped}")));
        }
        own
    }
}
