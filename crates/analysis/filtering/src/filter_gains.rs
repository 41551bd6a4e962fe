//! Gains of a Kalman filter along a part of a trial.
//!
//! Transitions, gains and variances depend on neither readings nor columns: computed once, they
//! serve any number of columns, which then pass the filter without its covariance.

use sistership_identification::refine::RefineError;
use sistership_simulation::simd::{SimdKernel, dispatch_simd};

use super::discrepancies::AxisDiscrepancies;
use super::kalman_filter::KalmanFilter;
use super::linearised::LinearisedPart;
use super::noise::InstrumentNoise;

/// Gains of a filter along a part; all matrices are row by row.
#[derive(Debug)]
pub struct FilterGains {
    pub(super) states: usize,
    pub(super) axes: usize,
    /// Transition of each interval: states by states and discrepancies.
    pub(super) transitions: Vec<f64>,
    /// Share of each discrepancy that remains over each interval.
    pub(super) kept: Vec<f64>,
    /// Change of states and discrepancies by a unit of each prediction error, by reading.
    pub(super) gains: Vec<f64>,
    /// Reciprocal standard deviation of each prediction error.
    pub(super) scales: Vec<f64>,
    /// Sum of the logarithms of the predicted variances.
    pub(super) log_variance: f64,
}

impl FilterGains {
    /// Runs the filter along a part.
    ///
    /// # Errors
    /// Returns an error if the noise of a channel is unknown.
    pub fn new(
        linear: &LinearisedPart,
        noise: &InstrumentNoise,
        discrepancies: &AxisDiscrepancies,
    ) -> Result<Self, RefineError> {
        // One column suffices: covariances do not depend on the readings.
        let filter = KalmanFilter::new(vec![linear], noise, discrepancies, 1)?;
        let (states, axes) = (linear.sizes.states, linear.sizes.axes);
        let (order, intervals) = (states + axes, linear.samples.len().saturating_sub(1));
        let readings = linear.samples.len().div_ceil(linear.every) * linear.channels.len();
        let mut gains = Self {
            states,
            axes,
            transitions: Vec::with_capacity(intervals * states * order),
            kept: Vec::with_capacity(intervals * axes),
            gains: Vec::with_capacity(readings * order),
            scales: Vec::with_capacity(readings),
            log_variance: 0.0,
        };
        dispatch_simd(GainKernel { linear, filter, gains: &mut gains });
        Ok(gains)
    }

    /// Number of states with discrepancies.
    pub fn order(&self) -> usize {
        self.states + self.axes
    }

    /// Number of readings.
    pub fn reading_count(&self) -> usize {
        self.scales.len()
    }
}

/// Arguments of a pass that keeps the gains.
struct GainKernel<'a> {
    linear: &'a LinearisedPart,
    filter: KalmanFilter<'a, f64>,
    gains: &'a mut FilterGains,
}

impl SimdKernel for GainKernel<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { linear, mut filter, gains } = self;
        for k in 0..linear.samples.len() {
            if k > 0 {
                filter.predict(k - 1);
                let transition = filter.transition();
                (0..gains.states)
                    .for_each(|row| gains.transitions.extend(transition.state_row(row)));
                gains.kept.extend(transition.kept_shares());
            }
            if k.is_multiple_of(linear.every) {
                filter.update(k, |_, variance, covariances| {
                    gains.gains.extend(covariances.iter().map(|own| own / variance));
                    gains.scales.push(variance.sqrt().recip());
                    gains.log_variance += variance.ln();
                });
            }
        }
    }
}
