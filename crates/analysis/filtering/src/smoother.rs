//! Discrepancies of the accelerations given all readings, by a fixed-interval smoother (Rauch, Tung
//! and Striebel 1965, AIAA J 3, 1445-1450).

use nalgebra::{Cholesky, DMatrix, DVector};
use sistership_identification::refine::RefineError;

use super::discrepancies::AxisDiscrepancies;
use super::kalman_filter::KalmanFilter;
use super::linearised::LinearisedPart;
use super::noise::InstrumentNoise;

/// Discrepancy of each axis over the samples of a part, with its standard deviation.
#[derive(Debug, Clone)]
pub struct SmoothedDiscrepancies {
    /// Values by axis, then sample, m/s2 or rad/s2.
    pub values: Vec<Vec<f64>>,
    /// Standard deviations, in the same order.
    pub deviations: Vec<Vec<f64>>,
}

/// Mean and covariance of states and discrepancies at a sample.
#[derive(Debug, Clone)]
struct GaussianState {
    mean: DVector<f64>,
    covariance: DMatrix<f64>,
}

/// Filtered state after the readings of a sample, and the predicted one before them.
struct FilterStep {
    known: GaussianState,
    expected: GaussianState,
    transition: DMatrix<f64>,
}

/// Smooths the residual of a part; its columns are ignored.
///
/// # Errors
/// Returns an error if the noise of a channel is unknown, or one that names the time at which a
/// predicted covariance is not positive definite.
pub fn smooth_discrepancies(
    linear: &LinearisedPart,
    noise: &InstrumentNoise,
    discrepancies: &AxisDiscrepancies,
) -> Result<SmoothedDiscrepancies, RefineError> {
    let (states, axes) = (linear.sizes.states, linear.sizes.axes);
    let all = smoothed_states(linear, noise, discrepancies)?;
    let of_axis = |of: &dyn Fn(&GaussianState, usize) -> f64| {
        let one = |axis: usize| all.iter().map(|state| of(state, states + axis)).collect();
        (0..axes).map(one).collect()
    };
    Ok(SmoothedDiscrepancies {
        values: of_axis(&|state, at| state.mean[at]),
        deviations: of_axis(&|state, at| state.covariance[(at, at)].max(0.0).sqrt()),
    })
}

/// States and discrepancies at each sample given all readings.
fn smoothed_states(
    linear: &LinearisedPart,
    noise: &InstrumentNoise,
    discrepancies: &AxisDiscrepancies,
) -> Result<Vec<GaussianState>, RefineError> {
    let steps = filter_forward(linear, noise, discrepancies)?;
    let mut all: Vec<GaussianState> = Vec::with_capacity(steps.len());
    // Backwards in time: the last filtered state is already the smoothed one.
    for k in (0..steps.len()).rev() {
        let state = match all.last() {
            Some(later) => smooth_backward(&steps[k].known, &steps[k + 1], later).ok_or_else(|| {
                RefineError::Data(format!(
                    "the covariance that the filter predicts for {} s is not positive definite: \
                     check noise and discrepancies of the model's calibration",
                    linear.t_s[k + 1]
                ))
            })?,
            None => steps[k].known.clone(),
        };
        all.push(state);
    }
    all.reverse();
    Ok(all)
}

fn filter_forward(
    linear: &LinearisedPart,
    noise: &InstrumentNoise,
    discrepancies: &AxisDiscrepancies,
) -> Result<Vec<FilterStep>, RefineError> {
    let mut filter = KalmanFilter::<f64>::new(vec![linear], noise, discrepancies, 1)?;
    let belief = |filter: &KalmanFilter<'_, f64>| GaussianState {
        mean: filter.state_mean(),
        covariance: filter.state_covariance(),
    };
    let mut steps = Vec::with_capacity(linear.samples.len());
    for k in 0..linear.samples.len() {
        if k > 0 {
            filter.predict(k - 1);
        }
        let expected = belief(&filter);
        if k.is_multiple_of(linear.every) {
            filter.update(k, |_, _, _| {});
        }
        // After the update, but still the transition by which this sample was predicted.
        let transition = filter.transition_matrix();
        steps.push(FilterStep { known: belief(&filter), expected, transition });
    }
    Ok(steps)
}

/// Smoothed state at a sample, from that at the next; none where the covariance that is predicted
/// for the next sample is not positive definite.
fn smooth_backward(
    known: &GaussianState,
    next: &FilterStep,
    later: &GaussianState,
) -> Option<GaussianState> {
    let expected = Cholesky::new(next.expected.covariance.clone())?;
    // The gain is P F' Q^-1; all are symmetric but F.
    let gain = expected.solve(&(&next.transition * &known.covariance)).transpose();
    let mean = &known.mean + &gain * (&later.mean - &next.expected.mean);
    let covariance = &known.covariance
        + &gain * (&later.covariance - &next.expected.covariance) * gain.transpose();
    Some(GaussianState { mean, covariance })
}

#[cfg(test)]
#[path = "dense_posterior_tests.rs"]
mod dense_posterior;

#[cfg(test)]
#[path = "closed_form_tests.rs"]
mod closed_form;
