//! A foundation with a branch as a model of its own.

use sistership_model::Model;
use sistership_model::branch::Branch;
use sistership_model::vessel::Status;

/// The foundation with a branch. How sure its coefficients and the standard manoeuvres were says
/// nothing of what sails now, and is left out.
pub fn with_branch(foundation: &Model, branch: Branch) -> Model {
    let trials = branch.recipe.trials.len();
    let said = format!("{} of {trials} trials learned beside the law", branch.words());
    let note = foundation.note.as_ref().map_or(said.clone(), |note| format!("{note}; {said}"));
    Model {
        status: Status::Refined,
        note: Some(note),
        uncertainty: None,
        posterior: None,
        branch: Some(branch),
        ..foundation.clone()
    }
}
