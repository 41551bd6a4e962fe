//! From a recipe to the version that it describes. Jobs and [`verify`](mod@crate::verify) both go this way, so that they
//! cannot differ.

use std::sync::Arc;

use bytes::Bytes;
use serde_json::{Map, Value};
use sistership_identify::refine::{RefineError, Refinement, Request, Settings, refine};
use sistership_model::trial::Trial;
use sistership_model::version::{FORMAT, Recipe, SourceVersion, VersionDocument};
use sistership_model::{FileError, Law, Model, Vessel};
use sistership_store::StoreError;
use sistership_trials::samples::{self, SamplesError};

use crate::archive::Archive;

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
    /// The refinement that gave it; none for a published model.
    pub refined: Option<Refined>,
}

/// A refinement with everything that went into it.
#[derive(Debug)]
pub struct Refined {
    /// What came out.
    pub refinement: Refinement,
    /// What went in.
    pub ingredients: Ingredients,
}

/// What a refinement is made of.
#[derive(Debug)]
pub struct Ingredients {
    /// The ship.
    pub target: Vessel,
    /// The version that is refined.
    pub source: SourceVersion,
    /// Its model.
    pub model: Model,
    /// Its law.
    pub law: Law,
    /// The trials, in the recipe's order.
    pub trials: Vec<Trial>,
    /// The settings.
    pub settings: Settings,
}

/// Derives the version of a ship that a recipe describes.
///
/// # Errors
/// Says what is missing or has changed, or why the refinement is refused.
pub async fn derive(archive: &Archive, ship: &str, recipe: &Recipe, progress: Progress) -> Result<Derived, DeriveError> {
    match recipe {
        Recipe::Published { model, ship_sha256, law_sha256 } => published(archive, ship, model, ship_sha256, law_sha256).await,
        Recipe::Refinement { .. } => {
            let (ingredients, samples) = gather(archive, ship, recipe).await?;
            let recipe = recipe.clone();
            tokio::task::spawn_blocking(move || refined(ingredients, &samples, &recipe, &progress)).await?
        }
    }
}

/// The settings of a recipe, every one of them.
///
/// # Errors
/// A setting is unknown or of the wrong type.
pub(crate) fn settings(recorded: &Value) -> Result<Settings, DeriveError> {
    Ok(serde_json::from_value(recorded.clone())?)
}

async fn published(
    archive: &Archive,
    ship: &str,
    model: &str,
    ship_sha256: &str,
    law_sha256: &str,
) -> Result<Derived, DeriveError> {
    let vessel = archive.ship(ship, ship_sha256).await?;
    let lost = || DeriveError::Lost(format!("the ship `{ship}` has no model `{model}`"));
    let file = vessel.file.models.iter().find(|file| file.name == model).ok_or_else(lost)?;
    let law = archive.law(&file.law, law_sha256).await?;
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
        recipe: Recipe::Published {
            model: model.to_owned(),
            ship_sha256: ship_sha256.to_owned(),
            law_sha256: law_sha256.to_owned(),
        },
        model: Model::published(vessel, Some(model), law)?,
        report: Value::Null,
    })
}

/// Loads what a recipe names, each by its hash; the samples are not yet read.
async fn gather(archive: &Archive, ship: &str, recipe: &Recipe) -> Result<(Ingredients, Vec<Bytes>), DeriveError> {
    let Recipe::Refinement { source, ship_sha256, law_sha256, trials, settings: recorded, .. } = recipe else {
        return Err(DeriveError::Lost("the recipe is not that of a refinement".into()));
    };
    let model = archive.source(source).await?;
    let law = archive.law(&model.law, law_sha256).await?;
    let target = archive.ship(ship, ship_sha256).await?;
    let samples = archive.samples(trials).await?;
    let settings = settings(recorded)?;
    Ok((Ingredients { target, source: source.clone(), model, law, trials: Vec::new(), settings }, samples))
}

fn refined(
    mut ingredients: Ingredients,
    samples: &[Bytes],
    recipe: &Recipe,
    progress: &Progress,
) -> Result<Derived, DeriveError> {
    ingredients.trials = samples.iter().cloned().map(samples::from_parquet).collect::<Result<_, _>>()?;
    let (document, refinement) = refined_document(&ingredients, recipe, &**progress)?;
    Ok(Derived { document, refined: Some(Refined { refinement, ingredients }) })
}

/// The version that a refinement gives: a function of its ingredients and nothing else.
///
/// # Errors
/// Why the refinement is refused, or that it was stopped.
pub fn refined_document(
    ingredients: &Ingredients,
    recipe: &Recipe,
    progress: &(dyn Fn(f64, &str) -> bool + Sync),
) -> Result<(VersionDocument, Refinement), DeriveError> {
    let Ingredients { target, model, law, settings, .. } = ingredients;
    let trials: Vec<&Trial> = ingredients.trials.iter().collect();
    let refinement = refine(&Request { target, source: model, law, trials: &trials, settings }, progress)?;
    let document = VersionDocument {
        format: FORMAT.to_owned(),
        ship: target.name().to_owned(),
        recipe: recipe.clone(),
        model: refinement.model.clone(),
        report: report(&refinement)?,
    };
    Ok((document, refinement))
}

/// What a refinement reported, without the model that the version holds anyway.
fn report(refinement: &Refinement) -> Result<Value, serde_json::Error> {
    let mut report = serde_json::to_value(refinement)?;
    if let Some(fields) = report.as_object_mut() {
        fields.remove("model");
    }
    Ok(sorted(report))
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

/// The revision of this program, which every recipe records.
pub fn code_revision() -> &'static str {
    option_env!("SISTERSHIP_REVISION").unwrap_or(env!("CARGO_PKG_VERSION"))
}
