//! Uncertainty of a figure due to the step of its simulation: ITTC 7.5-03-01-01, sec. 4, a study of
//! convergence with three steps.

/// Order of the integration (classical Runge-Kutta).
const ORDER: f64 = 4.0;
/// Ratio of each step to the next finer one.
const RATIO: f64 = 2.0;
/// Differences below this share of the figure are those of rounding and of the crossing's
/// interpolation: they have no order of convergence.
const ROUNDING: f64 = 1e-7;

/// Returns the uncertainty of the figure at the finest of three steps, each twice the one before:
/// `figures` from the finest to the coarsest. `None` if they diverge.
///
/// With R = e21/e32 between 0 and 1 the error follows by Richardson, d = e21/(r^p - 1) with p =
/// ln(1/R)/ln r, and with C = (r^p - 1)/(r^4 - 1) the uncertainty is (9.6 (1 - C)^2 + 1.1) |d|
/// where |1 - C| < 0.125 and (2 |1 - C| + 1) |d| elsewhere (Wilson, Shao and Stern 2004, J Fluids
/// Eng 126, 704-706). If they oscillate it is half of their range.
pub fn step_uncertainty(figures: [f64; 3]) -> Option<f64> {
    let [fine, medium, coarse] = figures;
    let (e21, e32) = (medium - fine, coarse - medium);
    let largest = e21.abs().max(e32.abs());
    if largest <= ROUNDING * fine.abs() {
        return Some(largest);
    }
    let ratio = e21 / e32;
    if ratio.abs() >= 1.0 || !ratio.is_finite() {
        return None;
    }
    // Oscillating convergence: half the range.
    if ratio <= 0.0 {
        let span = figures.iter().copied().fold(f64::NEG_INFINITY, f64::max)
            - figures.iter().copied().fold(f64::INFINITY, f64::min);
        return Some(0.5 * span);
    }
    // r^p = 1/R.
    let gain = 1.0 / ratio - 1.0;
    let error = (e21 / gain).abs();
    let correction = gain / (RATIO.powf(ORDER) - 1.0);
    let off = (1.0 - correction).abs();
    let factor = if off < 0.125 { 9.6 * off * off + 1.1 } else { 2.0 * off + 1.0 };
    Some(factor * error)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn steps_of_fourth_order_leave_their_error() {
        // 10 + 0.001 h^4 at h = 1, 2, 4: e21 = 0.015, e32 = 0.24, R = 1/16, d = 0.001, C = 1.
        let figures = [1.0_f64, 2.0, 4.0].map(|h| 10.0 + 0.001 * h.powi(4));
        assert!((step_uncertainty(figures).unwrap() - 1.1e-3).abs() < 1e-12);
    }

    #[test]
    fn steps_of_second_order_are_less_certain() {
        // 10 + 0.01 h^2: e21 = 0.03, e32 = 0.12, R = 1/4, d = 0.03/3 = 0.01, C = 3/15 = 0.2,
        // 2 * 0.8 + 1 = 2.6.
        let figures = [1.0_f64, 2.0, 4.0].map(|h| 10.0 + 0.01 * h.powi(2));
        assert!((step_uncertainty(figures).unwrap() - 0.026).abs() < 1e-12);
    }

    #[test]
    fn swinging_figures_have_half_their_span_and_diverging_ones_none() {
        assert!((step_uncertainty([10.0, 10.1, 9.8]).unwrap() - 0.15).abs() < 1e-12);
        assert_eq!(step_uncertainty([10.0, 10.3, 10.4]), None);
        assert!(step_uncertainty([10.0, 10.0 + 1e-8, 10.0]).unwrap() < 2e-8);
    }
}
