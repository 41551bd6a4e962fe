//! Full astern stopping test.

use super::ManoeuvreSettings;
use super::reversing::{ReversingError, check_reversing};
use crate::envelope::SimulationStop;
use crate::metrics::StoppingMetrics;
use crate::ship::{HelmOrder, Ship};
use crate::state::{StateVector, Trajectory, at, straight_state};
use sistership_model::Model;
use sistership_model::law::Law;

/// Order to the engine in a stopping test.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AsternOrder {
    /// Revolutions astern, 1/s, as a positive number; default: those ahead.
    pub astern_rps: Option<f64>,
    /// Duration of the linear change from revolutions ahead to those astern, s.
    pub reversal_s: f64,
}

/// Simulated stopping test.
#[derive(Debug, Clone)]
pub struct StoppingTest {
    /// Track.
    pub track: Trajectory,
    /// Metrics.
    pub metrics: StoppingMetrics,
}

/// Reason for which there is no stopping test.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StoppingError {
    /// The model does not cover a reversed propeller.
    #[error("not supported by this model: {0}")]
    NotReversing(#[from] ReversingError),
    /// The motion left the physical range.
    #[error(transparent)]
    Stopped(#[from] SimulationStop),
}

/// Longest duration of a run in units of length over speed: a ship that meets the criterion of 15
/// lengths needs about twice as many, because its mean speed is half.
const MAX_LENGTHS: f64 = 120.0;

/// Simulates a full astern stopping test with the rudder amidships.
///
/// # Errors
/// Returns an error if the model does not cover a reversed propeller, or with time and reason if
/// the motion left the physical range.
pub fn simulate_stop(
    model: &Model,
    law: &Law,
    ship: &Ship,
    settings: &ManoeuvreSettings,
    order: AsternOrder,
) -> Result<StoppingTest, StoppingError> {
    check_reversing(model, law, ship)?;
    let ahead_rps = settings.engine_order(ship).n_rps;
    let astern_rps = -order.astern_rps.unwrap_or(ahead_rps);
    let speed = settings.approach_speed(ship);
    let longest_s = MAX_LENGTHS * ship.lpp_m() / speed + order.reversal_s;
    let duration_s = Some(settings.duration_s.unwrap_or(longest_s));
    let run = ManoeuvreSettings { duration_s, run_in_s: 0.0, ..*settings };
    let mut track = Trajectory::default();
    let mut ended = false;
    ship.simulate_orders(
        run.run_settings(ship, straight_state(speed)),
        &mut track,
        |t_s, state: &StateVector| {
            // The state at which a run ends is not kept, so that the run goes one step beyond the stop.
            let going = !std::mem::replace(&mut ended, state[at::U] <= 0.0);
            let part = if order.reversal_s > 0.0 { (t_s / order.reversal_s).min(1.0) } else { 1.0 };
            let n_rps = ahead_rps + part * (astern_rps - ahead_rps);
            going.then_some(HelmOrder { delta_rad: 0.0, n_rps })
        },
    )?;
    let metrics = StoppingMetrics::from_track(&track, astern_rps, order.reversal_s);
    let nothing = || SimulationStop { t_s: 0.0, reason: "no manoeuvre was simulated".into() };
    Ok(StoppingTest { metrics: metrics.ok_or_else(nothing)?, track })
}
