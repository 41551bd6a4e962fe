//! The standard manoeuvres, sailed by a model.

mod figures;
mod standard;

use serde::{Deserialize, Serialize};

pub use figures::Figure;
pub use standard::{StandardManoeuvres, Turn, Zigzag, standard};

use crate::envelope::Stopped;
use crate::integrate::Method;
use crate::metrics::{TurningMetrics, ZigzagMetrics};
use crate::ship::{Order, Run, Ship};
use crate::state::{StateVector, Trajectory, at, straight};

/// How manoeuvres are sailed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ManoeuvreSettings {
    /// Approach speed, m/s; the model's own where absent.
    pub speed_m_s: Option<f64>,
    /// Propeller revolutions, 1/s; those of steady running at the approach speed where absent.
    pub n_rps: Option<f64>,
    /// Longest duration, s; enough for a turn of three times round where absent.
    pub duration_s: Option<f64>,
    /// Step, s; where absent 0.1 s, or a fiftieth of the time in which a small ship sails her length.
    pub step_s: Option<f64>,
    /// Integration method.
    pub method: Method,
    /// Run straight for this long before the rudder is executed, s.
    pub run_in_s: f64,
}

impl Default for ManoeuvreSettings {
    fn default() -> Self {
        Self { speed_m_s: None, n_rps: None, duration_s: None, step_s: None, method: Method::Rk4, run_in_s: 0.0 }
    }
}

impl ManoeuvreSettings {
    fn speed(&self, ship: &Ship) -> f64 {
        self.speed_m_s.unwrap_or(ship.approach_speed_m_s())
    }

    fn revolutions(&self, ship: &Ship) -> f64 {
        self.n_rps.unwrap_or_else(|| ship.revolutions_at(self.speed(ship)))
    }

    /// Scaled so that a small model and a large ship sail as far: 60 of her lengths.
    fn duration(&self, ship: &Ship) -> f64 {
        self.duration_s.unwrap_or_else(|| 60.0 * ship.lpp_m() / self.speed(ship)) + self.run_in_s
    }

    fn run(&self, ship: &Ship, start: StateVector) -> Run {
        let default = 0.1_f64.min(0.02 * ship.lpp_m() / self.speed(ship));
        Run { start, duration_s: self.duration(ship), step_s: self.step_s.unwrap_or(default), method: self.method }
    }
}

/// Sails a turning circle.
///
/// # Errors
/// Says when and why the motion left the physical range.
pub fn turn(ship: &Ship, rudder_deg: f64, settings: &ManoeuvreSettings) -> Result<Turn, Stopped> {
    let n_rps = settings.revolutions(ship);
    let mut track = Trajectory::default();
    let start = straight(settings.speed(ship));
    let rounds = if settings.duration_s.is_some() { f64::INFINITY } else { 3.0 * std::f64::consts::TAU };
    ship.sail(settings.run(ship, start), &mut track, |t_s, state| {
        let executed = t_s >= settings.run_in_s - 1e-9;
        let done = state[at::PSI].abs() > rounds;
        (!done).then_some(Order { delta_rad: if executed { rudder_deg.to_radians() } else { 0.0 }, n_rps })
    })?;
    let after = after(&track, settings.run_in_s);
    let metrics = TurningMetrics::of(&after, rudder_deg).ok_or(Stopped { t_s: 0.0, reason: "nothing was sailed".into() })?;
    Ok(Turn { track, metrics })
}

/// Sails a zigzag of four reversals.
///
/// # Errors
/// Says when and why the motion left the physical range.
pub fn zigzag(ship: &Ship, rudder_deg: f64, switch_deg: f64, settings: &ManoeuvreSettings) -> Result<Zigzag, Stopped> {
    let n_rps = settings.revolutions(ship);
    let mut track = Trajectory::default();
    let mut pilot = Pilot { rudder_deg, switch_deg, reversals_s: Vec::new() };
    let start = straight(settings.speed(ship));
    let forever = settings.duration_s.is_some();
    ship.sail(settings.run(ship, start), &mut track, |t_s, state| {
        let since = t_s - settings.run_in_s;
        let order_deg = if since < -1e-9 { 0.0 } else { pilot.order_deg(since, state) };
        let done = !forever && pilot.reversals_s.len() > 4;
        (!done).then_some(Order { delta_rad: order_deg.to_radians(), n_rps })
    })?;
    let after = after(&track, settings.run_in_s);
    let metrics = ZigzagMetrics::of(&after, rudder_deg, switch_deg, &pilot.reversals_s);
    let metrics = metrics.ok_or(Stopped { t_s: 0.0, reason: "nothing was sailed".into() })?;
    Ok(Zigzag { track, metrics })
}

/// Reverses the rudder at the first step at which the heading has reached the switching angle.
struct Pilot {
    rudder_deg: f64,
    switch_deg: f64,
    reversals_s: Vec<f64>,
}

impl Pilot {
    fn order_deg(&mut self, since_s: f64, state: &StateVector) -> f64 {
        let sign = |reversals: usize| if reversals.is_multiple_of(2) { 1.0 } else { -1.0 };
        let side = sign(self.reversals_s.len()) * self.rudder_deg.signum();
        if side * state[at::PSI].to_degrees() >= self.switch_deg {
            self.reversals_s.push(since_s);
        }
        sign(self.reversals_s.len()) * self.rudder_deg
    }
}

/// The part of a track from a time on, with time counted from there.
fn after(track: &Trajectory, from_s: f64) -> Trajectory {
    let keep = |index: &usize| track.t_s[*index] >= from_s - 1e-9;
    let mut result = Trajectory::default();
    for k in (0..track.t_s.len()).filter(keep) {
        result.push(track.t_s[k] - from_s, track.states[k], track.n_rps[k]);
    }
    result
}
