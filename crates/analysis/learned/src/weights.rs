//! The weights of a branch as bytes, which its document names by hash.

use serde::{Deserialize, Serialize};
use sistership_model::branch::Branch;
use sistership_model::coefficient::Axis;
use sistership_model::version::sha256;

use crate::regressor::Regressor;

/// Weights of the outputs, in the order of the branch's.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Weights {
    /// What was learned of each.
    pub outputs: Vec<Regressor>,
}

/// Why weights are not those of a branch.
#[derive(Debug, thiserror::Error)]
pub enum WeightsError {
    /// They are others.
    #[error("branch.weights_sha256: names {named}, but the weights given have {found}")]
    Hash {
        /// The hash in the document.
        named: String,
        /// Theirs.
        found: String,
    },
    /// They cannot be read.
    #[error("weights: {0}")]
    Json(#[from] serde_json::Error),
    /// There are more or fewer than outputs.
    #[error("weights.outputs: there are {found}, and the branch has {wanted} outputs")]
    Count {
        /// How many.
        found: usize,
        /// How many outputs.
        wanted: usize,
    },
    /// They are of another kind than the recipe says, or of another shape.
    #[error("weights.outputs.{axis}: not of the recipe's kind, or not for {inputs} inputs")]
    Shape {
        /// The output.
        axis: Axis,
        /// Its inputs.
        inputs: usize,
    },
}

impl Weights {
    /// Their bytes. Numbers are written so that they are read back to the last bit.
    ///
    /// # Errors
    /// None that weights which were trained could cause.
    pub fn bytes(&self) -> Result<Vec<u8>, WeightsError> {
        Ok(serde_json::to_vec(self)?)
    }

    /// The weights of a branch from their bytes.
    ///
    /// # Errors
    /// Says that they are not the ones that it names, or do not suit it.
    pub fn read(bytes: &[u8], branch: &Branch) -> Result<Self, WeightsError> {
        let found = sha256(bytes);
        if found != branch.weights_sha256 {
            return Err(WeightsError::Hash { named: branch.weights_sha256.clone(), found });
        }
        let weights: Self = serde_json::from_slice(bytes)?;
        weights.check(branch)?;
        Ok(weights)
    }

    /// Checks that there is one of the recipe's kind and shape for each output.
    fn check(&self, branch: &Branch) -> Result<(), WeightsError> {
        let (found, wanted) = (self.outputs.len(), branch.outputs.len());
        if found != wanted {
            return Err(WeightsError::Count { found, wanted });
        }
        for (output, regressor) in branch.outputs.iter().zip(&self.outputs) {
            let inputs = output.inputs.len();
            if !(regressor.is_of(&branch.recipe.learner) && regressor.is_sound(inputs)) {
                return Err(WeightsError::Shape { axis: output.axis, inputs });
            }
        }
        Ok(())
    }
}
