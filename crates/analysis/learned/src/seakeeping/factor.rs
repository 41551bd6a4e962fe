//! Factor between predicted and measured responses.

/// Fits a factor by least squares without an intercept, as a calm sea causes no motion (Kanazawa
/// 2023, Eq. 3.9). Returns `None` if all predictions are zero or a value is not finite.
pub fn fit_factor(predicted: &[f64], measured: &[f64]) -> Option<f64> {
    let product: f64 = predicted.iter().zip(measured).map(|(p, m)| p * m).sum();
    let square: f64 = predicted.iter().map(|p| p * p).sum();
    // The minimum of sum (m - f p)^2 is at f = sum p m / sum p^2.
    (square > 0.0 && product.is_finite()).then(|| product / square)
}
