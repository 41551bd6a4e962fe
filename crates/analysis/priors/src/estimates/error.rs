//! Errors of the estimate of a ship.

/// Error of the estimate of a ship.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EstimateError {
    /// Particulars without a regression are missing.
    #[error("{ship}: an estimate needs {}; give them under `particulars`", .names.join(", "))]
    Missing {
        /// The ship.
        ship: String,
        /// Their names.
        names: Vec<String>,
    },
    /// No regression gives a value.
    #[error("{ship}: no regression gives `{name}`")]
    NotGiven {
        /// The ship.
        ship: String,
        /// Name of the missing value.
        name: String,
    },
    /// Thrust and resistance have no equilibrium.
    #[error(
        "{ship}: a propeller of {diameter_m:.3} m cannot give the thrust for {speed_m_s} m/s; \
             check diameter and speed"
    )]
    NoBalance {
        /// The ship.
        ship: String,
        /// The propeller.
        diameter_m: f64,
        /// The speed.
        speed_m_s: f64,
    },
    /// A file of the library cannot be read.
    #[error(transparent)]
    File(#[from] sistership_model::FileError),
    /// The law is missing or does not fit.
    #[error("{0}")]
    Law(String),
}
