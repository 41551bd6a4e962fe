//! Joint uncertainty of the coefficients of a refined model.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::triangle::{self, TriangleError};

/// Errors of estimated coefficients as a normal distribution about the estimate: variances of the
/// estimator through the scatter of the trials, and of what the prior adds where it holds.
/// docs/decisions/0012 says what an interval means.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Posterior {
    /// Names of the coefficients.
    pub names: Vec<String>,
    /// The estimates to which it belongs, in the units of the coefficients; a model with other
    /// values has no posterior.
    pub values: Vec<f64>,
    /// Standard deviations, in the units of the coefficients.
    pub deviations: Vec<f64>,
    /// Lower triangle of the Cholesky root of the correlations, one string per row: numbers up to
    /// the diagonal, separated by spaces.
    pub root_correlation: Vec<String>,
}

/// Reason for which a posterior cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PosteriorError {
    /// Lists differ in length.
    #[error("names, values and deviations should have the same number")]
    Lists,
    /// A deviation is negative.
    #[error("deviations should be at least 0")]
    Deviations,
    /// The root of the correlations is not a lower triangle.
    #[error(transparent)]
    Root(#[from] TriangleError),
}

impl Posterior {
    /// Formats a lower triangle row by row; `entry(i, j)` for `j <= i`.
    pub fn format_rows(size: usize, entry: &dyn Fn(usize, usize) -> f64) -> Vec<String> {
        let row = |i: usize| {
            (0..=i).map(|j| format!("{:.5e}", entry(i, j))).collect::<Vec<_>>().join(" ")
        };
        (0..size).map(row).collect()
    }

    /// Root of the covariance, row by row up to the diagonal, in the units of the coefficients.
    ///
    /// # Errors
    /// Returns an error that names the row of a wrong length, or with an entry that is not a
    /// number.
    pub fn covariance_root(&self) -> Result<Vec<Vec<f64>>, TriangleError> {
        let rows = triangle::read_rows(
            "root_correlation",
            &self.root_correlation,
            self.names.len(),
            |place| place + 1,
        )?;
        // The root of the correlations times the deviations, row by row, is that of the covariance.
        let scaled =
            |(row, deviation): (Vec<f64>, &f64)| row.into_iter().map(|x| x * deviation).collect();
        Ok(rows.into_iter().zip(&self.deviations).map(scaled).collect())
    }

    /// Returns true if it belongs to coefficients with these values.
    pub fn belongs_to(&self, value: impl Fn(&str) -> Option<f64>) -> bool {
        self.names.iter().zip(&self.values).all(|(name, about)| value(name) == Some(*about))
    }

    /// Standard deviations by name.
    pub fn deviations_by_name(&self) -> BTreeMap<&str, f64> {
        self.names.iter().map(String::as_str).zip(self.deviations.iter().copied()).collect()
    }

    /// Checks that the lists are consistent.
    ///
    /// # Errors
    /// Returns an error that names the inconsistent lists.
    pub fn check_lists(&self) -> Result<(), PosteriorError> {
        let size = self.names.len();
        if self.values.len() != size || self.deviations.len() != size {
            return Err(PosteriorError::Lists);
        }
        if !self.deviations.iter().all(|d| *d >= 0.0 && d.is_finite()) {
            return Err(PosteriorError::Deviations);
        }
        self.covariance_root()?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn posterior() -> Posterior {
        Posterior {
            names: vec!["Y_v".into(), "N_v".into()],
            values: vec![-1.0, 2.0],
            deviations: vec![0.1, 0.2],
            root_correlation: Posterior::format_rows(2, &|i, j| [[1.0, 0.0], [0.6, 0.8]][i][j]),
        }
    }

    #[test]
    fn the_root_is_in_the_units_of_the_coefficients() {
        let root = posterior().covariance_root().unwrap();
        assert!(
            (root[0][0] - 0.1).abs() < 1e-12
                && (root[1][0] - 0.12).abs() < 1e-12
                && (root[1][1] - 0.16).abs() < 1e-12
        );
    }

    #[test]
    fn lists_that_do_not_go_together_are_named() {
        assert_eq!(posterior().check_lists(), Ok(()));
        let short = Posterior { root_correlation: vec!["1".into(), "0.6".into()], ..posterior() };
        assert!(short.check_lists().unwrap_err().to_string().contains("row 2"));
        assert!(Posterior { deviations: vec![0.1], ..posterior() }.check_lists().is_err());
        assert!(
            Posterior { deviations: vec![0.1, f64::NAN], ..posterior() }.check_lists().is_err()
        );
    }

    #[test]
    fn other_coefficients_have_lost_it() {
        let posterior = posterior();
        assert!(posterior.belongs_to(|name| Some(if name == "Y_v" { -1.0 } else { 2.0 })));
        assert!(!posterior.belongs_to(|_| Some(-1.0)) && !posterior.belongs_to(|_| None));
    }
}
