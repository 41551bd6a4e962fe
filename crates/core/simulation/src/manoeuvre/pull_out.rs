//! Pull-out test: the rudder is put amidships out of a steady turn.

use super::ManoeuvreSettings;
use super::steady::{SteadyDetector, steady_settings};
use crate::envelope::SimulationStop;
use crate::metrics::PullOutMetrics;
use crate::ship::{HelmOrder, Ship};
use crate::state::{StateVector, Trajectory, at, horizontal_speed, straight_state};

/// Simulated pull-out.
#[derive(Debug, Clone)]
pub struct PullOut {
    /// Track, including the turn before it.
    pub track: Trajectory,
    /// Metrics of the pull-out.
    pub metrics: PullOutMetrics,
}

/// Longest duration of the turn and of the motion after it, in units of length over speed.
const MAX_LENGTHS: f64 = 150.0;

/// Simulates a steady turn, puts the rudder amidships, and continues until the yaw rate is steady.
///
/// # Errors
/// Returns an error with time and reason if the motion left the physical range.
pub fn simulate_pull_out(
    ship: &Ship,
    rudder_deg: f64,
    settings: &ManoeuvreSettings,
) -> Result<PullOut, SimulationStop> {
    let approach = settings.approach_speed(ship);
    let most_s = settings.duration_s.unwrap_or(MAX_LENGTHS * ship.lpp_m() / approach);
    // Once the longest duration for the turn, and once for the motion after it.
    let whole = steady_settings(settings, ship, 2.0 * most_s);
    let mut helm = PullOutHelm {
        steady: SteadyDetector::new(ship, approach, whole.step_length_s(ship)),
        most_s,
        released: None,
        ended: None,
    };
    let (mut track, engine) = (Trajectory::default(), settings.engine_order(ship));
    ship.simulate_orders(
        whole.run_settings(ship, straight_state(approach)),
        &mut track,
        |t_s, state| {
            let delta_deg = helm.rudder_deg(t_s, state, rudder_deg)?;
            let n_rps = engine.revolutions(state);
            Some(HelmOrder { delta_rad: delta_deg.to_radians(), n_rps })
        },
    )?;
    let left = helm.ended.as_ref();
    let metrics = PullOutMetrics {
        rudder_deg,
        turning_rate_deg_s: helm.released.map_or(0.0, |(_, rate)| rate.to_degrees()),
        residual_rate_deg_s: left.map(|state| state[at::R].to_degrees()),
        residual_rate_by_length: left
            .map(|state| state[at::R] * ship.lpp_m() / horizontal_speed(state)),
    };
    Ok(PullOut { track, metrics })
}

struct PullOutHelm {
    steady: SteadyDetector,
    most_s: f64,
    /// Time at which the rudder was put amidships, s, and the yaw rate at that time, rad/s.
    released: Option<(f64, f64)>,
    /// Steady state after that.
    ended: Option<StateVector>,
}

impl PullOutHelm {
    fn rudder_deg(&mut self, t_s: f64, state: &StateVector, turn_deg: f64) -> Option<f64> {
        if self.ended.is_some() {
            return None;
        }
        let steady = self.steady.is_steady(state);
        // A turn that does not become steady in the allowed time is released as it is.
        match self.released {
            None if steady || t_s >= self.most_s => {
                self.released = Some((t_s, state[at::R]));
                self.steady.clear_history();
                Some(0.0)
            }
            None => Some(turn_deg),
            // Steady after the release: the run ends at the next step.
            Some(_) if steady => {
                self.ended = Some(*state);
                Some(0.0)
            }
            Some((since_s, _)) => (t_s - since_s < self.most_s).then_some(0.0),
        }
    }
}
