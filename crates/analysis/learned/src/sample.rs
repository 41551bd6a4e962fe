//! What a regression learns from: inputs and targets in deviations.

use sistership_model::branch::{BranchInput, Signal};
use sistership_simulation::branch::Instant;

/// Inputs by column, and targets.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Each input's values.
    pub columns: Vec<Vec<f64>>,
    /// What is to be answered in each row.
    pub targets: Vec<f64>,
}

impl Sample {
    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.targets.is_empty()
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.targets.len()
    }

    /// The inputs of a row.
    pub fn row(&self, k: usize) -> Vec<f64> {
        self.columns.iter().map(|column| column[k]).collect()
    }
}

/// The value of an input, SI and radians.
pub fn value(signal: Signal, instant: &Instant) -> f64 {
    let [u, v, r] = instant.velocities;
    match signal {
        Signal::U => u,
        Signal::V => v,
        Signal::R => r,
        Signal::Delta => instant.delta_rad,
        Signal::N => instant.n_rps,
        Signal::Beta => (-v).atan2(u),
        Signal::UDot => instant.accelerations[0],
        Signal::VDot => instant.accelerations[1],
        Signal::RDot => instant.accelerations[2],
    }
}

/// An input as the weights take it.
pub fn scaled(input: &BranchInput, instant: &Instant) -> f64 {
    (value(input.signal, instant) - input.centre) / input.scale
}

/// Mean and standard deviation; 1 for what does not vary.
pub fn centre_and_scale(values: &[f64]) -> (f64, f64) {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let variance = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>();
    let deviation = (variance / values.len() as f64).sqrt();
    (mean, if deviation > 0.0 { deviation } else { 1.0 })
}
