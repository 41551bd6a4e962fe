//! Rows of a regression from the equations of motion.

use sistership_model::trial::Trial;

use super::blocks::RegressionBlocks;
use super::outcome::RefineError;
use super::rows::{RegressionTable, trial_moments, trial_tables};
use super::thresholds::SELECTION;
use super::weak::{WindowSpacing, weak_moments, weak_tables};
use sistership_numerics::RegressionMoments;

/// Methods by which the equations of motion become rows of a regression.
#[derive(Debug, Clone, Copy)]
pub(super) enum EquationForm {
    /// Accelerations by differences over a time, s; over one sampling interval if none is given.
    Differences(Option<f64>),
    /// Integrals over windows (the weak form).
    Windows(WindowSpacing),
}

impl EquationForm {
    /// Returns the statistics of a trial, one set for each regression.
    pub fn regression_moments(
        self,
        blocks: &RegressionBlocks,
        trial: &Trial,
    ) -> Result<Vec<RegressionMoments>, RefineError> {
        match self {
            Self::Windows(windows) => weak_moments(blocks, trial, windows),
            Self::Differences(difference_s) => trial_moments(blocks, trial, difference_s),
        }
    }

    /// Returns the rows behind the statistics, one table for each regression.
    pub fn regression_tables(
        self,
        blocks: &RegressionBlocks,
        part: &Trial,
    ) -> Result<Vec<RegressionTable>, RefineError> {
        match self {
            Self::Windows(windows) => weak_tables(blocks, part, windows),
            Self::Differences(difference_s) => {
                trial_tables(blocks, part, difference_s, &|_, _| 0.0)
            }
        }
    }

    /// Description of its rows for messages.
    pub fn describe_rows(self) -> String {
        match self {
            Self::Differences(None) => "differences of samples".to_owned(),
            Self::Differences(Some(difference_s)) => {
                format!("differences over {difference_s:.2} s")
            }
            Self::Windows(windows) => format!("windows of {:.2} s", windows.length_s),
        }
    }

    /// Returns true if a row is a difference of samples; the mean of all rows then has no
    /// information on the coefficients.
    pub fn are_differences(self) -> bool {
        matches!(self, Self::Differences(_))
    }

    /// Number of neighbouring rows that share most of their information, at a sampling interval of
    /// `interval_s`.
    pub fn dependent_rows(self, interval_s: f64) -> usize {
        match self {
            Self::Differences(Some(difference_s)) => (difference_s / interval_s).round() as usize,
            Self::Differences(None) | Self::Windows(_) => 1,
        }
    }

    /// Number of rows in the time of one, as far as they overlap: rows that count as one.
    pub fn overlapping_rows(self) -> f64 {
        match self {
            Self::Differences(_) => 1.0,
            Self::Windows(windows) => (windows.length_s / windows.hop_s).max(1.0),
        }
    }

    /// Smallest number of samples for `widest` coefficients an axis. Windows depend on each other
    /// far less than differences.
    pub fn least_samples(self, widest: f64) -> f64 {
        if self.are_differences() { SELECTION.samples_a_coefficient * widest } else { widest }
    }
}
