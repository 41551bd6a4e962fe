//! Trials that are held out of a learned correction's training, with foundations that have not seen
//! them either.

use sistership_model::trial::Trial;
use sistership_model::{Law, Model};

use crate::joined::{JoinError, attach};
use crate::train::{TrainError, Training, train};
use crate::version::with_branch;

/// Most parts in which the trials of one foundation are held out, each once.
const FOLDS: usize = 4;

/// A part of the trials that is held out, and the foundation beside which a correction is trained
/// on the others.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldOutFold {
    /// The foundation.
    pub foundation: Model,
    /// The places of the trials that are held out.
    pub held_out: Vec<usize>,
}

impl HeldOutFold {
    /// Parts of as many trials, with one foundation for all, which may have seen them: that favours
    /// the foundation. None where there is one trial only.
    pub fn of_one(model: &Model, trials: usize) -> Vec<Self> {
        let folds = FOLDS.min(trials);
        let held_out = |fold: usize| (0..trials).filter(|place| place % folds == fold).collect();
        let one = |fold| Self { foundation: model.foundation(), held_out: held_out(fold) };
        if folds < 2 { Vec::new() } else { (0..folds).map(one).collect() }
    }
}

/// What a correction is judged on.
#[derive(Debug, Clone, Copy)]
pub struct HeldOutTrials<'a> {
    /// The law of the foundations.
    pub law: &'a Law,
    /// All trials.
    pub trials: &'a [&'a Trial],
    /// Their parts.
    pub folds: &'a [HeldOutFold],
}

impl HeldOutTrials<'_> {
    /// A fold's foundation with the correction that is trained on its other trials.
    ///
    /// # Errors
    /// As [`train`].
    pub fn corrected(&self, fold: &HeldOutFold, training: &Training) -> Result<Model, TrainError> {
        let places = self.trials.iter().enumerate();
        let others = places.filter(|(place, _)| !fold.held_out.contains(place));
        let others: Vec<&Trial> = others.map(|(_, trial)| *trial).collect();
        corrected(&fold.foundation, self.law, &others, training)
    }
}

/// A foundation with a correction trained on some trials, ready to be simulated.
///
/// # Errors
/// As [`train`].
pub fn corrected(
    foundation: &Model,
    law: &Law,
    trials: &[&Trial],
    training: &Training,
) -> Result<Model, TrainError> {
    let (branch, weights) = train(foundation, law, trials, training)?;
    let mut both = with_branch(foundation, branch);
    attach(&mut both, &weights.bytes()?).map_err(Box::<JoinError>::from)?;
    Ok(both)
}
