//! Why a ship cannot be estimated.

/// Why a ship cannot be estimated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EstimateError {
    /// Particulars that no regression replaces.
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
        /// What is missing.
        name: String,
    },
    /// Thrust and resistance find no balance.
    #[error("{ship}: the propeller of {diameter_m:.3} m cannot drive it at {speed_m_s} m/s")]
    NoBalance {
        /// The ship.
        ship: String,
        /// The propeller.
        diameter_m: f64,
        /// The speed.
        speed_m_s: f64,
    },
    /// A file of the library does not read.
    #[error(transparent)]
    File(#[from] sistership_model::FileError),
    /// The law is missing or does not fit.
    #[error("{0}")]
    Law(String),
}
