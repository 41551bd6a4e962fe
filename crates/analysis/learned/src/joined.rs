//! Models with the weights of their learned correction attached, ready for simulation.

use std::sync::Arc;

use sistership_model::branch::CorrectionError;
use sistership_model::learned::AttachedWeights;
use sistership_model::{Law, Model};
use sistership_simulation::{MotionEnvelope, PlantError, Ship};

use crate::learned::LearnedCorrection;
use crate::weights::{CorrectionWeights, WeightsError};

/// Error of attaching a learned correction to a model.
#[derive(Debug, thiserror::Error)]
pub enum JoinError {
    /// The model has no learned correction.
    #[error("`{0}` has no learned correction")]
    None(String),
    /// The document of the correction is invalid.
    #[error("branch.{0}")]
    Branch(#[from] CorrectionError),
    /// The weights are invalid.
    #[error(transparent)]
    Weights(#[from] WeightsError),
    /// The foundation cannot be simulated.
    #[error(transparent)]
    Foundation(#[from] PlantError),
    /// The correction uses channels that a simulation does not provide.
    #[error("branch: only the channels u, v, r, delta and n are allowed in its domain and outputs")]
    Channels,
    /// The correction acts outside the physical range.
    #[error(
        "branch.fade: {fade} lets the correction act outside the physical range; give a \
             smaller value"
    )]
    Reach {
        /// Fade of the correction.
        fade: f64,
    },
}

/// Attaches the weights of a model's learned correction, the bytes that it names by hash, so that
/// [`Ship::new`] simulates the model with its correction.
///
/// # Errors
/// Returns an error that names the faulty part of correction or weights; the model is then
/// unchanged.
pub fn attach(model: &mut Model, weights: &[u8]) -> Result<(), JoinError> {
    let envelope = MotionEnvelope::from_model(model);
    let Some(branch) = &mut model.branch else {
        return Err(JoinError::None(model.name.clone()));
    };
    // Everything that can fail comes before the model is changed.
    branch.check_document()?;
    let weights = CorrectionWeights::read(weights, branch)?;
    let learned = LearnedCorrection::from_branch(branch, weights).ok_or(JoinError::Channels)?;
    // A model without length or speed has no envelope; it is refused when a ship is made of it.
    if envelope.is_some_and(|envelope| !learned.faded_domain().is_within(&envelope)) {
        return Err(JoinError::Reach { fade: branch.fade });
    }
    branch.learned = AttachedWeights::new(Arc::new(learned));
    Ok(())
}

/// Creates a ship from a model with a learned correction; `weights` are the bytes that the
/// correction names by hash. A simulation reports when it left the range covered by trials
/// ([`Ship::leaves`]), outside which the correction fades.
///
/// # Errors
/// Returns an error that names the faulty part of correction, weights or foundation.
pub fn corrected_ship(model: &Model, law: &Law, weights: &[u8]) -> Result<Ship, JoinError> {
    let mut model = model.clone();
    attach(&mut model, weights)?;
    Ok(Ship::new(&model, law)?)
}
