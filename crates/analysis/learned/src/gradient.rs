//! Derivatives of what a learned correction adds: those of the answer by the chain rule through its
//! scaled inputs, and those of the share that it counts for.

use sistership_model::branch::{BranchInput, BranchOutput, Signal};
use sistership_simulation::branch::{AdditionGradient, Instant};

use crate::answer::answer;
use crate::regressor::Regressor;
use crate::sample::scaled;

/// What an output answers less what it replaces, and its derivatives with everything that it may be
/// told from: u, v, r, delta, n, and the law's rates of u, v, r.
pub(crate) struct OutputGradient {
    value: f64,
    slopes: [f64; 8],
}

/// The first of the law's rates among the slopes.
const RATES: usize = 5;

impl OutputGradient {
    /// Of an answer; one at a bound of its range does not move.
    pub fn new(output: &BranchOutput, regressor: &Regressor, instant: &Instant) -> Self {
        let value = answer(output, regressor, instant);
        let mut slopes = [0.0; 8];
        let [low, high] = output.range;
        if value > low && value < high {
            let inputs: Vec<f64> =
                output.inputs.iter().map(|input| scaled(input, instant)).collect();
            for (input, slope) in output.inputs.iter().zip(regressor.gradient(&inputs)) {
                chain(input, output.scale * slope / input.scale, instant, &mut slopes);
            }
        }
        Self { value, slopes }
    }

    /// Less the law's own rate where the output replaces that.
    pub fn joined(mut self, replaces: bool, instant: &Instant, place: usize) -> Self {
        if replaces {
            self.value -= instant.accelerations[place];
            self.slopes[RATES + place] -= 1.0;
        }
        self
    }

    /// Adds `share (value)` of the rate at a place to the derivatives of all.
    pub fn add_to(
        &self,
        gradient: &mut AdditionGradient,
        place: usize,
        (share, by_share): (f64, &[f64; 5]),
    ) {
        let of = |k: usize| {
            share * self.slopes[k] + by_share.get(k).map_or(0.0, |slope| slope * self.value)
        };
        (0..3).for_each(|k| gradient.by_velocity[place][k] += of(k));
        gradient.by_delta[place] += of(3);
        gradient.by_n[place] += of(4);
        (0..3).for_each(|k| gradient.by_acceleration[place][k] += of(RATES + k));
    }
}

/// Adds the derivatives of an input, times `by`.
fn chain(input: &BranchInput, by: f64, instant: &Instant, slopes: &mut [f64; 8]) {
    match input.signal {
        Signal::U => slopes[0] += by,
        Signal::V => slopes[1] += by,
        Signal::R => slopes[2] += by,
        Signal::Delta => slopes[3] += by,
        Signal::N => slopes[4] += by,
        // The derivatives of atan2(-v, u).
        Signal::Beta => {
            let [u, v, _] = instant.velocities;
            let square = u * u + v * v;
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
