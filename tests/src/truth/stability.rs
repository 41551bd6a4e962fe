//! Whether a ship keeps a straight line with the rudder amidships.

use sistership_simulation::state::{at, straight_state};

use super::motion::{STEP_S, Truth, step};

/// First disturbance of the yaw rate by `U/L`: small, so that only what is linear counts.
const DISTURBANCE: f64 = 1e-7;
/// How long the ship is sailed, in lengths; the first part is left to what dies away.
const LENGTHS: [f64; 2] = [15.0, 30.0];

/// Growth rate of a small yaw rate with the rudder held amidships, by `U/L`: negative for a ship
/// that is straight-line stable.
pub fn growth_rate(ship: &dyn Truth) -> f64 {
    let (size, n_rps) = (ship.dimensions(), ship.revolutions_rps());
    let mut state = straight_state(size.speed_m_s);
    state[at::R] = DISTURBANCE / size.length_time_s();
    let mut yaw = [0.0; 2];
    for (after, lengths) in yaw.iter_mut().zip([LENGTHS[0], LENGTHS[1] - LENGTHS[0]]) {
        for _ in 0..(lengths * size.length_time_s() / STEP_S).round() as usize {
            state = step(ship, &state, 0.0, n_rps);
        }
        *after = state[at::R].hypot(state[at::V] / size.lpp_m);
    }
    (yaw[1] / yaw[0]).ln() / (LENGTHS[1] - LENGTHS[0])
}
