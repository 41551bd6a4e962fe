//! Simulation of the standard manoeuvres.

mod engine;
mod figures;
mod further;
mod helm;
mod pull_out;
mod reversing;
mod spiral;
mod standard;
mod steady;
mod stopping;

use serde::{Deserialize, Serialize};

pub use figures::NamedFigure;
pub use further::{
    FurtherManoeuvres, FurtherSelection, SpiralSelection, simulate_further_manoeuvres,
};
pub use helm::{Manoeuvre, SimulatedManoeuvre, simulate_manoeuvre_batch};
pub use pull_out::{PullOut, simulate_pull_out};
pub use reversing::{ReversingError, check_reversing};
pub use spiral::simulate_spirals;
pub use standard::{
    STANDARD_MANOEUVRES, StandardManoeuvres, TurningCircle, ZigzagTest, simulate_standard_ensemble,
    simulate_standard_manoeuvres, simulate_standard_with_tracks,
};
pub use stopping::{AsternOrder, StoppingError, StoppingTest, simulate_stop};

use engine::EngineOrder;

use crate::envelope::SimulationStop;
use crate::integrate::Method;
use crate::ship::{RunSettings, Ship};
use crate::state::StateVector;

/// Settings of simulated manoeuvres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ManoeuvreSettings {
    /// Approach speed, m/s; default: that of the model.
    pub speed_m_s: Option<f64>,
    /// Propeller revolutions on the approach, 1/s; default: those of steady running at its speed.
    pub n_rps: Option<f64>,
    /// Longest duration, s; default: enough for a turn of three full circles.
    pub duration_s: Option<f64>,
    /// Step, s; default: 0.1 s, or a fiftieth of length over speed for a small ship.
    pub step_s: Option<f64>,
    /// Integration method.
    pub method: Method,
    /// Duration of the straight approach before the rudder is executed, s.
    pub run_in_s: f64,
    /// True if a zigzag's rudder is reversed when the heading is reached within a step, not at the
    /// end of the step: needed to compare overshoots that differ little with coarse steps.
    pub reversals_within_steps: bool,
    /// True if the initial turns end soon after the required change of heading, not after three
    /// full circles: their figure needs no more.
    pub figures_only: bool,
}

impl Default for ManoeuvreSettings {
    fn default() -> Self {
        Self {
            speed_m_s: None,
            n_rps: None,
            duration_s: None,
            step_s: None,
            method: Method::Rk4,
            run_in_s: 0.0,
            reversals_within_steps: false,
            figures_only: false,
        }
    }
}

impl ManoeuvreSettings {
    fn approach_speed(&self, ship: &Ship) -> f64 {
        self.speed_m_s.unwrap_or(ship.approach_speed_m_s())
    }

    fn engine_order(&self, ship: &Ship) -> EngineOrder {
        let speed_m_s = self.approach_speed(ship);
        let n_rps = self.n_rps.unwrap_or_else(|| ship.revolutions_at(speed_m_s));
        EngineOrder { n_rps, speed_m_s, loss: ship.revolutions_loss() }
    }

    /// Duration, s, scaled with length and speed so that a small model and a large ship cover the
    /// same distance: 60 lengths.
    fn total_duration_s(&self, ship: &Ship) -> f64 {
        self.duration_s.unwrap_or_else(|| 60.0 * ship.lpp_m() / self.approach_speed(ship))
            + self.run_in_s
    }

    /// Step, s.
    pub fn step_length_s(&self, ship: &Ship) -> f64 {
        let default = 0.1_f64.min(0.02 * ship.lpp_m() / self.approach_speed(ship));
        self.step_s.unwrap_or(default)
    }

    fn run_settings(&self, ship: &Ship, start: StateVector) -> RunSettings {
        let (duration_s, step_s) = (self.total_duration_s(ship), self.step_length_s(ship));
        RunSettings { start, duration_s, step_s, method: self.method }
    }
}

/// Simulates a turning circle.
///
/// # Errors
/// Returns an error with time and reason if the motion left the physical range.
pub fn simulate_turn(
    ship: &Ship,
    rudder_deg: f64,
    settings: &ManoeuvreSettings,
) -> Result<TurningCircle, SimulationStop> {
    let turn = Manoeuvre::Turn { rudder: rudder_deg };
    TurningCircle::from_manoeuvre(
        simulate_manoeuvre_batch(ship, &[(turn, &[])], settings).remove(0)?,
        rudder_deg,
    )
}

/// Simulates a zigzag of four reversals.
///
/// # Errors
/// Returns an error with time and reason if the motion left the physical range.
pub fn simulate_zigzag(
    ship: &Ship,
    rudder_deg: f64,
    switch_deg: f64,
    settings: &ManoeuvreSettings,
) -> Result<ZigzagTest, SimulationStop> {
    simulate_zigzags(ship, &[(rudder_deg, switch_deg)], settings).remove(0)
}

/// Simulates zigzags in lockstep, each given by the rudder angle and the heading at which it is
/// reversed, deg. Each has its own error, as in [`zigzag`].
pub fn simulate_zigzags(
    ship: &Ship,
    angles: &[(f64, f64)],
    settings: &ManoeuvreSettings,
) -> Vec<Result<ZigzagTest, SimulationStop>> {
    let of = |&(rudder, switch): &(f64, f64)| (Manoeuvre::Zigzag { rudder, switch }, &[] as &[_]);
    let all: Vec<_> = angles.iter().map(of).collect();
    let sailed = simulate_manoeuvre_batch(ship, &all, settings).into_iter().zip(angles);
    sailed
        .map(|(track, (rudder, switch))| ZigzagTest::from_manoeuvre(track?, *rudder, *switch))
        .collect()
}
