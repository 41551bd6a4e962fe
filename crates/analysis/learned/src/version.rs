//! Models made of a foundation and a learned correction.

use sistership_model::Model;
use sistership_model::branch::CorrectionDocument;
use sistership_model::vessel::Status;

/// Returns the foundation with a learned correction as a new model. The uncertainty of its
/// coefficients stays: they act on the law around the correction as before. The noise estimated
/// from its trials does not apply with the correction, and is removed until it has been estimated
/// again.
pub fn with_branch(foundation: &Model, branch: CorrectionDocument) -> Model {
    let trials = branch.recipe.trials.len();
    let said = format!("learned correction ({}) from {trials} trials", branch.describe());
    let note = foundation.note.as_ref().map_or(said.clone(), |note| format!("{note}; {said}"));
    Model {
        status: Status::Refined,
        note: Some(note),
        // The noise was estimated without the correction and does not apply to the new model.
        uncertainty: None,
        branch: Some(branch),
        ..foundation.clone()
    }
}
