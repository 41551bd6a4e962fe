//! The base of a learned correction: a refinement and the models of its folds.

use sistership_identification::refine::{FoldModel, Refinement, RefinementSpec};
use sistership_learned::HeldOutFold;
use sistership_model::trial::Trial;

/// The base of a learned correction.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CorrectionBase<'a> {
    /// The request that gives the chosen refinement.
    pub request: RefinementSpec<'a>,
    /// The chosen refinement.
    pub refinement: &'a Refinement,
    /// Models of its folds; none for the transferred source, which has seen no trial.
    pub folds: &'a [FoldModel],
    /// Trials that are used.
    pub trials: &'a [&'a Trial],
}

impl CorrectionBase<'_> {
    /// Returns the folds with base models that have not seen the trials held out; empty if trials
    /// were held out in parts.
    pub(crate) fn held_out_folds(&self) -> Vec<HeldOutFold> {
        if self.folds.is_empty() && self.refinement.is_source_kept() {
            return HeldOutFold::with_one_foundation(&self.refinement.model, self.trials.len());
        }
        let one = |fold: &FoldModel| HeldOutFold {
            foundation: fold.model.without_correction(),
            held_out: fold.held_out.clone(),
        };
        self.folds.iter().map(one).collect()
    }
}
