//! Weights of a learned correction as bytes, which its document names by hash.

use serde::{Deserialize, Serialize};
use sistership_model::branch::CorrectionDocument;
use sistership_model::coefficient::Axis;
use sistership_model::version::sha256_hex;

use crate::regressor::OutputRegressor;

/// Weights of the outputs, in the order of the correction's outputs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CorrectionWeights {
    /// Regressor of each output.
    pub outputs: Vec<OutputRegressor>,
}

/// Error of weights that do not belong to a correction.
#[derive(Debug, thiserror::Error)]
pub enum WeightsError {
    /// The hash differs.
    #[error("branch.weights_sha256: is {named}, but the weights given have the hash {found}")]
    Hash {
        /// Hash in the document.
        named: String,
        /// Hash of the weights.
        found: String,
    },
    /// The weights cannot be read.
    #[error("weights: {0}")]
    Json(#[from] serde_json::Error),
    /// The number of weights differs from the number of outputs.
    #[error("weights.outputs: there are {found}, but the correction has {wanted} outputs")]
    Count {
        /// Number of weights.
        found: usize,
        /// Number of outputs.
        wanted: usize,
    },
    /// The weights are of another kind than in the recipe, or of another shape.
    #[error("weights.outputs.{axis}: do not match the kind of the recipe or its {inputs} inputs")]
    Shape {
        /// Axis of the output.
        axis: Axis,
        /// Number of its inputs.
        inputs: usize,
    },
}

impl CorrectionWeights {
    /// Returns the weights as JSON bytes. Numbers are written so that they are read back to the
    /// last bit.
    ///
    /// # Errors
    /// Returns an error only for weights that no training gives, such as numbers that are not
    /// finite.
    pub fn to_bytes(&self) -> Result<Vec<u8>, WeightsError> {
        Ok(serde_json::to_vec(self)?)
    }

    /// Reads the weights of a correction from their bytes.
    ///
    /// # Errors
    /// Returns an error if they are not the weights that the correction names, or do not fit it.
    pub fn read(bytes: &[u8], branch: &CorrectionDocument) -> Result<Self, WeightsError> {
        // The hash is checked before the bytes are parsed.
        let found = sha256_hex(bytes);
        if found != branch.weights_sha256 {
            return Err(WeightsError::Hash { named: branch.weights_sha256.clone(), found });
        }
        let weights: Self = serde_json::from_slice(bytes)?;
        weights.check_shape(branch)?;
        Ok(weights)
    }

    /// Checks that each output has one regressor of the recipe's kind and of its shape.
    fn check_shape(&self, branch: &CorrectionDocument) -> Result<(), WeightsError> {
        let (found, wanted) = (self.outputs.len(), branch.outputs.len());
        if found != wanted {
            return Err(WeightsError::Count { found, wanted });
        }
        for (output, regressor) in branch.outputs.iter().zip(&self.outputs) {
            let inputs = output.inputs.len();
            if !(regressor.matches_learner(&branch.recipe.learner) && regressor.is_sound(inputs)) {
                return Err(WeightsError::Shape { axis: output.axis, inputs });
            }
        }
        Ok(())
    }
}
