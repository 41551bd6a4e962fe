//! A foundation with a branch as a model of its own.

use sistership_model::Model;
use sistership_model::branch::Branch;
use sistership_model::vessel::Status;

/// The foundation with a learned correction. How far its coefficients may be from the truth stays:
/// they act on the law around the correction as before. What its trials left open of the noise is
/// another matter with the correction, and is left out until it has been learned anew.
pub fn with_branch(foundation: &Model, branch: Branch) -> Model {
    let trials = branch.recipe.trials.len();
    let said = format!("{} of {trials} trials learned beside the law", branch.words());
    let note = foundation.note.as_ref().map_or(said.clone(), |note| format!("{note}; {said}"));
    Model {
        status: Status::Refined,
        note: Some(note),
        uncertainty: None,
        branch: Some(branch),
        ..foundation.clone()
    }
}
