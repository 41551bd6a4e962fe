//! Turning circle test: ITTC 7.5-04-02-01, section on turning tests.

use serde::{Deserialize, Serialize};

use crate::state::{StateVector, Trajectory, at, horizontal_speed};

/// Metrics of a turning circle, measured from the execution of the rudder. Lengths are positive
/// towards the side of the turn.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TurningMetrics {
    /// Ordered rudder angle, deg, positive to starboard.
    pub rudder_deg: f64,
    /// Distance along the first heading until the heading has changed by 90 deg, m.
    pub advance_m: Option<f64>,
    /// Distance across the first heading until the heading has changed by 90 deg, m.
    pub transfer_m: Option<f64>,
    /// Distance across the first heading until the heading has changed by 180 deg, m.
    pub tactical_diameter_m: Option<f64>,
    /// Speed over yaw rate at the end, m.
    pub steady_radius_m: Option<f64>,
    /// Largest distance along the first heading, m.
    pub max_advance_m: f64,
    /// Largest distance across the first heading, m.
    pub max_transfer_m: f64,
    /// Speed at the execution less speed at the end, m/s.
    pub speed_loss_m_s: f64,
}

impl TurningMetrics {
    /// Evaluates a track that starts at the execution of the rudder; `None` for an empty track.
    pub fn from_track(track: &Trajectory, rudder_deg: f64) -> Option<Self> {
        let (first, last) = (track.states.first()?, track.last()?);
        let seen = TurnFrame::new(first, rudder_deg);
        let along = |state: &StateVector| seen.distance_along(state);
        let across = |state: &StateVector| seen.distance_across(state);
        let largest = |of: &dyn Fn(&StateVector) -> f64| {
            track.states.iter().map(of).fold(f64::NEG_INFINITY, f64::max)
        };
        let rate = last[at::R].abs();
        Some(Self {
            rudder_deg,
            advance_m: seen.value_at_turn(track, 90.0, &along),
            transfer_m: seen.value_at_turn(track, 90.0, &across),
            tactical_diameter_m: seen.value_at_turn(track, 180.0, &across),
            // A motion without yaw has no radius.
            steady_radius_m: (rate > 1e-9).then(|| horizontal_speed(last) / rate),
            max_advance_m: largest(&along),
            max_transfer_m: largest(&across),
            speed_loss_m_s: horizontal_speed(first) - horizontal_speed(last),
        })
    }
}

/// Returns the distance along the track until the heading has changed by `change_deg`, m; with 10
/// deg of rudder and of change this is IMO's initial turning ability.
pub fn initial_turning_distance(
    track: &Trajectory,
    rudder_deg: f64,
    change_deg: f64,
) -> Option<f64> {
    let first = track.states.first()?;
    // Cumulative distance along the track.
    let mut sailed = vec![0.0];
    for pair in track.states.windows(2) {
        let leg = (pair[1][at::X] - pair[0][at::X]).hypot(pair[1][at::Y] - pair[0][at::Y]);
        sailed.push(sailed[sailed.len() - 1] + leg);
    }
    let (k, w) = TurnFrame::new(first, rudder_deg).heading_crossing(track, change_deg)?;
    Some(sailed[k - 1] + w * (sailed[k] - sailed[k - 1]))
}

/// Coordinates with the origin and the first heading of the turn.
struct TurnFrame {
    origin: StateVector,
    side: f64,
}

impl TurnFrame {
    fn new(origin: &StateVector, rudder_deg: f64) -> Self {
        Self { origin: *origin, side: if rudder_deg < 0.0 { -1.0 } else { 1.0 } }
    }

    fn offset_from_origin(&self, state: &StateVector) -> (f64, f64) {
        (state[at::X] - self.origin[at::X], state[at::Y] - self.origin[at::Y])
    }

    fn distance_along(&self, state: &StateVector) -> f64 {
        let (x, y) = self.offset_from_origin(state);
        let (sin, cos) = self.origin[at::PSI].sin_cos();
        x * cos + y * sin
    }

    fn distance_across(&self, state: &StateVector) -> f64 {
        let (x, y) = self.offset_from_origin(state);
        let (sin, cos) = self.origin[at::PSI].sin_cos();
        self.side * (y * cos - x * sin)
    }

