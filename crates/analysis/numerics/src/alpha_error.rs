//! Error on held-out samples as a function of alpha, the share of the zero vector in the prior.

use std::ops::Add;

/// Mean squared error that is quadratic in the weight `w = 1 - alpha` of the source's coefficients:
/// `constant + linear w + square w^2`. Errors on several sets of samples add up to one such
/// function.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct AlphaError {
    pub(super) constant: f64,
    pub(super) linear: f64,
    pub(super) square: f64,
}

impl AlphaError {
    /// Error at an alpha.
    pub fn error_at(self, alpha: f64) -> f64 {
        let weight = 1.0 - alpha;
        self.constant + self.linear * weight + self.square * weight * weight
    }

    /// Returns the alpha from 0 to `alpha_max` with the least error, and that error; alpha is 0 if
    /// the error does not depend on it.
    pub fn least_error(self, alpha_max: f64) -> (f64, f64) {
        // Minimum of the parabola in the weight; without curvature, the full weight of the source.
        let stationary = if self.square > 0.0 { -self.linear / (2.0 * self.square) } else { 1.0 };
        let alpha = 1.0 - stationary.clamp(1.0 - alpha_max, 1.0);
        (alpha, self.error_at(alpha))
    }
}

impl Add for AlphaError {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            constant: self.constant + other.constant,
            linear: self.linear + other.linear,
            square: self.square + other.square,
        }
    }
}

impl std::iter::Sum for AlphaError {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), Add::add)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `(w - 0.7)^2 + 2`, whose least is at alpha 0.3.
    const ERROR: AlphaError = AlphaError { constant: 2.49, linear: -1.4, square: 1.0 };

    #[test]
    fn the_least_is_within_the_range() {
        for (alpha_max, least) in [(1.0, 0.3), (0.1, 0.1), (0.0, 0.0)] {
            let (alpha, error) = ERROR.least_error(alpha_max);
            assert!((alpha - least).abs() < 1e-12, "{alpha_max}: {alpha}");
            assert!((error - (2.0 + (0.3 - least).powi(2))).abs() < 1e-12, "{error}");
        }
        let beyond = AlphaError { linear: -4.0, ..ERROR };
        assert_eq!(beyond.least_error(1.0).0, 0.0);
    }

    #[test]
    fn an_error_that_does_not_depend_on_alpha_keeps_the_source() {
        let flat = AlphaError { constant: 3.0, linear: 0.0, square: 0.0 };
        assert_eq!(flat.least_error(1.0), (0.0, 3.0));
    }

    #[test]
    fn errors_add_up_to_one_function() {
        let other = AlphaError { constant: 1.0, linear: -0.2, square: 4.0 };
        let sum: AlphaError = [ERROR, other].into_iter().sum();
        for alpha in [0.0, 0.4, 1.0] {
            assert!(
                (sum.error_at(alpha) - ERROR.error_at(alpha) - other.error_at(alpha)).abs() < 1e-12
            );
        }
        // 5 w^2 - 1.6 w: least at w = 0.16.
        assert!((sum.least_error(1.0).0 - 0.84).abs() < 1e-12);
    }
}
