//! A model's law of motion with its branch: a ship that sails by both.

use std::sync::Arc;

use sistership_dynamics::{PlantError, Ship};
use sistership_model::branch::{Branch, BranchError};
use sistership_model::{Law, Model};

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

/// Makes a model with a branch ready; `weights` are the bytes that the branch names by hash. Runs
/// say how they left what the trials covered ([`Ship::leaves`]), outside which the branch fades.
///
/// # Errors
/// Names what of branch, weights or foundation is at fault.
pub fn ship(model: &Model, law: &Law, weights: &[u8]) -> Result<Ship, JoinError> {
    let branch = model.branch.as_ref().ok_or_else(|| JoinError::None(model.name.clone()))?;
    branch.check()?;
    let learned = learned(branch, Weights::read(weights, branch)?)?;
    // Where nobody says what the foundation's trials covered, runs tell when the branch fades.
    let validity = model.validity.clone().or_else(|| Some(branch.domain.clone()));
    let foundation = Ship::new(&Model { validity, ..foundation(model) }, law)?;
    if !learned.domain().is_within(foundation.envelope()) {
        return Err(JoinError::Reach { fade: branch.fade });
    }
    Ok(foundation.with_branch(Arc::new(learned)))
}

/// The branch ready to be asked.
fn learned(branch: &Branch, weights: Weights) -> Result<Learned, JoinError> {
    Learned::of(branch, weights).ok_or(JoinError::Channels)
}

/// The model without its branch.
pub fn foundation(model: &Model) -> Model {
    Model { branch: None, ..model.clone() }
}