    /// Returns the sample at which the heading has changed by an angle, and the fraction of the
    /// step before it.
    fn heading_crossing(&self, track: &Trajectory, change_deg: f64) -> Option<(usize, f64)> {
        let turned = |state: &StateVector| {
            self.side * (state[at::PSI] - self.origin[at::PSI]) - change_deg.to_radians()
        };
        let k = track.states.iter().position(|state| turned(state) >= 0.0).filter(|&k| k > 0)?;
        let (before, after) = (turned(&track.states[k - 1]), turned(&track.states[k]));
        // Linear interpolation between the samples before and after the crossing.
        Some((k, before / (before - after)))
    }

    fn value_at_turn(
        &self,
        track: &Trajectory,
        change_deg: f64,
        of: &dyn Fn(&StateVector) -> f64,
    ) -> Option<f64> {
        let (k, w) = self.heading_crossing(track, change_deg)?;
        let (before, after) = (of(&track.states[k - 1]), of(&track.states[k]));
        Some(before + w * (after - before))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const RADIUS: f64 = 250.0;

    /// A circle that begins off the origin on a course of 0.4 rad, in uneven steps; the speed falls
    /// from 8 m/s by 0.5 m/s in a radian.
    fn circle(side: f64) -> Trajectory {
        let (sin, cos) = 0.4_f64.sin_cos();
        let mut track = Trajectory::default();
        let mut turned = 0.0_f64;
        for k in 0..400 {
            let (along, across) = (RADIUS * turned.sin(), side * RADIUS * (1.0 - turned.cos()));
            let mut state = StateVector::zeros();
            state[at::U] = 8.0 - 0.5 * turned;
            state[at::R] = side * state[at::U] / RADIUS;
            state[at::PSI] = 0.4 + side * turned;
            state[at::X] = 70.0 + along * cos - across * sin;
            state[at::Y] = -30.0 + along * sin + across * cos;
            track.push(f64::from(k), state, 1.5);
            turned += if k % 2 == 0 { 0.007 } else { 0.013 };
        }
        track
    }

    /// The chord of a step of 0.013 rad is 3e-5 of the radius from its arc at most.
    fn assert_near(own: Option<f64>, exact: f64) {
        assert!((own.unwrap() - exact).abs() < 3e-5 * RADIUS, "{own:?} not {exact}");
    }

    #[test]
    fn a_circle_has_the_metrics_of_its_radius() {
        for side in [1.0, -1.0] {
            let track = circle(side);
            let turn = TurningMetrics::from_track(&track, 35.0 * side).unwrap();
            assert_eq!(turn.rudder_deg, 35.0 * side);
            assert_near(turn.advance_m, RADIUS);
            assert_near(turn.transfer_m, RADIUS);
            assert_near(turn.tactical_diameter_m, 2.0 * RADIUS);
            assert_near(turn.steady_radius_m, RADIUS);
            assert_near(Some(turn.max_advance_m), RADIUS);
            assert_near(Some(turn.max_transfer_m), 2.0 * RADIUS);
            let turned = (track.last().unwrap()[at::PSI] - 0.4).abs();
            assert!((turn.speed_loss_m_s - 0.5 * turned).abs() < 1e-12, "{turn:?}");
            let initial = initial_turning_distance(&track, 35.0 * side, 10.0);
            assert_near(initial, RADIUS * 10_f64.to_radians());
        }
    }

    #[test]
    fn what_a_track_does_not_reach_is_unknown() {
        let mut track = circle(1.0);
        track.states.truncate(170);
        let turn = TurningMetrics::from_track(&track, 35.0).unwrap();
        assert!(turn.advance_m.is_some() && turn.tactical_diameter_m.is_none(), "{turn:?}");
        // Turned to the other side it has not changed its heading yet.
        assert_eq!(initial_turning_distance(&track, -35.0, 10.0), None);
        track.states.iter_mut().for_each(|state| state[at::R] = 0.0);
        assert_eq!(TurningMetrics::from_track(&track, 35.0).unwrap().steady_radius_m, None);
        assert_eq!(TurningMetrics::from_track(&Trajectory::default(), 35.0), None);
    }
}
