//! Response of a craft to small angles on a straight course, by differences of its own rates.

use nalgebra::{Matrix2, Vector2};
use sistership_assessment::course::response_figures;
use sistership_simulation::state::at;

use super::craft::Craft;
use super::motion::{Motion, SHAFTS};

/// Disturbance: drift and angle in rad, yaw rate by `U/L`.
const DISTURBANCE: f64 = 0.01;

/// Nomoto's `K'` and `T'`, the larger eigenvalue of sway and yaw, and the yaw acceleration by the
/// angle, in units of length and speed. Engines hold their revolutions and roll is upright.
pub fn straight_response(craft: &Craft) -> [f64; 4] {
    let (speed, time) = (craft.size().speed_m_s, craft.size().length_time_s());
    let n_rps = [craft.balanced_rps(speed); SHAFTS];
    let rates = |v: f64, r: f64, angle: f64| {
        let mut motion = Motion::straight(speed, n_rps);
        motion.body[at::V] = v * speed;
        motion.body[at::R] = r / time;
        motion.body[at::DELTA] = angle;
        let rate = craft.rate(&motion, &craft.orders_at(n_rps[0], angle)).body;
        Vector2::new(rate[at::V] * time / speed, rate[at::R] * time * time)
    };
    let slope = |v: f64, r: f64, angle: f64| {
        (rates(v, r, angle) - rates(-v, -r, -angle)) / (2.0 * DISTURBANCE)
    };
    let [by_sway, by_yaw] = [slope(DISTURBANCE, 0.0, 0.0), slope(0.0, DISTURBANCE, 0.0)];
    let by_angle = slope(0.0, 0.0, DISTURBANCE);
    response_figures(&Matrix2::from_columns(&[by_sway, by_yaw]), &by_angle)
}
