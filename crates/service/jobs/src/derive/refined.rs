//! Derivation of a refined version: a function of its inputs, each found by its hash.

use std::sync::Arc;

use serde_json::Value;
use sistership_identification::refine::{
    Member, RefineError, Refinement, Request, Settings, refine,
};
use sistership_model::trial::Trial;
use sistership_model::version::{FORMAT, PopulationMember, Recipe};
use sistership_model::{Law, Model, Vessel};
use sistership_priors::transfer::{approach_of, blank};

use super::calibrated::with_uncertainty;
use super::derived::{Derived, Ingredients, Progress, Refined};
use crate::error::DeriveError;
use crate::inputs::Inputs;
use crate::library::FIRST_SHA256;
use crate::recipe;
use crate::sorted::sorted;
use crate::version::VersionDocument;

/// Loads the inputs that a recipe names, each by its hash.
pub(super) async fn gather(
    inputs: &Inputs<'_>,
    ship: &str,
    recipe: &Recipe,
) -> Result<Ingredients, DeriveError> {
    let Recipe::Refinement {
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
        return Err(DeriveError::Lost("the recipe is not that of a refinement".into()));
    };
    let settings: Settings = serde_json::from_value(recorded.clone())?;
    let target = inputs.ship(ship, ship_sha256).await?;
    // Recipes of the first release name no library; they used the first one.
    let library = inputs.effects(effects_sha256.as_deref().unwrap_or(FIRST_SHA256)).await?;
    let trials = inputs.trials(trials).await?;
    let (model, law, source_law) = match source {
        Some(source) => {
            // The learned correction of the source gives no prior for coefficients.
            let model = inputs.source(source).await?.foundation();
            let name = across.as_ref().map_or(&model.law, |across| &across.law);
            let law = inputs.law(name, law_sha256).await?;
            let source_law = match across {
                Some(across) => Some(inputs.law(&model.law, &across.source_law_sha256).await?),
                None => None,
            };
            (model, law, source_law)
        }
        None => {
            let name = named.as_deref().ok_or_else(unnamed)?;
            let law = inputs.law(name, law_sha256).await?;
            (without_source(&law, &target, &trials, &settings)?, law, None)
        }
    };
    let population = members(inputs, population).await?;
    Ok(Ingredients { target, model, source_law, law, library, trials, population, settings })
}

async fn members(
    inputs: &Inputs<'_>,
    named: &[PopulationMember],
) -> Result<Vec<Member>, DeriveError> {
    let mut members = Vec::new();
    for PopulationMember { version, law_sha256 } in named {
        let model = inputs.source(version).await?;
        let law = Arc::new(inputs.law(&model.law, law_sha256).await?);
        members.push(Member { model, law });
    }
    Ok(members)
}

fn unnamed() -> DeriveError {
    DeriveError::Lost("the recipe names neither a source nor a law".into())
}

/// Returns a model without coefficients, with the approach speed of the fitted trials.
fn without_source(
    law: &Law,
    target: &Vessel,
    trials: &[Trial],
    settings: &Settings,
) -> Result<Model, DeriveError> {
    let fitted = trials.iter().filter(|trial| !settings.held_out.contains(&trial.name));
    let approach = approach_of(&fitted.collect::<Vec<_>>());
    blank(law, target, approach).map_err(|error| DeriveError::Refine(error.into()))
}

pub(super) fn refined(
    ingredients: Ingredients,
    recipe: &Recipe,
    progress: &Progress,
) -> Result<Derived, DeriveError> {
    let (document, refinement) = refined_document(&ingredients, recipe, &**progress)?;
    Ok(Derived { refined: Some(Refined { refinement, ingredients }), ..Derived::of(document) })
}

/// Returns the version that a refinement gives: a function of its inputs only.
///
/// # Errors
/// Returns an error if the refinement is refused or was stopped.
pub fn refined_document(
    ingredients: &Ingredients,
    recipe: &Recipe,
    progress: &(dyn Fn(f64, &str) -> bool + Sync),
) -> Result<(VersionDocument, Refinement), DeriveError> {
    let Ingredients { target, model, source_law, law, population, settings, .. } = ingredients;
    let trials: Vec<&Trial> = ingredients.trials.iter().collect();
    let refinement = refine(
        &Request {
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
        recipe: recipe::Recipe::Plain(recipe.clone()),
        model: refinement.model.clone(),
        report: report(&refinement)?,
    };
    Ok((document, refinement))
}

/// Report of a refinement, without the model, which the version holds.
fn report(refinement: &Refinement) -> Result<Value, serde_json::Error> {
    let mut report = serde_json::to_value(refinement)?;
    if let Some(fields) = report.as_object_mut() {
        fields.remove("model");
    }
    Ok(sorted(report))
}
