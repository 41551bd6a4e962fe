//! Pull-out test: MSC/Circ.1053, appendix 4, 5; ITTC 7.5-04-02-01.

use serde::{Deserialize, Serialize};

/// Metrics of the motion after the rudder was put amidships out of a turn to one side.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PullOutMetrics {
    /// Rudder of the turn, deg, positive to starboard.
    pub rudder_deg: f64,
    /// Yaw rate of the turn when the rudder was put amidships, deg/s.
    pub turning_rate_deg_s: f64,
    /// Residual yaw rate, deg/s; absent if it had not become steady when the run ended.
    pub residual_rate_deg_s: Option<f64>,
    /// The same in units of speed over length at the end.
    pub residual_rate_by_length: Option<f64>,
}

/// Smallest difference of non-dimensional yaw rates that can be distinguished: a turn of a radius
/// of a thousand lengths.
const RATE_RESOLUTION: f64 = 1e-3;
/// Non-dimensional yaw rate of a turn of a radius of a hundred lengths: below it the course is
/// straight.
const STRAIGHT_RATE: f64 = 1e-2;

/// Returns true if a ship is stable on a straight course: after turns to both sides it runs
/// straight. `None` if one side was not simulated or did not become steady, or if both sides end in
/// the same turn: an asymmetric ship runs straight at another rudder angle than amidships, and only
/// spirals show its stability there.
pub fn is_straight_line_stable(pull_outs: &[PullOutMetrics]) -> Option<bool> {
    let side = |starboard: bool| {
        let of = |one: &&PullOutMetrics| (one.rudder_deg > 0.0) == starboard;
        pull_outs.iter().find(of)?.residual_rate_by_length
    };
    let (starboard, port) = (side(true)?, side(false)?);
    // Both sides end in different turns: the straight course between them is unstable.
    match (starboard - port).abs() < 2.0 * RATE_RESOLUTION {
        false => Some(false),
        true => (starboard.abs().max(port.abs()) < STRAIGHT_RATE).then_some(true),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn left(rudder_deg: f64, rate: Option<f64>) -> PullOutMetrics {
        PullOutMetrics {
            rudder_deg,
            turning_rate_deg_s: 1.0,
            residual_rate_deg_s: rate,
            residual_rate_by_length: rate,
        }
    }

    #[test]
    fn both_sides_must_end_alike() {
        let stable = |a, b| is_straight_line_stable(&[left(20.0, a), left(-20.0, b)]);
        assert_eq!(stable(Some(0.0), Some(0.0)), Some(true));
        assert_eq!(stable(Some(0.005), Some(0.0051)), Some(true));
        assert_eq!(stable(Some(0.15), Some(0.15)), None, "spirals tell");
        assert_eq!(stable(Some(0.2), Some(-0.2)), Some(false));
        assert_eq!(stable(Some(0.2), None), None);
        assert_eq!(is_straight_line_stable(&[left(20.0, Some(0.0))]), None);
    }
}
