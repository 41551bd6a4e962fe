//! Learned correction of a refinement with model selection, if one is better on held-out trials.

use sistership_identification::refine::Refinement;
use sistership_jobs::derive::corrected_with_uncertainty;
use sistership_learned::{BranchSettings, Weights, attach, train, with_branch};
use sistership_model::{Law, Model, Trial, Zoo};
use sistership_model_selection::Ladder;

use crate::failure::Failure;
use crate::files::PromisedFile;
use crate::output::note;
use crate::trials::{self, ReadTrial};

/// Refined model with a learned correction.
pub struct TrainedBeside {
    /// The model.
    pub model: Model,
    weights: Vec<u8>,
}

impl TrainedBeside {
    /// Trains the kind that the model selection chose, if any, on the fitted trials.
    ///
    /// # Errors
    /// Returns an error if it cannot be trained.
    pub fn new(
        (zoo, law): (&Zoo, &Law),
        refinement: &Refinement,
        ladder: Option<&Ladder>,
        read: &[ReadTrial],
    ) -> Result<Option<Self>, Failure> {
        let choice = ladder.and_then(|ladder| ladder.branch.as_ref());
        let Some(kind) = choice.and_then(|choice| choice.taken) else { return Ok(None) };
        note(&format!("training a branch of {}", kind.name()));
        // Held-out trials judge the final model, so the correction must not be trained on them.
        let held_out = &refinement.settings.held_out;
        let fitted: Vec<&Trial> = trials::trials(read)
            .into_iter()
            .filter(|trial| !held_out.contains(&trial.name))
            .collect();
        let model = &refinement.model;
        let settings = BranchSettings::default().of(kind);
        let training = settings.training(model, law, &fitted).map_err(refused)?;
        let (branch, weights) = train(model, law, &fitted, &training).map_err(refused)?;
        let beside = Self::attached(with_branch(model, branch), &weights)?;
        note("learning what these trials leave open beside it");
        let effects: Vec<_> = zoo.effects().cloned().collect();
        let model = corrected_with_uncertainty(beside.model, law, &effects, &fitted);
        Ok(Some(Self { model, weights: beside.weights }))
    }

    /// Attaches the weights that a model names.
    fn attached(mut model: Model, weights: &Weights) -> Result<Self, Failure> {
        let weights = weights.bytes().map_err(refused)?;
        attach(&mut model, &weights).map_err(refused)?;
        Ok(Self { model, weights })
    }

    /// Writes the weights.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    pub fn write(&self, file: PromisedFile) -> Result<(), Failure> {
        file.write(&self.weights)
    }
}

fn refused(error: impl std::fmt::Display) -> Failure {
    Failure::Refused(error.to_string())
}
