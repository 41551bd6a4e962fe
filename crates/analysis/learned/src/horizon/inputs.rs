//! What a network is told at an instant.

use serde::{Deserialize, Serialize};
use sistership_model::trial::{Channel, Trial};
use sistership_simulation::state::{StateVector, at};

use super::axes::Axes;

/// What stands for the orders to come.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Told {
    /// Where the foundation ends under them, and how fast: three numbers each, however long the
    /// horizon is (Kanazawa 2023, sec. 3.1.1).
    End,
    /// They themselves, each as the mean over a part of the horizon (sec. 3.3.1 has every second).
    Orders {
        /// Parts of the horizon.
        parts: usize,
    },
    /// Nothing: they stay as they are (sec. 4.1.1).
    Nothing,
}

/// The motion, the orders and the apparent wind, where it was recorded, at a sample.
pub fn present(trial: &Trial, k: usize) -> Vec<f64> {
    let of = |channel: Channel| trial.channel(channel).map(|column| column[k]);
    let known = [Channel::U, Channel::V, Channel::R, Channel::N, Channel::Delta];
    let mut row: Vec<f64> = known.into_iter().filter_map(of).collect();
    row.extend(apparent_wind(trial, k).into_iter().flatten());
    row
}

/// Along and across the ship, from where it comes, m/s.
fn apparent_wind(trial: &Trial, k: usize) -> Option<[f64; 2]> {
    let of = |channel: Channel| trial.channel(channel).map(|column| column[k]);
    if let (Some(speed), Some(from)) =
        (of(Channel::ApparentWindSpeed), of(Channel::ApparentWindFrom))
    {
        let (sin, cos) = from.sin_cos();
        return Some([speed * cos, speed * sin]);
    }
    let (speed, from) = (of(Channel::WindSpeed)?, of(Channel::WindFrom)?);
    let (sin, cos) = (from - of(Channel::Psi)?).sin_cos();
    Some([of(Channel::U)? + speed * cos, of(Channel::V)? + speed * sin])
}

/// Where a foundation ends and how fast, seen from where it began.
pub fn end(axes: &Axes, last: &StateVector) -> [f64; 6] {
    let [ahead, aside] = axes.seen(last[at::X], last[at::Y]);
    [ahead, aside, axes.turned(last[at::PSI]), last[at::U], last[at::V], last[at::R]]
}

/// Revolutions and rudder, the means over parts of a horizon.
pub fn orders(trial: &Trial, k: usize, steps: usize, parts: usize) -> Vec<f64> {
    let channels = [Channel::N, Channel::Delta];
    let mut row = Vec::with_capacity(2 * parts);
    for column in channels.into_iter().filter_map(|channel| trial.channel(channel)) {
        for part in 0..parts {
            let own = &column[k + part * steps / parts..k + (part + 1) * steps / parts];
            row.push(own.iter().sum::<f64>() / own.len().max(1) as f64);
        }
    }
    row
}
