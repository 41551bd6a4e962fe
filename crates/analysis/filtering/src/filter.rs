//! Prediction errors of the readings of a part of a trial, and of every column, divided by their
//! predicted standard deviations.

use sistership_identification::refine::RefineError;

use super::discrepancies::AxisDiscrepancies;
use super::gram::GramMatrix;
use super::kalman_filter::KalmanFilter;
use super::linearised::LinearisedPart;
use super::noise::InstrumentNoise;
use sistership_simulation::simd::{SimdKernel, dispatch_simd};

/// Rows of prediction errors, and the sum of the logarithms of their predicted variances.
pub type WhitenedRows = (Vec<f64>, f64);

/// Returns the products of whitened residual and columns of a part of a trial, summed over
/// readings.
///
/// # Errors
/// Returns an error if the noise of a channel is unknown.
pub fn filter_part(
    linear: &LinearisedPart,
    noise: &InstrumentNoise,
    discrepancies: &AxisDiscrepancies,
) -> Result<GramMatrix, RefineError> {
    filter_columns(linear, linear.sizes.columns, noise, discrepancies)
}

/// Returns the products of whitened residual and the first columns of a part of a trial.
///
/// # Errors
/// Returns an error if the noise of a channel is unknown.
pub fn filter_columns(
    linear: &LinearisedPart,
    columns: usize,
    noise: &InstrumentNoise,
    discrepancies: &AxisDiscrepancies,
) -> Result<GramMatrix, RefineError> {
    let (rows, log_variance) = whiten_columns(linear, columns, noise, discrepancies)?;
    Ok(GramMatrix::from_rows(&rows, 1 + columns, log_variance))
}

/// Returns the prediction errors of a part with one column that combines all others, divided by the
/// predicted standard deviation, sample after sample and by recorded channel in each; and the sum
/// of the logarithms of the predicted variances.
///
/// # Errors
/// Returns an error if the noise of a channel is unknown.
pub fn prediction_errors(
    linear: &LinearisedPart,
    noise: &InstrumentNoise,
    discrepancies: &AxisDiscrepancies,
) -> Result<WhitenedRows, RefineError> {
    let (rows, log_variance) = whiten_part(linear, noise, discrepancies)?;
    Ok((rows.chunks_exact(2).map(|row| row[0] - row[1]).collect(), log_variance))
}

/// Returns the contribution of the one combined column of a part to the prediction errors, in the
/// same order.
///
/// # Errors
/// Returns an error if the noise of a channel is unknown.
pub fn column_responses(
    linear: &LinearisedPart,
    noise: &InstrumentNoise,
    discrepancies: &AxisDiscrepancies,
) -> Result<Vec<f64>, RefineError> {
    let (rows, _) = whiten_part(linear, noise, discrepancies)?;
    Ok(rows.chunks_exact(2).map(|row| row[1]).collect())
}

/// Returns prediction errors and the contribution of each column, divided by the predicted standard
/// deviation: a row for each sample and recorded channel, the residual first; and the sum of the
/// logarithms of the predicted variances.
///
/// # Errors
/// Returns an error if the noise of a channel is unknown.
pub fn whiten_part(
    linear: &LinearisedPart,
    noise: &InstrumentNoise,
    discrepancies: &AxisDiscrepancies,
) -> Result<WhitenedRows, RefineError> {
    whiten_columns(linear, linear.sizes.columns, noise, discrepancies)
}

/// Returns prediction errors and the contributions of the first columns, as [`whiten_part`].
///
/// # Errors
/// Returns an error if the noise of a channel is unknown.
pub fn whiten_columns(
    linear: &LinearisedPart,
    columns: usize,
    noise: &InstrumentNoise,
    discrepancies: &AxisDiscrepancies,
) -> Result<WhitenedRows, RefineError> {
    let width = 1 + columns;
    let filter = KalmanFilter::new(vec![linear], noise, discrepancies, width)?;
    // Exact capacity: the number of rows is known, and a grown vector would keep spare memory.
    let mut rows = Vec::new();
    rows.reserve_exact(linear.reading.len() * width);
    let mut log_variance = 0.0;
    dispatch_simd(WhiteningKernel {
        linear,
        filter,
        rows: &mut rows,
        log_variance: &mut log_variance,
    });
    Ok((rows, log_variance))
}

/// Arguments of a filter pass over a part of a trial.
struct WhiteningKernel<'a> {
    linear: &'a LinearisedPart,
    filter: KalmanFilter<'a, f64>,
    rows: &'a mut Vec<f64>,
    log_variance: &'a mut f64,
}

impl SimdKernel for WhiteningKernel<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { linear, mut filter, rows, log_variance } = self;
        for k in 0..linear.samples.len() {
            if k > 0 {
                filter.predict(k - 1);
            }
            // A reading is used only every so many samples where its noise is not white.
            if !k.is_multiple_of(linear.every) {
                continue;
            }
            filter.update(k, |error, variance, _| {
                let scale = variance.sqrt().recip();
                rows.push(error[0] * scale);
                // The error of a column is the movement that its parameter explains, with the sign
                // turned.
                rows.extend(error[1..].iter().map(|e| -e * scale));
                *log_variance += variance.ln();
            });
        }
    }
}
