//! Derivation of a version with a learned correction: a function of the inputs that its recipe
//! names by hash.

use serde_json::Value;
use sistership_identification::refine::RefineError;
use sistership_learned::{
    CorrectionEvaluation, attach, evaluate_training, train_correction, with_branch,
};
use sistership_model::trial::Trial;
use sistership_model::version::FORMAT;
use sistership_model::{Law, Model};

use super::calibrated::correction_with_uncertainty;
use super::derived::{DerivedVersion, ProgressCallback};
use crate::error::DeriveError;
use crate::inputs::DerivationInputs;
use crate::library::EffectLibrary;
use crate::recipe::{DerivationRecipe, TrainingRecipe};
use crate::sorted_json::sort_keys;
use crate::version::VersionDocument;

/// Trains the learned correction that a recipe describes.
pub(super) async fn derive_trained(
    inputs: &DerivationInputs<'_>,
    ship: &str,
    recipe: &TrainingRecipe,
    progress: ProgressCallback,
) -> Result<DerivedVersion, DeriveError> {
    let foundation = inputs.read_source(&recipe.foundation).await?;
    if foundation.branch.is_some() {
        let message = format!(
            "`{}` has a learned correction already; choose its foundation",
            foundation.name
        );
        return Err(DeriveError::Lost(message));
    }
    // All inputs are loaded here; the blocking thread below does no I/O.
    let law = inputs.read_law(&foundation.law, &recipe.law_sha256).await?;
    let library = inputs.read_effects(&recipe.effects_sha256).await?;
    let trials = inputs.read_trials(&recipe.trials).await?;
    let (ship, recipe) = (ship.to_owned(), recipe.clone());
    let work =
        move || train_and_judge(ship, recipe, (&foundation, &law, &library), &trials, &progress);
    tokio::task::spawn_blocking(work).await?
}

fn train_and_judge(
    ship: String,
    recipe: TrainingRecipe,
    (foundation, law, library): (&Model, &Law, &EffectLibrary),
    trials: &[Trial],
    progress: &ProgressCallback,
) -> Result<DerivedVersion, DeriveError> {
    let trials: Vec<&Trial> = trials.iter().collect();
    let go_on = |done: f64, what: &str| {
        let on = progress(done, what);
        if on { Ok(()) } else { Err(DeriveError::Refine(RefineError::Cancelled)) }
    };
    // The fractions of progress are rough shares of the time.
    go_on(0.1, "training the learned correction")?;
    let (branch, weights) = train_correction(foundation, law, &trials, &recipe.settings)?;
    go_on(0.3, "cross-validating it")?;
    let judgement = evaluate_training(foundation, law, &trials, &recipe.settings)?;
    go_on(0.8, "estimating the noise model")?;
    let weights = weights.to_bytes().map_err(sistership_learned::TrainError::from)?;
    let mut model = with_branch(foundation, branch);
    // The calibration simulates the model, so the weights must be attached before it.
    attach(&mut model, &weights)?;
    let model = correction_with_uncertainty(model, law, &library.effects, &trials);
    let document = VersionDocument {
        format: FORMAT.to_owned(),
        ship,
        recipe: DerivationRecipe::Training(recipe),
        model,
        report: judgement_report(judgement.as_ref())?,
    };
    Ok(DerivedVersion { document, refined: None, weights: Some(weights.into()) })
}

/// Report of the cross-validation on held-out trials; null if there was only one trial.
fn judgement_report(judgement: Option<&CorrectionEvaluation>) -> Result<Value, DeriveError> {
    Ok(sort_keys(serde_json::to_value(judgement)?))
}
