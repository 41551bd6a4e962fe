//! Access to the learned correction of a model for simulations.

use std::sync::Arc;

use sistership_model::Model;
pub use sistership_model::learned::{
    AdditionFormulas, AdditionGradient, CorrectionInstant, CorrectionModel, LAW_RATES,
};

use crate::equations::PlantError;

/// Returns the learned correction of a model; `None` for a model without one.
///
/// # Errors
/// Returns an error if the model has a learned correction whose weights have not been attached.
pub fn attached_correction(model: &Model) -> Result<Option<Arc<dyn CorrectionModel>>, PlantError> {
    let Some(branch) = &model.branch else { return Ok(None) };
    let missing =
        || PlantError::Weights { model: model.name.clone(), sha256: branch.weights_sha256.clone() };
    branch.learned.get().cloned().map(Some).ok_or_else(missing)
}
