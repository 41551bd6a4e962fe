//! When a motion has become steady.

use std::collections::VecDeque;

use super::ManoeuvreSettings;
use crate::ship::Ship;
use crate::state::{StateVector, at, speed};

/// A yaw rate is steady where it changes by less than this in the time in which the ship sails its
/// length, by the rate of one radian in that time. What is left of a motion that dies down with a
/// time constant of T' lengths is T' times that: below the thousandth by which rates are read even
/// for a T' of 100.
const RATE_CHANGE: f64 = 1e-5;
/// The same for the speed, by that of the approach: within a hundredth for a T' of 100.
const SPEED_CHANGE: f64 = 1e-4;

/// Step by the time in which the ship sails its length, where nobody asks for another: a steady
/// motion does not depend on it.
const STEP: f64 = 0.05;

/// Settings for a motion of which only the steady end counts.
pub(super) fn to_the_end(
    settings: &ManoeuvreSettings,
    ship: &Ship,
    duration_s: f64,
) -> ManoeuvreSettings {
    let step_s = settings.step_s.unwrap_or(STEP * ship.lpp_m() / settings.speed(ship));
    let (duration_s, step_s) = (Some(duration_s), Some(step_s));
    ManoeuvreSettings { duration_s, step_s, run_in_s: 0.0, ..*settings }
}

/// Watches a motion step by step.
pub(super) struct Steady {
    /// Yaw rate and speed, without dimension, over the time in which the ship sails its length.
    seen: VecDeque<[f64; 2]>,
    steps: usize,
    length_s: f64,
    speed_m_s: f64,
}

impl Steady {
    /// For a ship that approaches at a speed, m/s, and steps of so many seconds.
    pub fn new(ship: &Ship, speed_m_s: f64, step_s: f64) -> Self {
        let length_s = ship.lpp_m() / speed_m_s;
        let steps = (length_s / step_s).ceil().max(1.0) as usize;
        Self { seen: VecDeque::with_capacity(steps + 1), steps, length_s, speed_m_s }
    }

    /// Begins anew.
    pub fn restart(&mut self) {
        self.seen.clear();
    }

    /// Takes note of a state; whether the motion is steady.
    pub fn is_steady(&mut self, state: &StateVector) -> bool {
        let now = [state[at::R] * self.length_s, speed(state) / self.speed_m_s];
        self.seen.push_back(now);
        if self.seen.len() <= self.steps {
            return false;
        }
        let before = self.seen.pop_front().unwrap_or(now);
        (now[0] - before[0]).abs() < RATE_CHANGE && (now[1] - before[1]).abs() < SPEED_CHANGE
    }
}
