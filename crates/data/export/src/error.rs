//! Why a model cannot be exported.

use sistership_simulation::PlantError;

/// Why a model cannot be exported.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// Part of it was learned, and is no formula.
    #[error(
        "`{0}` has a learned branch, whose weights no exported format carries; export its \
         foundation, the model without `branch`"
    )]
    Branch(String),
    /// An effect delays an input that no steering gear takes.
    #[error("`{model}` carries a lag on `{input}`; exports know lags of the rudder only")]
    Lag {
        /// The model.
        model: String,
        /// The input behind the lag.
        input: String,
    },
    /// An effect keeps an input from what was ordered.
    #[error("`{model}` carries a dead band on `{input}`, which no exported format knows")]
    Band {
        /// The model.
        model: String,
        /// The input with the band.
        input: String,
    },
    /// An effect of the model cannot be used.
    #[error("{field}: {message}")]
    Effect {
        /// The field of the model.
        field: String,
        /// What is wrong with it.
        message: String,
    },
    /// The equations of motion cannot be set up.
    #[error(transparent)]
    Plant(#[from] PlantError),
    /// A file of the export could not be packed.
    #[error("the archive cannot be written: {0}")]
    Archive(String),
}
