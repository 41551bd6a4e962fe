//! A simulated track in the form of a recorded trial.

use sistership_model::Trial;
use sistership_model::trial::Channel;
use sistership_simulation::Trajectory;
use sistership_simulation::instruments::THROUGH_WATER;
use sistership_simulation::state::{RECORDED_CHANNELS, at};

/// Converts a simulated track with an initial heading (rad) to a trial without noise, with the
/// channels and the interval of the trial `like`; wind and other channels that are not simulated
/// are constant at their values in the middle of `like`.
pub fn trial_from_track(track: &Trajectory, like: &Trial, heading_rad: f64) -> Trial {
    let step_s = track.t_s.get(1).copied().unwrap_or(1.0);
    // The track is simulated at a finer interval: every so many samples are kept.
    let stride = (like.interval_s() / step_s).round().max(1.0) as usize;
    let every = |values: Vec<f64>| values.into_iter().step_by(stride).collect::<Vec<f64>>();
    let (sin, cos) = heading_rad.sin_cos();
    let (x, y) = (track.state_column(at::X), track.state_column(at::Y));
    // Positions and headings turn with the initial heading; all other channels are in the ship's
    // axes.
    let turned = |channel: Channel, index: usize| match channel {
        Channel::X => x.iter().zip(&y).map(|(x, y)| x * cos - y * sin).collect(),
        Channel::Y => x.iter().zip(&y).map(|(x, y)| x * sin + y * cos).collect(),
        Channel::Psi => {
            track.state_column(index).into_iter().map(|psi| psi + heading_rad).collect()
        }
        _ => track.state_column(index),
    };
    let mut trial = Trial {
        name: "planned".into(),
        velocity: like.velocity,
        depth_m: like.depth_m,
        ..Trial::default()
    };
    trial.t_s = every(track.t_s.clone());
    let count = trial.t_s.len();
    // All channels of `like` first, as constants; those that the simulation gives then replace
    // them.
    for (&channel, values) in &like.channels {
        let constant = values.get(values.len() / 2).copied().unwrap_or_default();
        trial.channels.insert(channel, vec![constant; count]);
    }
    let moving = RECORDED_CHANNELS.iter().chain(&THROUGH_WATER);
    for &(channel, index) in moving.filter(|(channel, _)| like.channel(*channel).is_some()) {
        trial.channels.insert(channel, every(turned(channel, index)));
    }
    // The rudder is always recorded, also where `like` has no such channel.
    trial.channels.insert(Channel::Delta, every(track.state_column(at::DELTA)));
    if like.channel(Channel::N).is_some() {
        trial.channels.insert(Channel::N, every(track.n_rps.clone()));
    }
    trial
}
