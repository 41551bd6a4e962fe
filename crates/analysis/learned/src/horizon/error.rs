//! Errors of learning and prediction over a horizon.

use sistership_model::trial_input::MissingInput;

use crate::setting_error::SettingError;

/// Error of learning or prediction over a horizon.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum HorizonError {
    /// A setting is out of range.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// A channel or an input of the law is missing.
    #[error(transparent)]
    Input(#[from] MissingInput),
    /// A recorded value, or the foundation's track from there, is not a finite number.
    #[error(
        "trial `{trial}`, {t_s} s: the record or the simulation by the foundation is not a \
             finite number"
    )]
    NotANumber {
        /// Name of the trial.
        trial: String,
        /// Time of the sample, s.
        t_s: f64,
    },
    /// The foundation's track left the physical range.
    #[error(
        "trial `{trial}`, {t_s} s: the simulation by the foundation from there leaves the \
         physical range"
    )]
    Stopped {
        /// Name of the trial.
        trial: String,
        /// Time of the sample, s.
        t_s: f64,
    },
    /// There are too few examples.
    #[error("{found} examples are too few for training: at least {wanted} are needed")]
    Few {
        /// Number of examples.
        found: usize,
        /// Smallest number that is accepted.
        wanted: usize,
    },
    /// Examples differ in size, or do not fit the network.
    #[error("examples have {found} numbers where {wanted} are expected")]
    Shape {
        /// Size found.
        found: usize,
        /// Expected size.
        wanted: usize,
    },
}
