//! Inputs of a network at an instant.

use serde::{Deserialize, Serialize};
use sistership_model::trial::{Channel, Trial};
use sistership_simulation::state::{StateVector, at};

use super::axes::ShipAxes;

/// Encoding of the future orders.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OrderEncoding {
    /// Position, heading and velocities of the foundation at the end of the horizon: three numbers
    /// each, independent of the length of the horizon (Kanazawa 2023, sec. 3.1.1).
    End,
    /// The orders themselves, each as the mean over parts of the horizon (sec. 3.3.1 uses every
    /// second).
    Orders {
        /// Number of parts of the horizon.
        parts: usize,
    },
    /// None: orders are assumed constant (sec. 4.1.1).
    Nothing,
}

/// Motion, orders and, if recorded, apparent wind at a sample.
pub fn present_inputs(trial: &Trial, k: usize) -> Vec<f64> {
    let of = |channel: Channel| trial.channel(channel).map(|column| column[k]);
    let known = [Channel::U, Channel::V, Channel::R, Channel::N, Channel::Delta];
    let mut row: Vec<f64> = known.into_iter().filter_map(of).collect();
    row.extend(apparent_wind(trial, k).into_iter().flatten());
    row
}

/// Components of the apparent wind along and across the ship, m/s, positive from ahead and from
/// starboard.
fn apparent_wind(trial: &Trial, k: usize) -> Option<[f64; 2]> {
    let of = |channel: Channel| trial.channel(channel).map(|column| column[k]);
    if let (Some(speed), Some(from)) =
        (of(Channel::ApparentWindSpeed), of(Channel::ApparentWindFrom))
    {
        let (sin, cos) = from.sin_cos();
        return Some([speed * cos, speed * sin]);
    }
    // True wind relative to the bow, plus the ship's own velocity.
    let (speed, from) = (of(Channel::WindSpeed)?, of(Channel::WindFrom)?);
    let (sin, cos) = (from - of(Channel::Psi)?).sin_cos();
    Some([of(Channel::U)? + speed * cos, of(Channel::V)? + speed * sin])
}

/// Position, heading and velocities at the end of a foundation's track, in the axes of its start.
pub fn end_state(axes: &ShipAxes, last: &StateVector) -> [f64; 6] {
    let [ahead, aside] = axes.to_ship_axes(last[at::X], last[at::Y]);
    [ahead, aside, axes.relative_heading(last[at::PSI]), last[at::U], last[at::V], last[at::R]]
}

/// Means of revolutions and rudder angle over parts of a horizon.
pub fn mean_orders(trial: &Trial, k: usize, steps: usize, parts: usize) -> Vec<f64> {
    let channels = [Channel::N, Channel::Delta];
    let mut row = Vec::with_capacity(2 * parts);
    for column in channels.into_iter().filter_map(|channel| trial.channel(channel)) {
        for part in 0..parts {
            // Integer division spreads the samples evenly over the parts.
            let own = &column[k + part * steps / parts..k + (part + 1) * steps / parts];
            row.push(own.iter().sum::<f64>() / own.len().max(1) as f64);
        }
    }
    row
}
