//! Savitzky-Golay smoothing: a polynomial fitted by least squares to a moving window.
//!
//! Savitzky and Golay 1964 (doi 10.1021/ac60214a047). The ends are evaluated on the polynomials
//! fitted to the first and the last window, as SciPy's `savgol_filter` does with `mode="interp"`.

use nalgebra::DMatrix;
use sistership_model::manifest::Smoothing;
use sistership_model::trial::Channel;

use crate::findings::Findings;
use crate::recording::Recording;

/// Largest window and largest degree that a manifest may declare.
const MAX_WINDOW: usize = 9_999;
const MAX_DEGREE: usize = 15;
/// Largest deviation of a step from the median, as a fraction of it; the filter assumes equal
/// steps.
const UNEVEN: f64 = 0.1;

/// Measured motions, which are smoothed. Rudder and revolutions are commands with edges that a
/// smoother would blur ahead of time, and wind directions wrap: these stay as recorded.
const SMOOTHED: [Channel; 10] = [
    Channel::X,
    Channel::Y,
    Channel::Psi,
    Channel::U,
    Channel::V,
    Channel::UWater,
    Channel::VWater,
    Channel::R,
    Channel::Phi,
    Channel::P,
];

/// Reason for which values cannot be smoothed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SmoothingError {
    /// The window is even or too long.
    #[error("the smoothing window must be odd and at most {most}, not {0}", most = MAX_WINDOW)]
    Window(usize),
    /// The window does not determine the polynomial.
    #[error("the smoothing degree {degree} must be less than the window of {window} samples")]
    Degree {
        /// Degree of the polynomial.
        degree: usize,
        /// Number of samples of the window.
        window: usize,
    },
    /// The degree is too high.
    #[error("the smoothing degree must be at most {most}, not {0}", most = MAX_DEGREE)]
    High(usize),
    /// There are fewer values than samples of the window.
    #[error("a smoothing window of {window} samples does not fit into {samples}")]
    Short {
        /// Number of samples of the window.
        window: usize,
        /// Number of values.
        samples: usize,
    },
}

/// Smooths equally spaced values.
///
/// `window` is an odd number of samples, at most 9999 and at most as many as there are; `degree` is
/// less than the window and at most 15.
///
/// # Errors
/// Returns the first of these conditions that is violated.
pub fn savitzky_golay(
    values: &[f64],
    window: usize,
    degree: usize,
) -> Result<Vec<f64>, SmoothingError> {
    check_settings(window, degree)?;
    if values.len() < window {
        return Err(SmoothingError::Short { window, samples: values.len() });
    }
    let basis = polynomial_basis(window, degree);
    let (half, last) = (window / 2, values.len() - window);
    // The fitted value at a place of a window is the projection onto the polynomials, evaluated
    // there.
    let fitted = |start: usize, weights: &[f64]| -> f64 {
        values[start..start + window].iter().zip(weights).map(|(a, b)| a * b).sum()
    };
    let middle = sample_weights(&basis, half);
    let head = (0..half).map(|place| fitted(0, &sample_weights(&basis, place)));
    let body = (0..=last).map(|start| fitted(start, &middle));
    let tail = (half + 1..window).map(|place| fitted(last, &sample_weights(&basis, place)));
    Ok(head.chain(body).chain(tail).collect())
}

/// Checks that window and degree are valid for [`savitzky_golay`].
pub(crate) fn check_settings(window: usize, degree: usize) -> Result<(), SmoothingError> {
    match () {
        () if window.is_multiple_of(2) || window > MAX_WINDOW => {
            Err(SmoothingError::Window(window))
        }
        () if degree >= window => Err(SmoothingError::Degree { degree, window }),
        () if degree > MAX_DEGREE => Err(SmoothingError::High(degree)),
        () => Ok(()),
    }
}

/// Returns orthonormal polynomials on the window, one per column; on [-1, 1], where powers are well
/// conditioned.
fn polynomial_basis(window: usize, degree: usize) -> DMatrix<f64> {
    let half = (window / 2).max(1) as f64;
    let at = |row: usize| (row as f64 - (window / 2) as f64) / half;
    DMatrix::from_fn(window, degree + 1, |row, power| at(row).powi(power as i32)).qr().q()
}

/// Returns the weights of the window's samples in the fitted value at one place.
fn sample_weights(basis: &DMatrix<f64>, place: usize) -> Vec<f64> {
    (basis * basis.row(place).transpose()).iter().copied().collect()
}

