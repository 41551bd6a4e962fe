//! Zigzag test: ITTC 7.5-04-02-01, section on zigzag tests.

use serde::{Deserialize, Serialize};

use crate::state::{Trajectory, at};

/// Metrics of a zigzag, measured from the first execution of the rudder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ZigzagMetrics {
    /// Rudder angle, deg, positive where the first execution is to starboard.
    pub rudder_deg: f64,
    /// Change of heading at which the rudder is reversed, deg.
    pub switch_deg: f64,
    /// Change of heading beyond the switching angle after the first reversal, deg.
    pub first_overshoot_deg: Option<f64>,
    /// The same after the second reversal, deg.
    pub second_overshoot_deg: Option<f64>,
    /// Time from the first execution to the first reversal (initial turning time), s.
    pub initial_turning_time_s: Option<f64>,
    /// Time between the first and the third reversal, s.
    pub period_s: Option<f64>,
}

impl ZigzagMetrics {
    /// Evaluates a track that starts at the first execution, with the times of the reversals, s.
    pub fn from_track(
        track: &Trajectory,
        rudder_deg: f64,
        switch_deg: f64,
        reversals_s: &[f64],
    ) -> Option<Self> {
        let start = track.states.first()?[at::PSI];
        let end = *track.t_s.last()?;
        let side = if rudder_deg < 0.0 { -1.0 } else { 1.0 };
        let overshoot = |index: usize| {
            let from = *reversals_s.get(index)?;
            // The last swing ends with the track.
            let until = reversals_s.get(index + 1).copied().unwrap_or(end);
            // Swings alternate between the sides.
            let side = if index.is_multiple_of(2) { side } else { -side };
            let window =
                track.t_s.iter().zip(&track.states).filter(|(t, _)| (from..=until).contains(*t));
            let swing: Vec<f64> =
                window.map(|(_, state)| side * (state[at::PSI] - start).to_degrees()).collect();
            let peak = swing.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            // The peak must lie inside: a heading still growing at the end of the record has no
            // overshoot yet.
            (swing.len() > 2 && swing.last().is_some_and(|last| *last < peak))
                .then_some(peak - switch_deg)
        };
        Some(Self {
            rudder_deg,
            switch_deg,
            first_overshoot_deg: overshoot(0),
            second_overshoot_deg: overshoot(1),
            initial_turning_time_s: reversals_s.first().copied(),
            period_s: reversals_s.get(2).map(|third| third - reversals_s[0]),
        })
    }
}
