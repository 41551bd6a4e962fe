//! Learned correction of a refinement with model selection, if one is better on held-out trials.

use sistership_identification::refine::Refinement;
use sistership_jobs::derive::correction_with_uncertainty;
use sistership_learned::{
    BranchSettings, CorrectionWeights, attach, train_correction, with_branch,
};
use sistership_model::{Law, Model, Trial, Zoo};
use sistership_model_selection::SelectionReport;

use crate::failure::Failure;
use crate::files::OutputFile;
use crate::output::print_note;
use crate::trials::{self, ReadTrial};

/// Refined model with a learned correction.
pub struct RefinementCorrection {
    /// The model.
    pub model: Model,
    weights: Vec<u8>,
}

impl RefinementCorrection {
    /// Trains the kind that the model selection chose, if any, on the fitted trials.
    ///
    /// # Errors
    /// Returns an error if it cannot be trained.
    pub fn new(
        (zoo, law): (&Zoo, &Law),
        refinement: &Refinement,
        ladder: Option<&SelectionReport>,
        read: &[ReadTrial],
    ) -> Result<Option<Self>, Failure> {
        let choice = ladder.and_then(|ladder| ladder.branch.as_ref());
        let Some(kind) = choice.and_then(|choice| choice.taken) else { return Ok(None) };
        print_note(&format!("training a learned correction ({})", kind.name()));
        // Held-out trials judge the final model, so the correction must not be trained on them.
        let held_out = &refinement.settings.held_out;
        let fitted: Vec<&Trial> = trials::trial_refs(read)
            .into_iter()
            .filter(|trial| !held_out.contains(&trial.name))
            .collect();
        let model = &refinement.model;
        let settings = BranchSettings::default().with_kind(kind);
        let training = settings.complete_training(model, law, &fitted).map_err(refusal)?;
        let (branch, weights) =
            train_correction(model, law, &fitted, &training).map_err(refusal)?;
        let beside = Self::from_model(with_branch(model, branch), &weights)?;
        print_note("estimating the noise model of the corrected model");
        let effects: Vec<_> = zoo.effects().cloned().collect();
        let model = correction_with_uncertainty(beside.model, law, &effects, &fitted);
        Ok(Some(Self { model, weights: beside.weights }))
    }

    /// Attaches the weights that a model names.
    fn from_model(mut model: Model, weights: &CorrectionWeights) -> Result<Self, Failure> {
        let weights = weights.to_bytes().map_err(refusal)?;
        attach(&mut model, &weights).map_err(refusal)?;
        Ok(Self { model, weights })
    }

    /// Writes the weights.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    pub fn write_weights(&self, file: OutputFile) -> Result<(), Failure> {
        file.write(&self.weights)
    }
}

fn refusal(error: impl std::fmt::Display) -> Failure {
    Failure::Refused(error.to_string())
}
