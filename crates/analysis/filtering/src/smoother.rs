//! What must be added to the accelerations, as all readings together say: the discrepancy by a
//! fixed-interval smoother (Rauch, Tung and Striebel 1965, AIAA J 3, 1445-1450).

use nalgebra::{Cholesky, DMatrix, DVector};

use super::filter::{Discrepancies, FilterState};
use super::linearised::Linearised;
use super::noise::Noise;

/// The discrepancy of each axis over the samples of a part, with its standard deviation.
#[derive(Debug, Clone)]
pub struct Smoothed {
    /// By axis, then sample, m/s2 or rad/s2.
    pub values: Vec<Vec<f64>>,
    /// Their standard deviations.
    pub deviations: Vec<Vec<f64>>,
}

/// State and covariance at a sample.
struct GaussianState {
    mean: DVector<f64>,
    covariance: DMatrix<f64>,
}

/// What the filter knew at a sample, and what it expected there before its readings.
struct FilterStep {
    known: GaussianState,
    expected: GaussianState,
    transition: DMatrix<f64>,
}

/// Smooths a part with no columns.
pub fn smoothed(linear: &Linearised, noise: &Noise, discrepancies: &Discrepancies) -> Smoothed {
    let steps = forward(linear, noise, discrepancies);
    let (states, axes) = (linear.sizes.states, linear.sizes.axes);
    let mut smoothed = Smoothed {
        values: vec![vec![0.0; steps.len()]; axes],
        deviations: vec![vec![0.0; steps.len()]; axes],
    };
    let mut later: Option<GaussianState> = None;
    for k in (0..steps.len()).rev() {
        let belief = match &later {
            Some(later) => backward(&steps[k].known, &steps[k + 1], later),
            None => GaussianState {
                mean: steps[k].known.mean.clone(),
                covariance: steps[k].known.covariance.clone(),
            },
        };
        for axis in 0..axes {
            smoothed.values[axis][k] = belief.mean[states + axis];
            smoothed.deviations[axis][k] =
                belief.covariance[(states + axis, states + axis)].max(0.0).sqrt();
        }
        later = Some(belief);
    }
    smoothed
}

fn forward(linear: &Linearised, noise: &Noise, discrepancies: &Discrepancies) -> Vec<FilterStep> {
    let mut state = FilterState::start(linear, noise, discrepancies, 1);
    let order = state.order;
    let belief = |state: &FilterState| GaussianState {
        mean: DVector::from_column_slice(&state.deviations),
        covariance: DMatrix::from_row_slice(order, order, &state.covariance),
    };
    let mut steps = Vec::with_capacity(linear.samples.len());
    for k in 0..linear.samples.len() {
        if k > 0 {
            state.predict(linear, k - 1, discrepancies);
        }
        let expected = belief(&state);
        if k.is_multiple_of(linear.every) {
            state.update(linear, k, noise, |_, _| {});
        }
        let transition = DMatrix::from_row_slice(order, order, &state.transition);
        steps.push(FilterStep { known: belief(&state), expected, transition });
    }
    steps
}

/// What was known at a sample after what came later.
fn backward(known: &GaussianState, next: &FilterStep, later: &GaussianState) -> GaussianState {
    let Some(expected) = Cholesky::new(next.expected.covariance.clone()) else {
        return GaussianState { mean: known.mean.clone(), covariance: known.covariance.clone() };
    };
    // The gain is P F' Q^-1; all are symmetric but F.
    let gain = expected.solve(&(&next.transition * &known.covariance)).transpose();
    let mean = &known.mean + &gain * (&later.mean - &next.expected.mean);
    let covariance = &known.covariance
        + &gain * (&later.covariance - &next.expected.covariance) * gain.transpose();
    GaussianState { mean, covariance }
}
