//! Derivation of a version with a learned correction: a function of the inputs that its recipe
//! names by hash.

use serde_json::Value;
use sistership_identification::refine::RefineError;
use sistership_learned::{Judgement, attach, judge, train, with_branch};
use sistership_model::trial::Trial;
use sistership_model::version::FORMAT;
use sistership_model::{Law, Model};

use super::calibrated::corrected_with_uncertainty;
use super::derived::{Derived, Progress};
use crate::error::DeriveError;
use crate::inputs::Inputs;
use crate::library::Library;
use crate::recipe::{Recipe, TrainingRecipe};
use crate::sorted::sorted;
use crate::version::VersionDocument;

/// Trains the learned correction that a recipe describes.
pub(super) async fn trained(
    inputs: &Inputs<'_>,
    ship: &str,
    recipe: &TrainingRecipe,
    progress: Progress,
) -> Result<Derived, DeriveError> {
    let foundation = inputs.source(&recipe.foundation).await?;
    if foundation.branch.is_some() {
        let message = format!("`{}` has a learned branch already", foundation.name);
        return Err(DeriveError::Lost(message));
    }
    // All inputs are loaded here; the blocking thread below does no I/O.
    let law = inputs.law(&foundation.law, &recipe.law_sha256).await?;
    let library = inputs.effects(&recipe.effects_sha256).await?;
    let trials = inputs.trials(&recipe.trials).await?;
    let (ship, recipe) = (ship.to_owned(), recipe.clone());
    let work = move || carry_out(ship, recipe, (&foundation, &law, &library), &trials, &progress);
    tokio::task::spawn_blocking(work).await?
}

fn carry_out(
    ship: String,
    recipe: TrainingRecipe,
    (foundation, law, library): (&Model, &Law, &Library),
    trials: &[Trial],
    progress: &Progress,
) -> Result<Derived, DeriveError> {
    let trials: Vec<&Trial> = trials.iter().collect();
    let go_on = |done: f64, what: &str| {
        let on = progress(done, what);
        if on { Ok(()) } else { Err(DeriveError::Refine(RefineError::Cancelled)) }
    };
    // The fractions of progress are rough shares of the time.
    go_on(0.1, "training the branch")?;
    let (branch, weights) = train(foundation, law, &trials, &recipe.settings)?;
    go_on(0.3, "judging it on trials left out")?;
    let judgement = judge(foundation, law, &trials, &recipe.settings)?;
    go_on(0.8, "learning what the trials leave open")?;
    let weights = weights.bytes().map_err(sistership_learned::TrainError::from)?;
    let mut model = with_branch(foundation, branch);
    // The calibration simulates the model, so the weights must be attached before it.
    attach(&mut model, &weights)?;
    let model = corrected_with_uncertainty(model, law, &library.effects, &trials);
    let document = VersionDocument {
        format: FORMAT.to_owned(),
        ship,
        recipe: Recipe::Training(recipe),
        model,
        report: report(judgement.as_ref())?,
    };
    Ok(Derived { document, refined: None, weights: Some(weights.into()) })
}

/// Report of the cross-validation on held-out trials; null if there was only one trial.
fn report(judgement: Option<&Judgement>) -> Result<Value, DeriveError> {
    Ok(sorted(serde_json::to_value(judgement)?))
}
