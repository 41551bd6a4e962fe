//! What a learned correction stands beside: a refinement and the models of its folds.

use sistership_identification::refine::{FoldModel, Refinement, Request};
use sistership_learned::HeldOutFold;
use sistership_model::trial::Trial;

/// What a correction may be learned beside.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Foundation<'a> {
    /// The refinement that was chosen, as an explicit request.
    pub request: Request<'a>,
    /// What it gave.
    pub refinement: &'a Refinement,
    /// The models of its folds; none of the source as carried over, which has seen no trial.
    pub folds: &'a [FoldModel],
    /// The trials that have a say.
    pub trials: &'a [&'a Trial],
}

impl Foundation<'_> {
    /// The folds with models that have not seen what they hold out; none where they held out parts
    /// of trials.
    pub(crate) fn held_out(&self) -> Vec<HeldOutFold> {
        if self.folds.is_empty() && self.refinement.is_source_kept() {
            return HeldOutFold::of_one(&self.refinement.model, self.trials.len());
        }
        let one = |fold: &FoldModel| HeldOutFold {
            foundation: fold.model.foundation(),
            held_out: fold.held_out.clone(),
        };
        self.folds.iter().map(one).collect()
    }
}
