//! Simulated tracks: their length limit and their columns.

use serde_json::{Value, json};
use sistership_simulation::state::at;
use sistership_simulation::{Ship, Trajectory};

use crate::budget::try_reserve_for_request;
use crate::predictions::error::{PredictionError, Result};

/// Longest step of the integration, s.
pub(super) const STEP_S: f64 = 0.1;

/// Checks that a number is positive and finite.
pub(super) fn check_positive(field: &str, value: f64) -> Result<f64> {
    match value > 0.0 && value.is_finite() {
        true => Ok(value),
        false => {
            Err(PredictionError::invalid_field(field, format!("must be above 0, not {value}")))
        }
    }
}

/// Memory of a sample of a track until it is answered, bytes: 15 numbers simulated, 11 as JSON
/// values of 32 bytes, and their text of about 20 bytes each.
const SAMPLE_BYTES: u64 = 15 * 8 + 11 * (32 + 20);

/// Reserves the memory of a simulation; refuses more steps than are allowed.
pub(super) fn reserve_steps(field: &str, steps: f64, most: usize) -> Result<()> {
    match steps <= most as f64 {
        true => Ok(try_reserve_for_request(SAMPLE_BYTES * steps.max(0.0).ceil() as u64)?),
        false => Err(PredictionError::invalid_field(
            field,
            format!(
                "needs {steps:.0} steps, but at most {most} are possible: give a higher speed or \
                 a shorter time"
            ),
        )),
    }
}

/// Canonical columns with their index in the state vector.
pub(super) const STATE_COLUMNS: [(&str, usize); 9] = [
    ("x_m", at::X),
    ("y_m", at::Y),
    ("psi_rad", at::PSI),
    ("u_m_s", at::U),
    ("v_m_s", at::V),
    ("r_rad_s", at::R),
    ("phi_rad", at::PHI),
    ("p_rad_s", at::P),
    ("delta_rad", at::DELTA),
];

/// Adds the share of the learned correction along the track to an answer, if the ship has one.
pub(super) fn with_share(mut answer: Value, ship: &Ship, track: &Trajectory) -> Value {
    if let Some(share) = ship.mean_correction_share(track) {
        // Omitted without a learned correction.
        answer["branch_share"] = json!(share);
    }
    answer
}

/// Returns a track column by column.
pub(super) fn track_columns(track: &Trajectory) -> Value {
    let mut columns = json!({ "t_s": track.t_s, "n_rps": track.n_rps });
    for (name, index) in STATE_COLUMNS {
        columns[name] = json!(track.state_column(index));
    }
    columns
}
