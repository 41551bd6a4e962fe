//! Why a model cannot be exported.

use sistership_simulation::PlantError;

/// Why a model cannot be exported.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// What it has learned follows accelerations that exports do not have.
    #[error(
        "`{model}` has a learned correction that is told the accelerations of the law `{law}`, \
         whose masses change with the motion: exports solve such a law after all else; train a \
         parallel correction, or export the model without `branch`"
    )]
    Correction {
        /// The model.
        model: String,
        /// Its law.
        law: String,
    },
    /// An effect delays an input that no steering gear takes.
    #[error("`{model}` carries a lag on `{input}`; exports know lags of the rudder only")]
    Lag {
        /// The model.
        model: String,
        /// The input behind the lag.
        input: String,
    },
    /// An effect keeps an input from what was ordered that no steering gear takes.
    #[error("`{model}` carries a dead band on `{input}`; exports know that of the rudder only")]
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
