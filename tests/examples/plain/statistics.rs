//! Figures over many ships.

/// What a call's error counts as where it made no model, or one that leaves the physical range;
/// larger ones count as this.
pub const WORST: f64 = 10.0;

/// An error for averages.
pub fn counted(error: Option<f64>) -> f64 {
    error.filter(|error| error.is_finite()).map_or(WORST, |error| error.min(WORST))
}

/// The geometric mean; not a number where there is nothing.
pub fn geometric_mean(values: &[f64]) -> f64 {
    let logarithms: f64 = values.iter().map(|value| value.ln()).sum();
    (logarithms / values.len() as f64).exp()
}

/// The middle one.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

/// The largest.
pub fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}
