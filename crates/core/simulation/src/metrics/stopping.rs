//! Full astern stopping test: IMO MSC.137(76), annex, 5.3.4; MSC/Circ.1053, 1.2.2 and appendix 3.

use serde::{Deserialize, Serialize};

use super::ImoCriterion;
use crate::state::{StateVector, Trajectory, at};

/// Largest track reach, ship lengths: MSC.137(76), 5.3.4.
const TRACK_REACH_LIMIT: f64 = 15.0;
/// Track reach that an Administration may allow where a ship's displacement makes the limit
/// impracticable, ship lengths: ibid.
pub const TRACK_REACH_ALLOWED: f64 = 20.0;

/// Metrics of a stopping test, measured from the order to reverse until the ship is dead in the
/// water.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StoppingMetrics {
    /// Ordered revolutions astern, 1/s, below 0.
    pub astern_rps: f64,
    /// Duration of the linear change from revolutions ahead, s.
    pub reversal_s: f64,
    /// Distance along the track, m; absent if the ship did not stop.
    pub track_reach_m: Option<f64>,
    /// Distance along the first heading, m.
    pub head_reach_m: Option<f64>,
    /// Distance across the first heading, m, positive to starboard.
    pub lateral_deviation_m: Option<f64>,
    /// Change of heading, deg, positive to starboard.
    pub heading_change_deg: Option<f64>,
    /// Time until the ship is dead in the water, s.
    pub time_s: Option<f64>,
}

impl StoppingMetrics {
    /// Evaluates a track that starts at the order to reverse; `None` for an empty track.
    pub fn from_track(track: &Trajectory, astern_rps: f64, reversal_s: f64) -> Option<Self> {
        let first = track.states.first()?;
        let stopped = dead_in_the_water(track);
        let offset = |state: &StateVector| {
            let (x, y) = (state[at::X] - first[at::X], state[at::Y] - first[at::Y]);
            let (sin, cos) = first[at::PSI].sin_cos();
            (x * cos + y * sin, y * cos - x * sin)
        };
        let end = stopped.as_ref().map(|(_, state)| state);
        Some(Self {
            astern_rps,
            reversal_s,
            track_reach_m: stopped.as_ref().map(|(t_s, state)| track_length(track, *t_s, state)),
            head_reach_m: end.map(|state| offset(state).0),
            lateral_deviation_m: end.map(|state| offset(state).1),
            heading_change_deg: end.map(|state| (state[at::PSI] - first[at::PSI]).to_degrees()),
            time_s: stopped.as_ref().map(|(t_s, _)| t_s - track.t_s[0]),
        })
    }

    /// Criterion of stopping ability for a ship of length `lpp_m`, m.
    pub fn track_reach_criterion(&self, lpp_m: f64) -> ImoCriterion {
        let lengths = self.track_reach_m.map(|metres| metres / lpp_m);
        ImoCriterion::new("stopping: track reach", lengths, TRACK_REACH_LIMIT, "L")
    }
}

/// Returns the time at which the speed ahead is lost, s, and the state at that time, interpolated
/// linearly between two samples.
fn dead_in_the_water(track: &Trajectory) -> Option<(f64, StateVector)> {
    let k = track.states.iter().position(|state| state[at::U] <= 0.0).filter(|&k| k > 0)?;
    let (before, after) = (&track.states[k - 1], &track.states[k]);
    // Linear interpolation of the surge velocity to zero.
    let part = before[at::U] / (before[at::U] - after[at::U]);
    let t_s = track.t_s[k - 1] + part * (track.t_s[k] - track.t_s[k - 1]);
    Some((t_s, before + part * (after - before)))
}

/// Length of the track up to a time and the state at that time, m.
fn track_length(track: &Trajectory, until_s: f64, end: &StateVector) -> f64 {
    let states = track.states.iter().zip(&track.t_s);
    let before: Vec<&StateVector> =
        states.filter(|(_, t_s)| **t_s < until_s).map(|(state, _)| state).chain([end]).collect();
    let leg = |pair: &[&StateVector]| {
        (pair[1][at::X] - pair[0][at::X]).hypot(pair[1][at::Y] - pair[0][at::Y])
    };
    before.windows(2).map(leg).sum()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// Slows down evenly from 4 m/s to astern, on a course to the north-east.
    fn slowing() -> Trajectory {
        let mut track = Trajectory::default();
        let (sin, cos) = 45_f64.to_radians().sin_cos();
        for k in 0..60 {
            let t = f64::from(k);
            let s = 4.0 * t - 0.05 * t * t;
            let mut state = StateVector::zeros();
            state[at::U] = 4.0 - 0.1 * t;
            state[at::PSI] = 45_f64.to_radians();
            (state[at::X], state[at::Y]) = (s * cos, s * sin);
            track.push(t, state, -1.0);
        }
        track
    }

    #[test]
    fn an_even_stop_has_the_reach_of_half_speed_times_time() {
        let stop = StoppingMetrics::from_track(&slowing(), -1.0, 0.0).unwrap();
        let close = |value: Option<f64>, expected: f64| (value.unwrap() - expected).abs() < 1e-9;
        assert!(close(stop.time_s, 40.0) && close(stop.track_reach_m, 80.0), "{stop:?}");
        assert!(close(stop.head_reach_m, 80.0) && close(stop.lateral_deviation_m, 0.0));
        assert_eq!(stop.track_reach_criterion(5.0).pass, Some(false));
        assert_eq!(stop.track_reach_criterion(5.4).pass, Some(true));
    }

    #[test]
    fn a_ship_that_does_not_stop_is_neither_pass_nor_fail() {
        let mut track = slowing();
        track.states.truncate(30);
        track.t_s.truncate(30);
        let stop = StoppingMetrics::from_track(&track, -1.0, 0.0).unwrap();
        assert_eq!((stop.track_reach_m, stop.track_reach_criterion(5.0).pass), (None, None));
    }
}
