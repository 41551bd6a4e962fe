//! Samples of a regression: inputs and targets in standard deviations.

use sistership_model::branch::{CorrectionInput, Signal};
use sistership_simulation::branch::CorrectionInstant;

/// Inputs by column, and targets.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainingSample {
    /// Values of each input.
    pub columns: Vec<Vec<f64>>,
    /// Target of each row.
    pub targets: Vec<f64>,
}

impl TrainingSample {
    /// True if there is no row.
    pub fn is_empty(&self) -> bool {
        self.targets.is_empty()
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.targets.len()
    }

    /// Returns the inputs of a row.
    pub fn row_inputs(&self, k: usize) -> Vec<f64> {
        self.columns.iter().map(|column| column[k]).collect()
    }
}

/// Value of a signal at an instant, SI units and radians.
pub fn signal_value(signal: Signal, instant: &CorrectionInstant) -> f64 {
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

/// Value of an input at an instant, scaled as in training.
pub fn scale_input(input: &CorrectionInput, instant: &CorrectionInstant) -> f64 {
    (signal_value(input.signal, instant) - input.centre) / input.scale
}

/// Mean and standard deviation; the latter is 1 for constant values.
pub fn centre_and_scale(values: &[f64]) -> (f64, f64) {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let variance = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>();
    let deviation = (variance / values.len() as f64).sqrt();
    (mean, if deviation > 0.0 { deviation } else { 1.0 })
}
