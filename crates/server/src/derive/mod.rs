//! From a recipe to the version that it describes. Jobs and [`verify`](mod@crate::verify) both go this way, so that they
//! cannot differ.

mod calibrated;
mod diagnosed;
mod inputs;
mod refined;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use serde_json::{Map, Value};
use sistership_estimate::refine::RefineError;
use sistership_model::version::{self, FORMAT};
use sistership_model::{FileError, Law, Model, Vessel};
use sistership_store::StoreError;
use sistership_trials::samples::SamplesError;

pub use calibrated::with_uncertainty;
pub use diagnosed::{Diagnosed, diagnosed};
pub(crate) use inputs::Inputs;
pub use inputs::{Input, InputKind};
pub use refined::{Ingredients, Refined, refined_document};

use crate::archive::Archive;
use crate::version::{Recipe, VersionDocument};

/// Told how far a derivation is (0 to 1) and what it does; answers `false` to stop it.
pub type Progress = Arc<dyn Fn(f64, &str) -> bool + Send + Sync>;

/// Why a version cannot be derived.
#[derive(Debug, thiserror::Error)]
pub enum DeriveError {
    /// Something that the recipe names is not there.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// Something that the recipe names is no longer what it was.
    #[error("{0}")]
    Lost(String),
    /// A ship or law does not read.
    #[error(transparent)]
    File(#[from] FileError),
    /// Samples do not read.
    #[error(transparent)]
    Samples(#[from] SamplesError),
    /// The refinement is refused, or was stopped.
    #[error(transparent)]
    Refine(#[from] RefineError),
    /// A document cannot be written.
    #[error("a document cannot be written: {0}")]
    Json(#[from] serde_json::Error),
    /// The thread that computed is gone.
    #[error("the computation broke off: {0}")]
    Broken(#[from] tokio::task::JoinError),
}

/// A derived version, and what it was made with.
#[derive(Debug)]
pub struct Derived {
    /// The version.
    pub document: VersionDocument,
    /// The refinement that gave it, if one did.
    pub refined: Option<Refined>,
}

/// Derives the version of a ship that a recipe describes.
///
/// # Errors
/// Says what is missing or has changed, or why the refinement is refused.
pub async fn derive(archive: &Archive, ship: &str, recipe: &Recipe, progress: Progress) -> Result<Derived, DeriveError> {
    let inputs = &Inputs::new(archive);
    let derived = match recipe {
        Recipe::Plain(version::Recipe::Published { model, ship_sha256, law_sha256 }) => {
            published(inputs, ship, model, ship_sha256, law_sha256).await
        }
        Recipe::Plain(recipe @ version::Recipe::Refinement { .. }) => {
            let ingredients = refined::gather(inputs, ship, recipe).await?;
            let recipe = recipe.clone();
            tokio::task::spawn_blocking(move || refined::refined(ingredients, &recipe, &progress)).await?
        }
        Recipe::Family(recipe) => Ok(Derived { document: crate::fleet::derived(inputs, ship, recipe).await?, refined: None }),
        Recipe::Registered(_) => {
            Err(DeriveError::Lost("the model was made elsewhere: its own bytes are all there is of it".into()))
        }
        Recipe::Diagnosis(recipe) => {
            let document = diagnosed::diagnosed_from(inputs, recipe.clone(), progress).await?.document()?;
            let nothing = || DeriveError::Lost("the diagnosis finds no effect now, so that no version comes of it".into());
            Ok(Derived { document: document.ok_or_else(nothing)?, refined: None })
        }
    }?;
    inputs.check(recipe)?;
    Ok(derived)
}

impl Derived {
    /// The same with every setting that was used spelled out in the recipe of a refinement, so that no later default speaks for
    /// it. Evaluations stay as they were asked for: they are a limit, and not what was spent.
    ///
    /// # Errors
    /// A setting is not finite.
    pub fn spelled_out(mut self) -> Result<Self, DeriveError> {
        if let (Some(refined), Recipe::Plain(version::Recipe::Refinement { settings, .. })) =
            (&self.refined, &mut self.document.recipe)
        {
            let mut used = refined.refinement.settings.clone();
            let asked = refined.ingredients.settings.cma_es.clone().unwrap_or_default().evaluations;
            used.cma_es.iter_mut().for_each(|search| search.evaluations = asked);
            *settings = sorted(serde_json::to_value(used)?);
        }
        Ok(self)
    }
}

async fn published(
    inputs: &Inputs<'_>,
    ship: &str,
    model: &str,
    ship_sha256: &str,
    law_sha256: &str,
) -> Result<Derived, DeriveError> {
    let vessel = inputs.ship(ship, ship_sha256).await?;
    let lost = || DeriveError::Lost(format!("the ship `{ship}` has no model `{model}`"));
    let file = vessel.file.models.iter().find(|file| file.name == model).ok_or_else(lost)?;
    let law = inputs.law(&file.law, law_sha256).await?;
    let document = published_document(&vessel, model, &law, ship_sha256, law_sha256)?;
    Ok(Derived { document, refined: None })
}

/// The version of a model that a ship's own document publishes.
pub(crate) fn published_document(
    vessel: &Vessel,
    model: &str,
    law: &Law,
    ship_sha256: &str,
    law_sha256: &str,
) -> Result<VersionDocument, FileError> {
    Ok(VersionDocument {
        format: FORMAT.to_owned(),
        ship: vessel.name().to_owned(),
        recipe: Recipe::Plain(version::Recipe::Published {
            model: model.to_owned(),
            ship_sha256: ship_sha256.to_owned(),
            law_sha256: law_sha256.to_owned(),
        }),
        model: Model::published(vessel, Some(model), law)?,
        report: Value::Null,
    })
}

/// The same value with every map in the order of its keys, however the JSON library is built.
pub(crate) fn sorted(value: Value) -> Value {
    match value {
        Value::Array(items) => Value::Array(items.into_iter().map(sorted).collect()),
        Value::Object(fields) => {
            let mut fields: Vec<(String, Value)> = fields.into_iter().map(|(key, value)| (key, sorted(value))).collect();
            fields.sort_by(|a, b| a.0.cmp(&b.0));
            Value::Object(Map::from_iter(fields))
        }
        other => other,
    }
}
