//! Why nothing can be learned or predicted over a horizon.

use sistership_simulation::recorded::MissingChannel;

/// Why nothing can be learned or predicted over a horizon.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum HorizonError {
    /// A channel is missing.
    #[error(transparent)]
    Channel(#[from] MissingChannel),
    /// What was recorded, or the foundation's track from there, is no number.
    #[error("trial `{trial}`, {t_s} s: what was recorded or the foundation's track is no number")]
    NotANumber {
        /// The trial.
        trial: String,
        /// When, s.
        t_s: f64,
    },
    /// The foundation's track left the physical range.
    #[error(
        "trial `{trial}`, {t_s} s: the foundation's track from there leaves the physical range"
    )]
    Stopped {
        /// The trial.
        trial: String,
        /// When, s.
        t_s: f64,
    },
    /// There is too little to learn from.
    #[error("{found} examples are too few to learn from: {wanted} are needed at least")]
    Few {
        /// How many.
        found: usize,
        /// The fewest.
        wanted: usize,
    },
    /// Examples do not belong together, or not to the network that is trained on.
    #[error("examples have {found} numbers where {wanted} are expected")]
    Shape {
        /// How many.
        found: usize,
        /// How many are expected.
        wanted: usize,
    },
}
