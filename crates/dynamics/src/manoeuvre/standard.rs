//! The set of manoeuvres by which a ship is judged.

use serde::{Deserialize, Serialize};

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
}

/// Sails the standard manoeuvres; one that diverges is reported and the others go on.
pub fn standard(ship: &Ship, settings: &ManoeuvreSettings) -> StandardManoeuvres {
    let mut all = StandardManoeuvres::default();
    for rudder_deg in [35.0, -35.0] {
        let sailed = turn(ship, rudder_deg, settings);
        note(sailed, &format!("turn {rudder_deg} deg"), &mut all.failures, |turn| all.turns.push(turn.metrics));
    }
    for angle in [10.0, -10.0, 20.0, -20.0_f64] {
        let sailed = zigzag(ship, angle, angle.abs(), settings);
        note(sailed, &format!("zigzag {angle}/{}", angle.abs()), &mut all.failures, |zigzag| all.zigzags.push(zigzag.metrics));
    }
    let mut initial = Vec::new();
    for rudder_deg in [10.0, -10.0] {
        let sailed = turn(ship, rudder_deg, settings);
        note(sailed, &format!("turn {rudder_deg} deg"), &mut all.failures, |turn| {
            initial.push(initial_turning_distance(&turn.track, rudder_deg, 10.0));
        });
    }
    let both: Option<Vec<f64>> = initial.into_iter().collect();
    all.initial_turning_m = both.and_then(|both| both.into_iter().reduce(f64::max));
    let speed = settings.speed_m_s.unwrap_or(ship.approach_speed_m_s());
    all.imo = criteria(ship.lpp_m(), speed, &all.turns, &all.zigzags, all.initial_turning_m);
    all
}

fn note<T>(sailed: Result<T, Stopped>, name: &str, failures: &mut Vec<String>, keep: impl FnOnce(T)) {
    match sailed {
        Ok(result) => keep(result),
        Err(stopped) => failures.push(format!("{name}: {stopped}")),
    }
}
