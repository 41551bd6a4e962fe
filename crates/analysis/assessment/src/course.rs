//! Response of a ship to small rudder angles on a straight course.
//!
//! With `A` the derivatives of the rates of sway and yaw by themselves and `b` those by the rudder
//! angle, the yaw rate follows the rudder as `(b_2 s + a_21 b_1 - a_11 b_2)/(s^2 - tr A s + det A)`.
//! Nomoto's indices are `K = (a_21 b_1 - a_11 b_2)/det A` and `T = T_1 + T_2 - T_3` (Nomoto et al.
//! 1957, International Shipbuilding Progress 4, 354-370). The ship is straight-line stable if both
//! eigenvalues of `A` are negative.

use nalgebra::{Matrix2, Vector2};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use sistership_model::Model;
use sistership_model::law::Law;
use sistership_simulation::plant::PlantWorkspace;
use sistership_simulation::state::{at, straight_state};
use sistership_simulation::{Ship, StateVector};

use crate::uncertainty::{Sampling, draw_from_posterior};

/// Disturbance of the derivatives: drift and rudder angle in rad, yaw rate by `U/L`.
const DISTURBANCE: f64 = 0.01;

/// Draws of the bands.
const DRAWS: usize = 20;

/// A figure of the response with its 95 % band, all in units of ship length and approach speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CourseFigure {
    /// Its name.
    pub name: String,
    /// The estimate.
    pub value: f64,
    /// Half the width of its band of 95 %; none without a posterior.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub half_width: Option<f64>,
}

/// Dimensionless figures of the response: Nomoto's `K'` and `T'`, the larger eigenvalue, and the
/// yaw acceleration per rudder angle.
const NAMES: [&str; 4] =
    ["Nomoto's K'", "Nomoto's T'", "stability (stable below 0)", "rudder effectiveness"];

/// Quantile of 97.5 % of the normal distribution.
const NORMAL: f64 = 1.959_964;

/// Returns the figures of a model with their bands; empty if it cannot be simulated.
pub fn course_figures(model: &Model, law: &Law) -> Vec<CourseFigure> {
    let response = |model: &Model| Ship::new(model, law).ok().map(|ship| straight_response(&ship));
    let Some(own) = response(model) else { return Vec::new() };
    let sampling = Sampling { samples: DRAWS, ..Sampling::default() };
    let drawn: Vec<[f64; 4]> = draw_from_posterior(model, sampling)
        .unwrap_or_default()
        .par_iter()
        .filter_map(response)
        .collect();
    let figure = |(k, name): (usize, &str)| {
        // Draws are pairs about the estimate, and few: by their mean square, not by quantiles.
        let squares = drawn.iter().map(|one| (one[k] - own[k]).powi(2)).sum::<f64>();
        let deviation = (squares / drawn.len().max(1) as f64).sqrt();
        let half_width = (!drawn.is_empty()).then_some(NORMAL * deviation);
        CourseFigure { name: name.to_owned(), value: own[k], half_width }
    };
    NAMES.into_iter().enumerate().map(figure).collect()
}

/// The four figures of a ship at its approach.
fn straight_response(ship: &Ship) -> [f64; 4] {
    let (length, speed) = (ship.lpp_m(), ship.approach_speed_m_s());
    let time = length / speed;
    let rates = |v: f64, r: f64, delta: f64| {
        let mut state = straight_state(speed);
        (state[at::V], state[at::R]) = (v * speed, r / time);
        let n_rps = ship.revolutions_at(speed);
        dimensionless(
            &ship.rate_at(&state, delta, n_rps, &mut PlantWorkspace::default()),
            time,
            speed,
        )
    };
    let slope = |v: f64, r: f64, delta: f64| {
        (rates(v, r, delta) - rates(-v, -r, -delta)) / (2.0 * DISTURBANCE)
    };
    let by_sway = slope(DISTURBANCE, 0.0, 0.0);
    let by_yaw = slope(0.0, DISTURBANCE, 0.0);
    let by_rudder = slope(0.0, 0.0, DISTURBANCE);
    response_figures(&Matrix2::from_columns(&[by_sway, by_yaw]), &by_rudder)
}

/// Rates of sway and yaw in units of length and speed.
fn dimensionless(rate: &StateVector, time: f64, speed: f64) -> Vector2<f64> {
    Vector2::new(rate[at::V] * time / speed, rate[at::R] * time * time)
}

/// Nomoto's `K'` and `T'`, the larger eigenvalue and the yaw acceleration by the rudder angle, from
/// the derivatives of the rates of sway and yaw by themselves (`a`) and by the angle (`b`), with
/// time in units of `L/U`.
pub fn response_figures(a: &Matrix2<f64>, b: &Vector2<f64>) -> [f64; 4] {
    let (trace, determinant) = (a.trace(), a.determinant());
    let steady = a[(1, 0)] * b[0] - a[(0, 0)] * b[1];
    let gain = steady / determinant;
    let time = -trace / determinant - b[1] / steady;
    // Eigenvalues of a ship are real; a pair of complex ones has the real part of half the trace.
    let root = (0.25 * trace * trace - determinant).max(0.0).sqrt();
    [gain, time, 0.5 * trace + root, b[1]]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::Zoo;

    #[test]
    fn a_first_order_ship_has_its_own_indices() {
        // Yaw alone: T r' + r = K delta with T = 2 and K = 3; sway settles at once.
        let a = Matrix2::new(-1e6, 0.0, 0.0, -0.5);
        let [gain, time, stability, rudder] = response_figures(&a, &Vector2::new(0.0, 1.5));
        assert!((gain - 3.0).abs() < 1e-9 && (time - 2.0).abs() < 1e-5);
        assert!((stability + 0.5).abs() < 1e-5 && (rudder - 1.5).abs() < 1e-12);
    }

    #[test]
    fn mariner_is_stable_and_the_tanker_is_not() {
        let zoo = Zoo::load_embedded().unwrap();
        let figures = |name: &str| {
            let model = zoo.find_model(name).unwrap();
            course_figures(&model, zoo.law(&model.law).unwrap())
        };
        let (mariner, tanker) = (figures("mariner"), figures("kvlcc2"));
        assert!(mariner[0].value > 0.0 && mariner[2].value < 0.0, "{mariner:?}");
        assert!(tanker[2].value > 0.0, "{tanker:?}");
        assert!(mariner.iter().all(|figure| figure.half_width.is_none()));
    }
}