/// Smooths the measured motions, each segment without gaps separately.
pub(crate) fn smooth_recording(
    recording: &mut Recording,
    smoothing: Smoothing,
    findings: &mut Findings,
) {
    if let Err(refused) = check_settings(smoothing.window, smoothing.degree) {
        return findings.error(None, None, refused.to_string());
    }
    if let Some(k) = find_uneven_step(recording) {
        let message = format!(
            "the step here differs from the median of {:.4} s by more than a tenth, but smoothing \
             needs even steps; resample the file or remove `smoothing`",
            recording.interval_s
        );
        return findings.error(Some(recording.row_number(k)), Some(&recording.time), message);
    }
    // Cloned, since smoothing borrows the recording mutably.
    for segment in recording.segments.clone() {
        smooth_segment(recording, segment, smoothing, findings);
    }
}

fn find_uneven_step(recording: &Recording) -> Option<usize> {
    let (t, interval) = (recording.time(), recording.interval_s);
    let inside = recording.segments.iter().flat_map(|segment| segment.start + 1..segment.end);
    inside.into_iter().find(|&k| ((t[k] - t[k - 1]) / interval - 1.0).abs() > UNEVEN)
}

fn smooth_segment(
    recording: &mut Recording,
    segment: std::ops::Range<usize>,
    smoothing: Smoothing,
    findings: &mut Findings,
) {
    if segment.len() < smoothing.window {
        let message = format!(
            "{} samples between gaps are fewer than the smoothing window and are not smoothed",
            segment.len()
        );
        return findings.warning(Some(recording.row_number(segment.start)), None, message);
    }
    for channel in SMOOTHED {
        if let Some(values) = recording.trial.channels.get_mut(&channel)
            && let Ok(smooth) =
                savitzky_golay(&values[segment.clone()], smoothing.window, smoothing.degree)
        {
            values[segment.clone()].copy_from_slice(&smooth);
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::testing::{finding_messages, test_recording};

    #[test]
    fn scipys_example_comes_out() {
        let smooth = savitzky_golay(&[2.0, 2.0, 5.0, 2.0, 1.0, 0.0, 1.0, 4.0, 9.0], 5, 2).unwrap();
        let scipy =
            [1.65714286, 3.17142857, 3.54285714, 2.85714286, 0.65714286, 0.17142857, 1.0, 4.0, 9.0];
        assert!(smooth.iter().zip(scipy).all(|(a, b)| (a - b).abs() < 1e-8), "{smooth:?}");
    }

    #[test]
    fn a_polynomial_stays_itself_up_to_the_ends() {
        let cubic: Vec<f64> = (0..60).map(|k| (k as f64 * 0.1 - 2.0).powi(3)).collect();
        let smooth = savitzky_golay(&cubic, 21, 3).unwrap();
        assert!(smooth.iter().zip(&cubic).all(|(a, b)| (a - b).abs() < 1e-10));
        assert_eq!(savitzky_golay(&[1.0, 5.0], 1, 0).unwrap(), [1.0, 5.0]);
    }

    #[test]
    fn impossible_settings_are_refused() {
        assert!(savitzky_golay(&[0.0; 9], 4, 2).unwrap_err().to_string().contains("odd"));
        assert!(savitzky_golay(&[0.0; 9], 5, 5).unwrap_err().to_string().contains("less than"));
        assert!(savitzky_golay(&[0.0; 3], 5, 2).unwrap_err().to_string().contains("does not fit"));
    }

    #[test]
    fn smoothing_stops_at_gaps_and_refuses_uneven_steps() {
        let smoothing = Smoothing { window: 5, degree: 1 };
        let step: Vec<f64> = (0..40).map(|k| if k < 20 { 0.0 } else { 1.0 }).collect();
        let mut gap = test_recording(&[(Channel::U, step.clone()), (Channel::Delta, step.clone())]);
        gap.trial.t_s.iter_mut().skip(20).for_each(|t| *t += 10.0);
        gap.settle_time();
        smooth_recording(&mut gap, smoothing, &mut Findings::default());
        assert!(
            gap.channel(Channel::U).unwrap().iter().zip(&step).all(|(a, b)| (a - b).abs() < 1e-12)
        );
        let mut uneven = test_recording(&[(Channel::U, step)]);
        uneven.trial.t_s[7] += 0.2;
        uneven.settle_time();
        let mut findings = Findings::default();
        smooth_recording(&mut uneven, smoothing, &mut findings);
        assert!(finding_messages(findings).starts_with("error Some(9)"));
    }
}
