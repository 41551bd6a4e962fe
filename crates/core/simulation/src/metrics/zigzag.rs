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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::state::StateVector;

    /// Headings of straight legs between these times (s) and changes (deg), once a second.
    fn track(side: f64, corners: &[(f64, f64)]) -> Trajectory {
        let mut track = Trajectory::default();
        for pair in corners.windows(2) {
            let [(from, start), (until, end)] = [pair[0], pair[1]];
            for t in from as usize..until as usize {
                let done = (t as f64 - from) / (until - from);
                let mut state = StateVector::zeros();
                state[at::PSI] = 1.2 + side * (start + done * (end - start)).to_radians();
                track.push(t as f64, state, 1.5);
            }
        }
        track
    }

    const SWINGS: [(f64, f64); 5] =
        [(0.0, 0.0), (30.0, 15.0), (70.0, -18.0), (110.0, 14.0), (120.0, 10.0)];
    const REVERSALS: [f64; 3] = [20.0, 60.0, 104.0];

    #[test]
    fn swings_beyond_the_angle_are_overshoots_to_both_sides() {
        for side in [1.0, -1.0] {
            let track = track(side, &SWINGS);
            let zigzag = ZigzagMetrics::from_track(&track, side * 10.0, 10.0, &REVERSALS).unwrap();
            assert!((zigzag.first_overshoot_deg.unwrap() - 5.0).abs() < 1e-9, "{zigzag:?}");
            assert!((zigzag.second_overshoot_deg.unwrap() - 8.0).abs() < 1e-9, "{zigzag:?}");
            assert_eq!(zigzag.initial_turning_time_s, Some(20.0));
            assert_eq!(zigzag.period_s, Some(84.0));
        }
    }

    /// A heading that still grows at the end has no overshoot, a reversal that is missing no period.
    #[test]
    fn what_a_track_does_not_reach_is_unknown() {
        let ended = track(1.0, &SWINGS[..3]);
        let zigzag = ZigzagMetrics::from_track(&ended, 10.0, 10.0, &REVERSALS[..2]).unwrap();
        assert!((zigzag.first_overshoot_deg.unwrap() - 5.0).abs() < 1e-9, "{zigzag:?}");
        assert_eq!((zigzag.second_overshoot_deg, zigzag.period_s), (None, None));
        assert_eq!(ZigzagMetrics::from_track(&Trajectory::default(), 10.0, 10.0, &[]), None);
    }
}
