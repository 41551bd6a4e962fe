//! Where a ship is after her propeller was stopped or reversed.

use sistership_simulation::state::{StateVector, Trajectory, at, straight_state};
use sistership_simulation::{HelmOrder, Method, RunSettings, Ship};
use sistership_tests::truth::motion::{Truth, sail_from};

/// Speeds by that of the approach, so many times after the order as the ship sails its length in;
/// none where the motion left the physical range.
#[derive(Debug, Clone, Copy)]
pub struct Speeds {
    /// Propeller stopped.
    pub stopped: Option<f64>,
    /// As many revolutions astern as ahead.
    pub reversed: Option<f64>,
    /// The same from rest.
    pub astern: Option<f64>,
}

/// How long, by the time in which the ship sails its length.
const LENGTHS: f64 = 60.0;

/// By a model.
pub fn of_model(ship: &Ship) -> Speeds {
    let speed = ship.approach_speed_m_s();
    let length_s = ship.lpp_m() / speed;
    let last = |start: f64, turns: f64| {
        let order = HelmOrder { delta_rad: 0.0, n_rps: turns * ship.revolutions_at(speed) };
        let run = RunSettings {
            start: straight_state(start * speed),
            duration_s: LENGTHS * length_s,
            step_s: 0.05 * length_s,
            method: Method::Rk4,
        };
        let mut track = Trajectory::default();
        ship.simulate_orders(run, &mut track, |_, _| Some(order)).ok()?;
        track.states.last().map(|state| state[at::U] / speed)
    };
    Speeds { stopped: last(1.0, 0.0), reversed: last(1.0, -1.0), astern: last(0.0, -1.0) }
}

/// By the truth, whose propeller does nothing unless it turns ahead.
pub fn of_truth(ship: &dyn Truth) -> Speeds {
    let size = ship.dimensions();
    let still = |_: f64, _: &StateVector| 0.0;
    let track =
        sail_from(ship, straight_state(size.speed_m_s), LENGTHS * size.length_time_s(), 0.0, still);
    let stopped = track.states.last().map(|state| state[at::U] / size.speed_m_s);
    Speeds { stopped, reversed: None, astern: None }
}
