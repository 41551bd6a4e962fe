//! Derivatives of the addition of a learned correction: those of its prediction by the chain rule
//! through its scaled inputs, and those of its share.

use sistership_model::branch::{CorrectionInput, CorrectionOutput, Signal};
use sistership_simulation::branch::{AdditionGradient, CorrectionInstant};

use crate::answer::predict_output;
use crate::regressor::OutputRegressor;
use crate::sample::scale_input;

/// Prediction of an output, less the rate that it replaces, and its derivatives with respect to
/// everything that it may depend on: u, v, r, delta, n, and the law's rates of u, v, r.
pub(crate) struct OutputGradient {
    value: f64,
    slopes: [f64; 8],
}

/// Index of the first of the law's rates among the derivatives.
const RATES: usize = 5;

impl OutputGradient {
    /// Creates the gradient of a prediction. A prediction at a bound of its range has derivatives
    /// of zero.
    pub fn new(
        output: &CorrectionOutput,
        regressor: &OutputRegressor,
        instant: &CorrectionInstant,
    ) -> Self {
        let value = predict_output(output, regressor, instant);
        let mut slopes = [0.0; 8];
        let [low, high] = output.range;
        // At a limit of the range the prediction is constant, so its derivatives are zero.
        if value > low && value < high {
            let inputs: Vec<f64> =
                output.inputs.iter().map(|input| scale_input(input, instant)).collect();
            for (input, slope) in output.inputs.iter().zip(regressor.input_gradient(&inputs)) {
                // d(output)/d(signal): the regressor works on scaled inputs and targets.
                add_signal_gradient(
                    input,
                    output.scale * slope / input.scale,
                    instant,
                    &mut slopes,
                );
            }
        }
        Self { value, slopes }
    }

    /// Subtracts the law's own rate if the output replaces it.
    pub fn less_law_rate(
        mut self,
        replaces: bool,
        instant: &CorrectionInstant,
        place: usize,
    ) -> Self {
        if replaces {
            self.value -= instant.accelerations[place];
            self.slopes[RATES + place] -= 1.0;
        }
        self
    }

    /// Adds the derivatives of `share * value`, an addition to the rate at index `place`, by the
    /// product rule.
    pub fn add_to(
        &self,
        gradient: &mut AdditionGradient,
        place: usize,
        (share, by_share): (f64, &[f64; 5]),
    ) {
        let of = |k: usize| {
            // The share depends on the first five variables only: u, v, r, delta and n.
            share * self.slopes[k] + by_share.get(k).map_or(0.0, |slope| slope * self.value)
        };
        (0..3).for_each(|k| gradient.by_velocity[place][k] += of(k));
        gradient.by_delta[place] += of(3);
        gradient.by_n[place] += of(4);
        (0..3).for_each(|k| gradient.by_acceleration[place][k] += of(RATES + k));
    }
}

/// Adds the derivatives of an input's signal, multiplied by `by`.
fn add_signal_gradient(
    input: &CorrectionInput,
    by: f64,
    instant: &CorrectionInstant,
    slopes: &mut [f64; 8],
) {
    match input.signal {
        Signal::U => slopes[0] += by,
        Signal::V => slopes[1] += by,
        Signal::R => slopes[2] += by,
        Signal::Delta => slopes[3] += by,
        Signal::N => slopes[4] += by,
        // Derivatives of atan2(-v, u).
        Signal::Beta => {
            let [u, v, _] = instant.velocities;
            let square = u * u + v * v;
            // The drift angle is not defined at rest.
            if square > 0.0 {
                slopes[0] += by * v / square;
                slopes[1] -= by * u / square;
            }
        }
        Signal::UDot => slopes[RATES] += by,
        Signal::VDot => slopes[RATES + 1] += by,
        Signal::RDot => slopes[RATES + 2] += by,
    }
}
