//! Derivation of a refined version: a function of its inputs, each found by its hash.

use std::sync::Arc;

use serde_json::Value;
use sistership_identification::refine::{
    PopulationShip, RefineError, Refinement, RefinementSettings, RefinementSpec, refine,
};
use sistership_model::trial::Trial;
use sistership_model::version::{FORMAT, PopulationMember, VersionRecipe};
use sistership_model::{Law, Model, Vessel};
use sistership_priors::transfer::{blank_model, trial_approach};

use super::calibrated::with_uncertainty;
use super::derived::{DerivedVersion, ProgressCallback, RefinementInputs, RefinementRun};
use crate::error::DeriveError;
use crate::inputs::DerivationInputs;
use crate::recipe;
use crate::sorted_json::sort_keys;
use crate::version::VersionDocument;

/// Loads the inputs that a recipe names, each by its hash.
pub(super) async fn load_inputs(
    inputs: &DerivationInputs<'_>,
    ship: &str,
    recipe: &VersionRecipe,
) -> Result<RefinementInputs, DeriveError> {
    let VersionRecipe::Refinement {
        source,
        law: named,
        ship_sha256,
        law_sha256,
        across,
        population,
        effects_sha256,
        trials,
        settings: recorded,
        ..
    } = recipe
    else {
        return Err(DeriveError::Lost("the recipe is not the recipe of a refinement".into()));
    };
    let settings: RefinementSettings = serde_json::from_value(recorded.clone())
        .map_err(|error| DeriveError::Lost(format!("the recipe's settings: {error}")))?;
    let target = inputs.read_ship(ship, ship_sha256).await?;
    let library = inputs.read_effects(effects_sha256).await?;
    let trials = inputs.read_trials(trials).await?;
    let (model, law, source_law) = match source {
        Some(source) => {
            // The learned correction of the source gives no prior for coefficients.
            let model = inputs.read_source(source).await?.without_correction();
            let name = across.as_ref().map_or(&model.law, |across| &across.law);
            let law = inputs.read_law(name, law_sha256).await?;
            let source_law = match across {
                Some(across) => Some(inputs.read_law(&model.law, &across.source_law_sha256).await?),
                None => None,
            };
            (model, law, source_law)
        }
        None => {
            let name = named.as_deref().ok_or_else(missing_law)?;
            let law = inputs.read_law(name, law_sha256).await?;
            (blank_target(&law, &target, &trials, &settings)?, law, None)
        }
    };
    let population = population_members(inputs, population).await?;
    Ok(RefinementInputs { target, model, source_law, law, library, trials, population, settings })
}

async fn population_members(
    inputs: &DerivationInputs<'_>,
    named: &[PopulationMember],
) -> Result<Vec<PopulationShip>, DeriveError> {
    let mut members = Vec::new();
    for PopulationMember { version, law_sha256 } in named {
        let model = inputs.read_source(version).await?;
        let law = Arc::new(inputs.read_law(&model.law, law_sha256).await?);
        members.push(PopulationShip { model, law });
    }
    Ok(members)
}

fn missing_law() -> DeriveError {
    DeriveError::Lost("the recipe has neither a source nor a law".into())
}

/// Returns a model without coefficients, with the approach speed of the fitted trials.
fn blank_target(
    law: &Law,
    target: &Vessel,
    trials: &[Trial],
    settings: &RefinementSettings,
) -> Result<Model, DeriveError> {
    let fitted = trials.iter().filter(|trial| !settings.held_out.contains(&trial.name));
    let approach = trial_approach(&fitted.collect::<Vec<_>>());
    blank_model(law, target, approach).map_err(|error| DeriveError::Refine(error.into()))
}

pub(super) fn derive_refined(
    ingredients: RefinementInputs,
    recipe: &VersionRecipe,
    progress: &ProgressCallback,
) -> Result<DerivedVersion, DeriveError> {
    let (document, refinement) = refined_document(&ingredients, recipe, &**progress)?;
    Ok(DerivedVersion {
        refined: Some(RefinementRun { refinement, ingredients }),
        ..DerivedVersion::from_document(document)
    })
}

/// Returns the version that a refinement gives: a function of its inputs only.
///
/// # Errors
/// Returns an error if the refinement is refused or was stopped.
pub fn refined_document(
    ingredients: &RefinementInputs,
    recipe: &VersionRecipe,
    progress: &(dyn Fn(f64, &str) -> bool + Sync),
) -> Result<(VersionDocument, Refinement), DeriveError> {
    let RefinementInputs { target, model, source_law, law, population, settings, .. } = ingredients;
    let trials: Vec<&Trial> = ingredients.trials.iter().collect();
    let refinement = refine(
        &RefinementSpec {
            target,
            source: model,
            source_law: source_law.as_ref(),
            law,
            trials: &trials,
            population,
            settings,
        },
        progress,
    )?;
    if !progress(0.97, "estimating the noise model") {
        return Err(RefineError::Cancelled.into());
    }
    // The uncertainty follows the coefficients: it is calibrated on the residuals of the refined
    // model.
    let refinement = with_uncertainty(refinement, law, &ingredients.library.effects, &trials);
    let document = VersionDocument {
        format: FORMAT.to_owned(),
        ship: target.name().to_owned(),
        recipe: recipe::DerivationRecipe::Plain(recipe.clone()),
        model: refinement.model.clone(),
        report: report_without_model(&refinement)?,
    };
    Ok((document, refinement))
}

/// Report of a refinement, without the model, which the version holds.
fn report_without_model(refinement: &Refinement) -> Result<Value, serde_json::Error> {
    let mut report = serde_json::to_value(refinement)?;
    if let Some(fields) = report.as_object_mut() {
        fields.remove("model");
    }
    Ok(sort_keys(report))
}
