//! Errors of an export.

use sistership_simulation::PlantError;

/// Error of an export.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The learned correction depends on accelerations that exports do not have.
    #[error(
        "`{model}` has a learned correction with the accelerations of the law `{law}` as inputs, \
         but the masses of this law change with the motion, which exports do not support; train a \
         parallel correction, or export the model without `branch`"
    )]
    Correction {
        /// Name of the model.
        model: String,
        /// Name of its law.
        law: String,
    },
    /// An effect delays an input that has no steering gear.
    #[error("`{model}` has a lag of `{input}`; exports support a lag of the rudder only")]
    Lag {
        /// Name of the model.
        model: String,
        /// Delayed input.
        input: String,
    },
    /// An effect puts a dead band on an input that has no steering gear.
    #[error(
        "`{model}` has a dead band of `{input}`; exports support a dead band of the rudder \
             only"
    )]
    Band {
        /// Name of the model.
        model: String,
        /// Input with the dead band.
        input: String,
    },
    /// An effect of the model cannot be used.
    #[error("{field}: {message}")]
    Effect {
        /// Field of the model.
        field: String,
        /// Fault of the field.
        message: String,
    },
    /// The equations of motion cannot be set up.
    #[error(transparent)]
    Plant(#[from] PlantError),
    /// A file of the export could not be packed.
    #[error("the archive cannot be written: {0}")]
    Archive(String),
}
