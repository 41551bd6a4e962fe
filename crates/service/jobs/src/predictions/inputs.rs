//! Prediction under recorded rudder angles and revolutions, from a given start.

use serde::Deserialize;
use serde_json::{Value, json};
use sistership_model::trial::{Channel, Trial};
use sistership_simulation::recorded::{ReplaySettings, replay_trial};
use sistership_simulation::state::RECORDED_CHANNELS;
use sistership_simulation::{Ship, StateVector};
use utoipa::ToSchema;

use super::track::{reserve_steps, track_columns, with_share};
use crate::predictions::error::{PredictionError, Result};

/// Recorded inputs.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct InputsRequest {
    /// Times, increasing and without gaps.
    #[schema(min_items = 2)]
    t_s: Vec<f64>,
    /// Rudder angle at each time, positive to starboard.
    #[schema(min_items = 2)]
    delta_rad: Vec<f64>,
    /// Propeller revolutions at each time; by default those of steady running at the first speed.
    #[schema(min_items = 2)]
    n_rps: Option<Vec<f64>>,
    /// The state at the first time.
    start: InitialState,
}

/// State of motion; a value that is not given is 0.
#[derive(Debug, Clone, Copy, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct InitialState {
    u_m_s: f64,
    #[serde(default)]
    v_m_s: f64,
    #[serde(default)]
    r_rad_s: f64,
    #[serde(default)]
    psi_rad: f64,
    #[serde(default)]
    x_m: f64,
    #[serde(default)]
    y_m: f64,
    #[serde(default)]
    phi_rad: f64,
    #[serde(default)]
    p_rad_s: f64,
}

impl InitialState {
    /// Returns the state vector, with the rudder amidships.
    pub(super) fn to_state_vector(self) -> StateVector {
        let mut state = StateVector::zeros();
        for ((_, value), (_, place)) in self.channel_values().into_iter().zip(RECORDED_CHANNELS) {
            state[place] = value;
        }
        state
    }

    /// Values by channel, in the order of [`RECORDED`].
    fn channel_values(&self) -> [(Channel, f64); 8] {
        [
            (Channel::U, self.u_m_s),
            (Channel::V, self.v_m_s),
            (Channel::R, self.r_rad_s),
            (Channel::Psi, self.psi_rad),
            (Channel::X, self.x_m),
            (Channel::Y, self.y_m),
            (Channel::Phi, self.phi_rad),
            (Channel::P, self.p_rad_s),
        ]
    }
}

impl InputsRequest {
    pub(super) fn simulate_inputs(&self, ship: &mut Ship, most: usize) -> Result<Value> {
        let trial = self.to_trial(ship)?;
        let settings = ReplaySettings::default();
        // Each recorded time ends a step, so the number of steps is at most that of both grids
        // together.
        reserve_steps(
            "inputs.t_s",
            trial.duration_s() / settings.step_s + trial.len() as f64,
            most,
        )?;
        // The physical range is relative to the speed at the start.
        ship.set_envelope_speed(self.start.u_m_s.hypot(self.start.v_m_s));
        let run = replay_trial(ship, &trial, &settings)
            .map_err(|error| PredictionError::invalid_field("inputs", error.to_string()))?;
        let stopped =
            run.stopped.map(|stopped| json!({ "t_s": stopped.t_s, "reason": stopped.reason }));
        let answer = json!({ "metrics": null, "trajectory": track_columns(&run.track),
            "stopped": stopped, "outside": run.outside });
        Ok(with_share(answer, ship, &run.track))
    }

    /// Returns the inputs as a trial that starts at the requested state.
    fn to_trial(&self, ship: &Ship) -> Result<Trial> {
        let count = self.t_s.len();
        // Only the first value of the constant motion channels is read: it starts the simulation.
        let steady = || vec![ship.revolutions_at(self.start.u_m_s.hypot(self.start.v_m_s)); count];
        let n = self.n_rps.clone().unwrap_or_else(steady);
        for (field, values) in [("inputs.delta_rad", &self.delta_rad), ("inputs.n_rps", &n)] {
            if values.len() != count {
                return Err(PredictionError::invalid_field(
                    field,
                    format!("has {} values, but `t_s` has {count}", values.len()),
                ));
            }
        }
        let mut trial = Trial { name: "inputs".into(), t_s: self.t_s.clone(), ..Trial::default() };
        trial.channels.extend(
            self.start.channel_values().map(|(channel, value)| (channel, vec![value; count])),
        );
        trial.channels.extend([(Channel::Delta, self.delta_rad.clone()), (Channel::N, n)]);
        ship.set_actuators(&mut trial);
        check_times(&trial)?;
        Ok(trial)
    }
}

fn check_times(trial: &Trial) -> Result<()> {
    let refuse = |message: String| Err(PredictionError::invalid_field("inputs.t_s", message));
    if trial.len() < 2 {
        return refuse("give at least two times".into());
    }
    if let Some(at) = trial.t_s.windows(2).position(|pair| pair[1] <= pair[0]) {
        return refuse(format!(
            "must increase, but value {} is {} after {}",
            at + 2,
            trial.t_s[at + 1],
            trial.t_s[at]
        ));
    }
    // The inputs are unknown over a gap, and a simulation would restart after it.
    match trial.segments().get(1) {
        Some(second) => refuse(format!(
            "has a gap before {} s; resample the inputs evenly",
            trial.t_s[second.start]
        )),
        None => Ok(()),
    }
}
