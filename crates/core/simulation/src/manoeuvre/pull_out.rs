//! The pull-out test: out of a steady turn the rudder is put amidships.

use super::ManoeuvreSettings;
use super::steady::{Steady, to_the_end};
use crate::envelope::Stopped;
use crate::metrics::PullOutMetrics;
use crate::ship::{Order, Ship};
use crate::state::{StateVector, Trajectory, at, speed, straight};

/// A pull-out that was sailed.
#[derive(Debug, Clone)]
pub struct PullOut {
    /// Where it went, the turn before it included.
    pub track: Trajectory,
    /// What came of it.
    pub metrics: PullOutMetrics,
}

/// The longest turn and the longest time after it, by the time in which it sails its length.
const MOST_LENGTHS: f64 = 150.0;

/// Sails a steady turn, puts the rudder amidships, and goes on until the yaw rate is steady.
///
/// # Errors
/// Says when and why the motion left the physical range.
pub fn pull_out(
    ship: &Ship,
    rudder_deg: f64,
    settings: &ManoeuvreSettings,
) -> Result<PullOut, Stopped> {
    let approach = settings.speed(ship);
    let most_s = settings.duration_s.unwrap_or(MOST_LENGTHS * ship.lpp_m() / approach);
    let whole = to_the_end(settings, ship, 2.0 * most_s);
    let mut helm = Helm {
        steady: Steady::new(ship, approach, whole.step(ship)),
        most_s,
        released: None,
        ended: None,
    };
    let (mut track, n_rps) = (Trajectory::default(), settings.revolutions(ship));
    ship.sail(whole.run(ship, straight(approach)), &mut track, |t_s, state| {
        let delta_deg = helm.rudder_deg(t_s, state, rudder_deg)?;
        Some(Order { delta_rad: delta_deg.to_radians(), n_rps })
    })?;
    let left = helm.ended.as_ref();
    let metrics = PullOutMetrics {
        rudder_deg,
        turning_rate_deg_s: helm.released.map_or(0.0, |(_, rate)| rate.to_degrees()),
        residual_rate_deg_s: left.map(|state| state[at::R].to_degrees()),
        residual_rate_by_length: left.map(|state| state[at::R] * ship.lpp_m() / speed(state)),
    };
    Ok(PullOut { track, metrics })
}

struct Helm {
    steady: Steady,
    most_s: f64,
    /// When the rudder was put amidships, s, and the yaw rate then, rad/s.
    released: Option<(f64, f64)>,
    /// The steady state after that.
    ended: Option<StateVector>,
}

impl Helm {
    fn rudder_deg(&mut self, t_s: f64, state: &StateVector, turn_deg: f64) -> Option<f64> {
        if self.ended.is_some() {
            return None;
        }
        let steady = self.steady.is_steady(state);
        match self.released {
            None if steady || t_s >= self.most_s => {
                self.released = Some((t_s, state[at::R]));
                self.steady.restart();
                Some(0.0)
            }
            None => Some(turn_deg),
            Some(_) if steady => {
                self.ended = Some(*state);
                Some(0.0)
            }
            Some((since_s, _)) => (t_s - since_s < self.most_s).then_some(0.0),
        }
    }
}
