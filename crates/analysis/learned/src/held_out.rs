//! Held-out trials for the evaluation of learned corrections, with foundations that may have been
//! fitted without them.

use sistership_model::trial::Trial;
use sistership_model::{Law, Model};

use crate::joined::{JoinError, attach};
use crate::train::{CorrectionTraining, TrainError, train_correction};
use crate::version::with_branch;

/// Largest number of parts in which the trials of one foundation are held out, each once.
const FOLDS: usize = 4;

/// Held-out part of the trials, and the foundation to which a correction trained on the others is
/// added.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldOutFold {
    /// Model without correction.
    pub foundation: Model,
    /// Indices of the held-out trials.
    pub held_out: Vec<usize>,
}

impl HeldOutFold {
    /// Divides the trials into folds with one foundation for all, which may have been fitted to
    /// them: that is in favour of the foundation. Returns no fold if there is only one trial.
    pub fn with_one_foundation(model: &Model, trials: usize) -> Vec<Self> {
        let folds = FOLDS.min(trials);
        // Every n-th trial: adjacent trials fall into different folds.
        let held_out = |fold: usize| (0..trials).filter(|place| place % folds == fold).collect();
        let one = |fold| Self { foundation: model.without_correction(), held_out: held_out(fold) };
        // A single fold would leave no trial to train on.
        if folds < 2 { Vec::new() } else { (0..folds).map(one).collect() }
    }
}

/// Trials for the evaluation of a correction, with their folds.
#[derive(Debug, Clone, Copy)]
pub struct HeldOutTrials<'a> {
    /// Law of the foundations.
    pub law: &'a Law,
    /// All trials.
    pub trials: &'a [&'a Trial],
    /// Folds of the trials.
    pub folds: &'a [HeldOutFold],
}

impl HeldOutTrials<'_> {
    /// Returns a fold's foundation with the correction that is trained on its other trials.
    ///
    /// # Errors
    /// Returns the errors of the training.
    pub fn corrected_model(
        &self,
        fold: &HeldOutFold,
        training: &CorrectionTraining,
    ) -> Result<Model, TrainError> {
        let places = self.trials.iter().enumerate();
        let others = places.filter(|(place, _)| !fold.held_out.contains(place));
        let others: Vec<&Trial> = others.map(|(_, trial)| *trial).collect();
        train_corrected_model(&fold.foundation, self.law, &others, training)
    }
}

/// Returns a foundation with a correction trained on some trials, ready for simulation.
///
/// # Errors
/// Returns the errors of the training.
pub fn train_corrected_model(
    foundation: &Model,
    law: &Law,
    trials: &[&Trial],
    training: &CorrectionTraining,
) -> Result<Model, TrainError> {
    let (branch, weights) = train_correction(foundation, law, trials, training)?;
    let mut both = with_branch(foundation, branch);
    attach(&mut both, &weights.to_bytes()?).map_err(Box::<JoinError>::from)?;
    Ok(both)
}
