//! Detection of a steady motion.

use std::collections::VecDeque;

use super::ManoeuvreSettings;
use crate::ship::Ship;
use crate::state::{StateVector, at, horizontal_speed};

/// Largest change of the yaw rate of a steady motion during the time length over speed, in units of
/// one radian in that time. The remainder of a motion that decays with a time constant of T'
/// lengths is T' times the change: below the resolution of rates, a thousandth, even for a T' of
/// 100.
const RATE_CHANGE: f64 = 1e-5;
/// The same for the speed, relative to that of the approach: within a hundredth for a T' of 100.
const SPEED_CHANGE: f64 = 1e-4;

/// Default step in units of length over speed: a steady motion does not depend on it.
const DEFAULT_STEP: f64 = 0.05;

/// Settings of a simulation of which only the steady end is used.
pub(super) fn steady_settings(
    settings: &ManoeuvreSettings,
    ship: &Ship,
    duration_s: f64,
) -> ManoeuvreSettings {
    let step_s =
        settings.step_s.unwrap_or(DEFAULT_STEP * ship.lpp_m() / settings.approach_speed(ship));
    let (duration_s, step_s) = (Some(duration_s), Some(step_s));
    ManoeuvreSettings { duration_s, step_s, run_in_s: 0.0, ..*settings }
}

/// Detector of a steady motion, step by step.
pub(super) struct SteadyDetector {
    /// Non-dimensional yaw rate and speed during the last time of length over speed.
    seen: VecDeque<[f64; 2]>,
    steps: usize,
    length_s: f64,
    speed_m_s: f64,
}

impl SteadyDetector {
    /// Creates a detector for an approach speed, m/s, and a step, s.
    pub fn new(ship: &Ship, speed_m_s: f64, step_s: f64) -> Self {
        let length_s = ship.lpp_m() / speed_m_s;
        let steps = (length_s / step_s).ceil().max(1.0) as usize;
        Self { seen: VecDeque::with_capacity(steps + 1), steps, length_s, speed_m_s }
    }

    /// Discards the history.
    pub fn clear_history(&mut self) {
        self.seen.clear();
    }

    /// Adds a state; returns true if the motion is steady.
    pub fn is_steady(&mut self, state: &StateVector) -> bool {
        let now = [state[at::R] * self.length_s, horizontal_speed(state) / self.speed_m_s];
        self.seen.push_back(now);
        // The window of one length over speed must be full first.
        if self.seen.len() <= self.steps {
            return false;
        }
        let before = self.seen.pop_front().unwrap_or(now);
        (now[0] - before[0]).abs() < RATE_CHANGE && (now[1] - before[1]).abs() < SPEED_CHANGE
    }
}
