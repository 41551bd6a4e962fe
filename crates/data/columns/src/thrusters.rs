//! Two commands of thrusters that steer by their difference.

use crate::hypothesis::Assignment;
use crate::outcome::ThrusterPair;
use crate::own_evidence::OwnEvidence;
use crate::role::{Role, Side};
use crate::rudder::lagged_correlation;
use crate::signals::RecordingSignals;

/// Name of thruster commands in the vocabulary.
const NAME: &str = "thruster command";

/// Finds the pair among columns whose headers name a thruster command of either side.
pub(crate) fn find_thrusters(
    own: &[OwnEvidence],
    signals: &RecordingSignals,
    of: &Assignment,
) -> Option<ThrusterPair> {
    let on = |side: Side| {
        own.iter().position(|one| {
            let named = one.header.other_quantity().is_some_and(|(name, _)| name == NAME);
            named && one.header.side == Some(side) && one.summary.spread > 0.0
        })
    };
    let (port, starboard) = (on(Side::Port)?, on(Side::Starboard)?);
    let (left, right) = (&signals.continuous[port], &signals.continuous[starboard]);
    let difference: Vec<f64> = left.iter().zip(right).map(|(a, b)| a - b).collect();
    let mean: Vec<f64> = left.iter().zip(right).map(|(a, b)| 0.5 * (a + b)).collect();
    // Correlation with the canonical sign of the other column, at the best lag.
    let with = |role: Role, values: &[f64]| {
        let (at, factor) = of.find(role)?;
        Some(factor.signum() * lagged_correlation(values, &signals.continuous[at]))
    };
    let yaw = [&difference, &mean].map(|values| with(Role::R, values).unwrap_or(0.0));
    let speed = [&difference, &mean].map(|values| with(Role::U, values).unwrap_or(0.0));
    // If one side has the opposite sign, the sum steers.
    let is_opposed = yaw[1].abs() > yaw[0].abs() && speed[0].abs() > speed[1].abs();
    let (steers, drives) = if is_opposed { (1, 0) } else { (0, 1) };
    Some(ThrusterPair {
        columns: (port, starboard),
        is_opposed,
        yaw_correlation: yaw[steers],
        speed_correlation: speed[drives],
    })
}
