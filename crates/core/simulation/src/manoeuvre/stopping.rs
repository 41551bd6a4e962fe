//! The full astern stopping test.

use super::ManoeuvreSettings;
use super::reversing::{NotReversing, check_reversing};
use crate::envelope::Stopped;
use crate::metrics::StoppingMetrics;
use crate::ship::{Order, Ship};
use crate::state::{StateVector, Trajectory, at, straight};
use sistership_model::Model;
use sistership_model::law::Law;

/// What the engine does in a stopping test.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AsternOrder {
    /// Revolutions astern, 1/s, as a number above 0; as many as ahead where absent.
    pub astern_rps: Option<f64>,
    /// How long the revolutions take from those ahead to those astern, in proportion, s.
    pub reversal_s: f64,
}

/// A stopping test that was sailed.
#[derive(Debug, Clone)]
pub struct Stopping {
    /// Where it went.
    pub track: Trajectory,
    /// What came of it.
    pub metrics: StoppingMetrics,
}

/// Why there is no stopping test.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoStopping {
    /// The model is not told of a reversed propeller.
    #[error("not by this model: {0}")]
    NotReversing(#[from] NotReversing),
    /// It left the physical range.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

/// Runs are ended after so many times the time in which it sails its length: a ship that keeps
/// to the criterion of 15 lengths needs about twice as many, for its mean speed is half.
const MOST_LENGTHS: f64 = 120.0;

/// Sails a full astern stopping test with the rudder amidships.
///
/// # Errors
/// Says why the model cannot be stopped so, or when and why the motion left the physical range.
pub fn stop(
    model: &Model,
    law: &Law,
    ship: &Ship,
    settings: &ManoeuvreSettings,
    order: AsternOrder,
) -> Result<Stopping, NoStopping> {
    check_reversing(model, law, ship)?;
    let ahead_rps = settings.revolutions(ship);
    let astern_rps = -order.astern_rps.unwrap_or(ahead_rps);
    let speed = settings.speed(ship);
    let longest_s = MOST_LENGTHS * ship.lpp_m() / speed + order.reversal_s;
    let duration_s = Some(settings.duration_s.unwrap_or(longest_s));
    let run = ManoeuvreSettings { duration_s, run_in_s: 0.0, ..*settings };
    let mut track = Trajectory::default();
    let mut ended = false;
    ship.sail(run.run(ship, straight(speed)), &mut track, |t_s, state: &StateVector| {
        // The state at which a run ends is not kept: one step goes beyond it.
        let going = !std::mem::replace(&mut ended, state[at::U] <= 0.0);
        let part = if order.reversal_s > 0.0 { (t_s / order.reversal_s).min(1.0) } else { 1.0 };
        let n_rps = ahead_rps + part * (astern_rps - ahead_rps);
        going.then_some(Order { delta_rad: 0.0, n_rps })
    })?;
    let metrics = StoppingMetrics::of(&track, astern_rps, order.reversal_s);
    let nothing = || Stopped { t_s: 0.0, reason: "nothing was sailed".into() };
    Ok(Stopping { metrics: metrics.ok_or_else(nothing)?, track })
}
