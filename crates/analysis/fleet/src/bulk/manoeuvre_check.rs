//! Check of a model by simulation at low cost: one hard turn and one zigzag in coarse steps. A
//! model that diverges in the standard manoeuvres also diverges in these, and thousands of ships
//! can be checked.

use serde::{Deserialize, Serialize};
use sistership_model::{Law, Model};
use sistership_simulation::manoeuvre::{
    Manoeuvre, ManoeuvreSettings, SimulatedManoeuvre as Track, TurningCircle, ZigzagTest,
    simulate_manoeuvre_batch,
};
use sistership_simulation::{PlantError, Ship, SimulationStop};

/// Number of time steps per ship length at the approach speed.
const STEPS_A_LENGTH: f64 = 30.0;

/// Figures of a turn at 35 deg and a 20/20 zigzag, both to starboard.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ManoeuvreFigures {
    /// Tactical diameter, in lengths.
    pub tactical_diameter_l: Option<f64>,
    /// Advance, in lengths.
    pub advance_l: Option<f64>,
    /// First overshoot, deg.
    pub first_overshoot_deg: Option<f64>,
    /// Second overshoot, deg.
    pub second_overshoot_deg: Option<f64>,
    /// Manoeuvres that left the physical range, with the reason.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub failures: Vec<String>,
}

impl ManoeuvreFigures {
    /// True if the model performs at least as well as `before`: no more failures, and every turn or
    /// zigzag that was completed still is.
    pub fn is_no_worse_than(&self, before: &Self) -> bool {
        let kept = |was: Option<f64>, is: Option<f64>| was.is_none() || is.is_some();
        // A figure that existed before must still exist; its value may change.
        let metrics = [
            (before.tactical_diameter_l, self.tactical_diameter_l),
            (before.advance_l, self.advance_l),
            (before.first_overshoot_deg, self.first_overshoot_deg),
        ];
        self.failures.len() <= before.failures.len()
            && metrics.into_iter().all(|(was, is)| kept(was, is))
    }
}

/// Simulated manoeuvres: rudder and switching angle, deg.
const CHECK_MANOEUVRES: [Manoeuvre; 2] =
    [Manoeuvre::Turn { rudder: 35.0 }, Manoeuvre::Zigzag { rudder: 20.0, switch: 20.0 }];

/// Simulates both manoeuvres with each model of a ship; models that differ in the values of their
/// coefficients alone are simulated in lockstep.
pub fn simulate_check(models: &[&Model], law: &Law) -> Vec<ManoeuvreFigures> {
    let alone = || {
        models
            .iter()
            .map(|model| simulate_sisters(Ship::new(model, law), &[Vec::new()]).remove(0))
            .collect()
    };
    // Lockstep needs models of one structure; otherwise each is simulated by itself.
    let Some(Ok(ship)) = models.first().map(|model| Ship::with_open_coefficients(model, law))
    else {
        return alone();
    };
    let sisters: Option<Vec<Vec<f64>>> =
        models.iter().map(|model| ship.open_coefficient_values(model)).collect();
    sisters.map_or_else(alone, |sisters| simulate_sisters(Ok(ship), &sisters))
}

/// Simulates both manoeuvres for several sets of coefficients of one ship.
fn simulate_sisters(ship: Result<Ship, PlantError>, sisters: &[Vec<f64>]) -> Vec<ManoeuvreFigures> {
    let ship = match ship {
        Ok(ship) => ship,
        Err(error) => {
            return vec![
                ManoeuvreFigures {
                    // A model that cannot be set up fails for all sets of coefficients.
                    failures: vec![error.to_string()],
                    ..ManoeuvreFigures::default()
                };
                sisters.len()
            ];
        }
    };
    let step_s = ship.lpp_m() / (STEPS_A_LENGTH * ship.approach_speed_m_s());
    let settings = ManoeuvreSettings { step_s: Some(step_s), ..ManoeuvreSettings::default() };
    let manoeuvres: Vec<(Manoeuvre, &[f64])> = sisters
        .iter()
        .flat_map(|sister| CHECK_MANOEUVRES.map(|manoeuvre| (manoeuvre, sister.as_slice())))
        .collect();
    let mut sailed = simulate_manoeuvre_batch(&ship, &manoeuvres, &settings).into_iter();
    sisters
        .iter()
        .map(|_| ManoeuvreFigures::from_runs(&ship, sailed.by_ref().take(CHECK_MANOEUVRES.len())))
        .collect()
}

impl ManoeuvreFigures {
    /// Collects the figures of the manoeuvres, or their failures.
    fn from_runs(ship: &Ship, sailed: impl Iterator<Item = Result<Track, SimulationStop>>) -> Self {
        let mut own = Self::default();
        for (manoeuvre, sailed) in CHECK_MANOEUVRES.into_iter().zip(sailed) {
            // A manoeuvre that stops early, or cannot be evaluated, is recorded as a failure.
            let noted = match manoeuvre {
                Manoeuvre::Turn { rudder } => sailed
                    .and_then(|track| TurningCircle::from_manoeuvre(track, rudder))
                    .map(|turn| {
                        own.tactical_diameter_l = turn
                            .metrics
                            .tactical_diameter_m
                            .map(|diameter| diameter / ship.lpp_m());
                        own.advance_l =
                            turn.metrics.advance_m.map(|advance| advance / ship.lpp_m());
                    }),
                Manoeuvre::Zigzag { rudder, switch } => sailed
                    .and_then(|track| ZigzagTest::from_manoeuvre(track, rudder, switch))
                    .map(|zigzag| {
                        own.first_overshoot_deg = zigzag.metrics.first_overshoot_deg;
                        own.second_overshoot_deg = zigzag.metrics.second_overshoot_deg;
                    }),
            };
            own.failures.extend(noted.err().map(|stopped| format!("{manoeuvre}: {stopped}")));
        }
        own
    }
}
