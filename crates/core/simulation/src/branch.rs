//! What is learned beside a law of motion, as a simulation takes it.

use std::sync::Arc;

use sistership_model::Model;
pub use sistership_model::learned::{
    AdditionFormulas, AdditionGradient, Instant, LAW_RATES, LearnedBranch,
};

use crate::equations::PlantError;

/// What was learned beside a model's law; none where it has no branch.
///
/// # Errors
/// It has one, and its weights have not been attached.
pub fn attached(model: &Model) -> Result<Option<Arc<dyn LearnedBranch>>, PlantError> {
    let Some(branch) = &model.branch else { return Ok(None) };
    let missing =
        || PlantError::Weights { model: model.name.clone(), sha256: branch.weights_sha256.clone() };
    branch.learned.get().cloned().map(Some).ok_or_else(missing)
}
