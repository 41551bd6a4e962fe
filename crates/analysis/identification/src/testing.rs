//! Simulated trials for tests, with noise that differs from trial to trial.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use sistership_model::trial::{Channel, Trial};
use sistership_model::{Law, Model, Zoo};
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_zigzag};
use sistership_simulation::state::{RECORDED_CHANNELS, Trajectory, at};

/// The Mariner and its law.
pub fn mariner_model() -> (Model, Arc<Law>) {
    let zoo = Zoo::load_embedded().unwrap();
    let model = zoo.find_model("mariner").unwrap();
    let law = zoo.law(&model.law).unwrap().clone();
    (model, law)
}

/// The model with each coefficient multiplied by `factor`, which takes the coefficient's name.
pub fn with_scaled_coefficients(model: &Model, factor: impl Fn(&str) -> f64) -> Model {
    let mut model = model.clone();
    model.coefficients.iter_mut().for_each(|(name, quantity)| quantity.value *= factor(name));
    model
}

/// Simulated zigzags 10/10, 20/20 and 30/30 to both sides at 1 Hz. `noise` is the amplitude of the
/// noise of each channel as a share of its value.
pub fn simulated_trials(model: &Model, law: &Law, noise: f64) -> Vec<Trial> {
    let ship = Ship::new(model, law).unwrap();
    let settings = ManoeuvreSettings {
        step_s: Some(0.5),
        duration_s: Some(600.0),
        ..ManoeuvreSettings::default()
    };
    let sailed = |angle: f64| simulate_zigzag(&ship, angle, angle.abs(), &settings).unwrap().track;
    let recorded = |(index, angle): (usize, f64)| record_trial(&sailed(angle), index, noise);
    [10.0, 20.0, -30.0, -20.0].into_iter().enumerate().map(recorded).collect()
}

/// A track sampled at every second step, with deterministic noise on every channel but the
/// rudder's.
fn record_trial(track: &Trajectory, index: usize, noise: f64) -> Trial {
    // The track has steps of 0.5 s; every second one gives samples at 1 Hz.
    let kept: Vec<usize> = (0..track.t_s.len()).step_by(2).collect();
    let column = |at: usize| {
        let shaken = |&k: &usize| {
            // Sums of incommensurable sines replace a random generator: reproducible, and different
            // for every trial, channel and sample.
            let shake = (12.9898 * (k + 977 * at + 31 * index) as f64).sin()
                + (78.233 * (k + 13 * at) as f64).cos();
            track.states[k][at] * (1.0 + noise * shake)
        };
        kept.iter().map(shaken).collect::<Vec<f64>>()
    };
    let mut channels: std::collections::BTreeMap<Channel, Vec<f64>> =
        RECORDED_CHANNELS.iter().map(|&(c, at)| (c, column(at))).collect();
    // The rudder stays exact: regressions take it as a known input.
    channels.insert(Channel::Delta, kept.iter().map(|&k| track.states[k][at::DELTA]).collect());
    Trial {
        name: format!("trial-{index}"),
        t_s: kept.iter().map(|&k| track.t_s[k]).collect(),
        channels,
        ..Trial::default()
    }
}
