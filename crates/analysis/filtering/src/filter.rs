//! Prediction errors of the readings of a part of a trial, and of every column, divided by their
//! predicted deviation.

use sistership_identification::refine::RefineError;

use super::discrepancies::Discrepancies;
use super::gram::Gram;
use super::kalman_filter::KalmanFilter;
use super::linearised::Linearised;
use super::noise::Noise;
use sistership_simulation::wide::{Wide, widest};

/// Rows of prediction errors, and the sum of the logarithms of their predicted variances.
pub type Whitened = (Vec<f64>, f64);

/// Whitened residual and columns of a part of a trial, added up.
///
/// # Errors
/// Names a channel of which no noise is known.
pub fn filter(
    linear: &Linearised,
    noise: &Noise,
    discrepancies: &Discrepancies,
) -> Result<Gram, RefineError> {
    filter_first(linear, linear.sizes.columns, noise, discrepancies)
}

/// The same of the first columns alone.
///
/// # Errors
/// As of [`filter`].
pub fn filter_first(
    linear: &Linearised,
    columns: usize,
    noise: &Noise,
    discrepancies: &Discrepancies,
) -> Result<Gram, RefineError> {
    let (rows, log_variance) = whitened_first(linear, columns, noise, discrepancies)?;
    Ok(Gram::of_rows(&rows, 1 + columns, log_variance))
}

/// Prediction errors of parts with all columns in one ([`Linearised::along`]), divided by the
/// predicted deviation, sample after sample and in each by recorded channel; and the sum of the
/// logarithms of the predicted variances.
///
/// # Errors
/// As of [`filter`].
pub fn errors(
    linear: &Linearised,
    noise: &Noise,
    discrepancies: &Discrepancies,
) -> Result<Whitened, RefineError> {
    let (rows, log_variance) = whitened(linear, noise, discrepancies)?;
    Ok((rows.chunks_exact(2).map(|row| row[0] - row[1]).collect(), log_variance))
}

/// What the one column of [`Linearised::along`] takes from the prediction errors, in the same
/// order.
///
/// # Errors
/// As of [`filter`].
pub fn responses(
    linear: &Linearised,
    noise: &Noise,
    discrepancies: &Discrepancies,
) -> Result<Vec<f64>, RefineError> {
    let (rows, _) = whitened(linear, noise, discrepancies)?;
    Ok(rows.chunks_exact(2).map(|row| row[1]).collect())
}

/// Prediction errors and what each column adds to them, divided by the predicted deviation: for
/// each sample and recorded channel a row, the residual first; and the sum of the logarithms of the
/// predicted variances.
///
/// # Errors
/// As of [`filter`].
pub fn whitened(
    linear: &Linearised,
    noise: &Noise,
    discrepancies: &Discrepancies,
) -> Result<Whitened, RefineError> {
    whitened_first(linear, linear.sizes.columns, noise, discrepancies)
}

fn whitened_first(
    linear: &Linearised,
    columns: usize,
    noise: &Noise,
    discrepancies: &Discrepancies,
) -> Result<Whitened, RefineError> {
    let width = 1 + columns;
    let filter = KalmanFilter::new(vec![linear], noise, discrepancies, width)?;
    let mut rows = Vec::new();
    rows.reserve_exact(linear.reading.len() * width);
    let mut log_variance = 0.0;
    widest(Whitening { linear, filter, rows: &mut rows, log_variance: &mut log_variance });
    Ok((rows, log_variance))
}

/// A part of a trial to be whitened.
struct Whitening<'a> {
    linear: &'a Linearised,
    filter: KalmanFilter<'a, f64>,
    rows: &'a mut Vec<f64>,
    log_variance: &'a mut f64,
}

impl Wide for Whitening<'_> {
    #[inline(always)]
    fn go(self) {
        let Self { linear, mut filter, rows, log_variance } = self;
        for k in 0..linear.samples.len() {
            if k > 0 {
                filter.predict(k - 1);
            }
            if !k.is_multiple_of(linear.every) {
                continue;
            }
            filter.update(k, |error, variance| {
                let scale = variance.sqrt().recip();
                rows.push(error[0] * scale);
                // An error that a column makes is what its parameter takes away.
                rows.extend(error[1..].iter().map(|e| -e * scale));
                *log_variance += variance.ln();
            });
        }
    }
}
