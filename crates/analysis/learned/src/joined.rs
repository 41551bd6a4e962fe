//! A model with the weights of its branch, so that it sails by both halves.

use std::sync::Arc;

use sistership_model::branch::BranchError;
use sistership_model::learned::Attached;
use sistership_model::{Law, Model};
use sistership_simulation::{Envelope, PlantError, Ship};

use crate::learned::Learned;
use crate::weights::{Weights, WeightsError};

/// Why a model cannot be sailed with its branch.
#[derive(Debug, thiserror::Error)]
pub enum JoinError {
    /// It has none.
    #[error("`{0}` has no learned branch")]
    None(String),
    /// The document is at fault.
    #[error("branch.{0}")]
    Branch(#[from] BranchError),
    /// The weights are.
    #[error(transparent)]
    Weights(#[from] WeightsError),
    /// The foundation cannot be sailed.
    #[error(transparent)]
    Foundation(#[from] PlantError),
    /// It asks for what it cannot see.
    #[error("branch: its domain or an output has channels beside u, v, r, delta and n")]
    Channels,
    /// It reaches where no simulation may go.
    #[error("branch.fade: {fade} lets it act beyond the physical range; give less")]
    Reach {
        /// The fade.
        fade: f64,
    },
}

/// Attaches the weights of a model's branch, the bytes that it names by hash, so that
/// [`Ship::new`] sails it by both halves.
///
/// # Errors
/// Names what of branch or weights is at fault; the model stays as it is.
pub fn attach(model: &mut Model, weights: &[u8]) -> Result<(), JoinError> {
    let envelope = Envelope::of(model);
    let Some(branch) = &mut model.branch else {
        return Err(JoinError::None(model.name.clone()));
    };
    branch.check()?;
    let weights = Weights::read(weights, branch)?;
    let learned = Learned::of(branch, weights).ok_or(JoinError::Channels)?;
    // A model without length or speed does not sail at all, and says so then.
    if envelope.is_some_and(|envelope| !learned.domain().is_within(&envelope)) {
        return Err(JoinError::Reach { fade: branch.fade });
    }
    branch.learned = Attached::new(Arc::new(learned));
    Ok(())
}

/// Makes a model with a branch ready; `weights` are the bytes that the branch names by hash. Runs
/// say how they left what the trials covered ([`Ship::leaves`]), outside which the branch fades.
///
/// # Errors
/// Names what of branch, weights or foundation is at fault.
pub fn ship(model: &Model, law: &Law, weights: &[u8]) -> Result<Ship, JoinError> {
    let mut model = model.clone();
    attach(&mut model, weights)?;
    Ok(Ship::new(&model, law)?)
}
