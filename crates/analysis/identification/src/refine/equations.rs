//! How the equations of motion become rows of a regression.

use sistership_model::trial::Trial;

use super::blocks::Blocks;
use super::outcome::RefineError;
use super::rows::{Table, trial_moments, trial_tables};
use super::thresholds::SELECTION;
use super::weak::{Windows, weak_moments, weak_tables};
use sistership_numerics::Moments;

/// How the equations of motion become rows of a regression.
#[derive(Debug, Clone, Copy)]
pub(super) enum Equations {
    /// Accelerations by differences over a time, s; over one sampling interval where none is given.
    Differences(Option<f64>),
    /// Integrals over windows.
    Windows(Windows),
}

impl Equations {
    /// Statistics of a trial, one set for each regression.
    pub fn moments(self, blocks: &Blocks, trial: &Trial) -> Result<Vec<Moments>, RefineError> {
        match self {
            Self::Windows(windows) => weak_moments(blocks, trial, windows),
            Self::Differences(difference_s) => trial_moments(blocks, trial, difference_s),
        }
    }

    /// The rows behind the statistics.
    pub fn tables(self, blocks: &Blocks, part: &Trial) -> Result<Vec<Table>, RefineError> {
        match self {
            Self::Windows(windows) => weak_tables(blocks, part, windows),
            Self::Differences(difference_s) => {
                trial_tables(blocks, part, difference_s, &|_, _| 0.0)
            }
        }
    }

    /// What its rows are, for people.
    pub fn rows(self) -> String {
        match self {
            Self::Differences(None) => "differences of samples".to_owned(),
            Self::Differences(Some(difference_s)) => {
                format!("differences over {difference_s:.2} s")
            }
            Self::Windows(windows) => format!("windows of {:.2} s", windows.length_s),
        }
    }

    /// Whether a row is a difference of samples; then the mean of all rows says nothing of the
    /// coefficients.
    pub fn are_differences(self) -> bool {
        matches!(self, Self::Differences(_))
    }

    /// How many neighbouring rows share most of what they say.
    pub fn dependent_rows(self, interval_s: f64) -> usize {
        match self {
            Self::Differences(Some(difference_s)) => (difference_s / interval_s).round() as usize,
            Self::Differences(None) | Self::Windows(_) => 1,
        }
    }

    /// The fewest samples for so many coefficients an axis. Windows are far less dependent than
    /// differences a sample.
    pub fn least_samples(self, widest: f64) -> f64 {
        if self.are_differences() { SELECTION.samples_a_coefficient * widest } else { widest }
    }
}
