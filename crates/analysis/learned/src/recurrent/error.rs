//! Errors of training on sequences.

use crate::setting_error::SettingError;

/// Error of training on sequences of states.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SequenceError {
    /// A setting is out of range.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// There is no motion, or one without samples.
    #[error("give motions of at least one sample")]
    Empty,
    /// The motions differ in their channels.
    #[error("the motions have different channels; give trials with the same ones")]
    Channels,
    /// No sequence is left to train on.
    #[error(
        "{found} sequences are too few for training: give trials with at least {wanted} \
             samples"
    )]
    Few {
        /// Number of sequences.
        found: usize,
        /// Smallest number of samples of one trial.
        wanted: usize,
    },
}
