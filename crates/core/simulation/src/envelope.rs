//! Range in which a simulation is trusted: outside of it a run stops with a reason, never with
//! infinities.

use sistership_model::{Model, particulars};

use crate::state::{StateVector, at, horizontal_speed};

/// Limits of the speed, yaw rate and roll angle of a ship.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionEnvelope {
    speed_m_s: f64,
    yaw_rate_rad_s: f64,
    roll_rad: f64,
}

/// Reason and time at which a simulation was stopped.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("stopped at {t_s:.1} s: {reason}")]
pub struct SimulationStop {
    /// Time of the stop, s.
    pub t_s: f64,
    /// Description of the quantity that left the physical range.
    pub reason: String,
}

impl MotionEnvelope {
    /// Creates the limits for a ship of length `lpp_m` that approaches at `approach_speed_m_s`:
    /// three times that speed (at least a Froude number of 0.1), a yaw rate of six times speed over
    /// length, 80 degrees of roll.
    pub fn new(lpp_m: f64, approach_speed_m_s: f64) -> Self {
        // The lower limit of the Froude number applies to ships that start at rest or very slowly.
        let reference = approach_speed_m_s.abs().max(0.1 * (9.806_65 * lpp_m).sqrt());
        Self {
            speed_m_s: 3.0 * reference,
            yaw_rate_rad_s: 6.0 * reference / lpp_m,
            roll_rad: 80_f64.to_radians(),
        }
    }

    /// Returns the limits of the ship of a model; `None` if it gives no length or no approach
    /// speed.
    pub fn from_model(model: &Model) -> Option<Self> {
        let value = |name: &str| particulars::particular_value(&model.particulars, name);
        Some(Self::new(value("lpp_m")?, model.speed_m_s.or(value("service_speed_m_s"))?))
    }

    /// Greatest speed, m/s.
    pub fn speed_m_s(&self) -> f64 {
        self.speed_m_s
    }

    /// Greatest yaw rate, rad/s.
    pub fn yaw_rate_rad_s(&self) -> f64 {
        self.yaw_rate_rad_s
    }

    /// Greatest roll angle, rad.
    pub fn roll_rad(&self) -> f64 {
        self.roll_rad
    }

    /// Checks that a state lies within the limits.
    ///
    /// # Errors
    /// Returns an error that names the quantity outside the range.
    pub fn check_state(&self, t_s: f64, state: &StateVector) -> Result<(), SimulationStop> {
        let stop = |reason: String| Err(SimulationStop { t_s, reason });
        if state.iter().any(|value| !value.is_finite()) {
            return stop("the state is not finite any more".into());
        }
        if horizontal_speed(state) > self.speed_m_s {
            return stop(format!(
                "speed {} m/s exceeds {:.2} m/s",
                format_magnitude(horizontal_speed(state)),
                self.speed_m_s
            ));
        }
        if state[at::R].abs() > self.yaw_rate_rad_s {
            let limit = self.yaw_rate_rad_s.to_degrees();
            return stop(format!(
                "yaw rate {} deg/s exceeds {limit:.2} deg/s",
                format_magnitude(state[at::R].to_degrees())
            ));
        }
        if state[at::PHI].abs() > self.roll_rad {
            return stop(format!(
                "roll {:.0} deg: the ship has capsized",
                state[at::PHI].to_degrees()
            ));
        }
        Ok(())
    }
}

/// Formats a number of any size: a diverged motion may have reached huge values.
fn format_magnitude(value: f64) -> String {
    if value.abs() < 1e4 { format!("{value:.2}") } else { format!("{value:.1e}") }
}
