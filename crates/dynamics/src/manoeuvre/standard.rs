//! The set of manoeuvres by which a ship is judged.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use sistership_model::validity::Excursion;

use super::{ManoeuvreSettings, turn, zigzag};
use crate::envelope::Stopped;
use crate::metrics::{Criterion, TurningMetrics, ZigzagMetrics, criteria, initial_turning_distance};
use crate::ship::Ship;
use crate::state::Trajectory;

/// A turning circle that was sailed.
#[derive(Debug, Clone)]
pub struct Turn {
    /// Where she went.
    pub track: Trajectory,
    /// What came of it.
    pub metrics: TurningMetrics,
}

/// A zigzag that was sailed.
#[derive(Debug, Clone)]
pub struct Zigzag {
    /// Where she went.
    pub track: Trajectory,
    /// What came of it.
    pub metrics: ZigzagMetrics,
}

/// The metrics of the standard manoeuvres.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct StandardManoeuvres {
    /// Turning circles at 35 deg to both sides.
    pub turns: Vec<TurningMetrics>,
    /// Zigzags 10/10 and 20/20 to both sides.
    pub zigzags: Vec<ZigzagMetrics>,
    /// Distance sailed until the heading has changed by 10 deg with 10 deg of rudder, the worse side, m.
    pub initial_turning_m: Option<f64>,
    /// IMO criteria.
    pub imo: Vec<Criterion>,
    /// Manoeuvres that left the physical range, with the reason.
    pub failures: Vec<String>,
    /// Manoeuvres that left what the model's trials covered, and how.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub outside: BTreeMap<String, Excursion>,
}

impl StandardManoeuvres {
    /// Notes how a manoeuvre left what the model's trials covered, if it did.
    pub fn note_outside(&mut self, name: &str, ship: &Ship, track: &Trajectory) {
        self.outside.extend(ship.leaves(track).map(|excursion| (name.to_owned(), excursion)));
    }
}

/// Sails the standard manoeuvres; one that diverges is reported and the others go on.
pub fn standard(ship: &Ship, settings: &ManoeuvreSettings) -> StandardManoeuvres {
    let mut all = StandardManoeuvres::default();
    for rudder_deg in [35.0, -35.0] {
        let sailed = turn(ship, rudder_deg, settings);
        if let Some(turn) = kept(ship, sailed, &format!("turn {rudder_deg} deg"), &mut all, |turn| &turn.track) {
            all.turns.push(turn.metrics);
        }
    }
    for angle in [10.0, -10.0, 20.0, -20.0_f64] {
        let sailed = zigzag(ship, angle, angle.abs(), settings);
        if let Some(zigzag) = kept(ship, sailed, &format!("zigzag {angle}/{}", angle.abs()), &mut all, |zigzag| &zigzag.track) {
            all.zigzags.push(zigzag.metrics);
        }
    }
    let mut initial = Vec::new();
    for rudder_deg in [10.0, -10.0] {
        let sailed = turn(ship, rudder_deg, settings);
        if let Some(turn) = kept(ship, sailed, &format!("turn {rudder_deg} deg"), &mut all, |turn| &turn.track) {
            initial.push(initial_turning_distance(&turn.track, rudder_deg, 10.0));
        }
    }
    let both: Option<Vec<f64>> = initial.into_iter().collect();
    all.initial_turning_m = both.and_then(|both| both.into_iter().reduce(f64::max));
    let speed = settings.speed_m_s.unwrap_or(ship.approach_speed_m_s());
    all.imo = criteria(ship.lpp_m(), speed, &all.turns, &all.zigzags, all.initial_turning_m);
    all
}

/// What was sailed; a failure, or how it left what the trials covered, is noted.
fn kept<T>(
    ship: &Ship,
    sailed: Result<T, Stopped>,
    name: &str,
    all: &mut StandardManoeuvres,
    track: impl Fn(&T) -> &Trajectory,
) -> Option<T> {
    match sailed {
        Ok(result) => {
            all.note_outside(name, ship, track(&result));
            Some(result)
        }
        Err(stopped) => {
            all.failures.push(format!("{name}: {stopped}"));
            None
        }
    }
}
