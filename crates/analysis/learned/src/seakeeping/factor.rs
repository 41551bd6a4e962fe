//! The factor between what responses give and what was measured.

/// Least squares without an intercept, as no sea moves no ship (Kanazawa 2023, Eq. 3.9); none where
/// nothing was predicted.
pub fn factor(predicted: &[f64], measured: &[f64]) -> Option<f64> {
    let product: f64 = predicted.iter().zip(measured).map(|(p, m)| p * m).sum();
    let square: f64 = predicted.iter().map(|p| p * p).sum();
    (square > 0.0 && product.is_finite()).then(|| product / square)
}
