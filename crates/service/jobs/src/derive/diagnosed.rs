//! Derivation of a diagnosis and of the version with the effects that it finds: a function of the
//! inputs that its recipe names by hash.

use serde_json::Value;
use sistership_diagnosis::{Diagnosis, Request, Settings, diagnose};
use sistership_model::trial::Trial;
use sistership_model::version::FORMAT;
use sistership_model::{Law, Model};

use super::derived::Progress;
use crate::archive::Archive;
use crate::error::DeriveError;
use crate::inputs::Inputs;
use crate::library::Library;
use crate::recipe::{DiagnosisRecipe, Recipe};
use crate::sorted::sorted;
use crate::version::VersionDocument;

/// Diagnosis with its inputs.
#[derive(Debug)]
pub struct Diagnosed {
    /// The result.
    pub diagnosis: Diagnosis,
    /// Its recipe.
    pub recipe: DiagnosisRecipe,
    /// The model that was diagnosed.
    pub model: Model,
    /// Its law.
    pub law: Law,
    /// The trials, in the recipe's order.
    pub trials: Vec<Trial>,
}

/// Runs the diagnosis that a recipe describes.
///
/// # Errors
/// Returns an error if an input is missing or has changed, or if the diagnosis is refused.
pub async fn diagnosed(
    archive: &Archive,
    recipe: DiagnosisRecipe,
    progress: Progress,
) -> Result<Diagnosed, DeriveError> {
    let inputs = Inputs::new(archive);
    let named = Recipe::Diagnosis(recipe.clone());
    let diagnosed = diagnosed_from(&inputs, recipe, progress).await?;
    // Every document that was read must be named by the recipe, else it could not be derived again.
    inputs.check(&named)?;
    Ok(diagnosed)
}

/// Runs the diagnosis on inputs that record what is read.
pub(super) async fn diagnosed_from(
    inputs: &Inputs<'_>,
    recipe: DiagnosisRecipe,
    progress: Progress,
) -> Result<Diagnosed, DeriveError> {
    let model = inputs.model(&recipe.diagnosed).await?;
    let law = inputs.law(&model.law, &recipe.law_sha256).await?;
    let library = inputs.effects(&recipe.effects_sha256).await?;
    let trials = inputs.trials(&recipe.trials).await?;
    let work = move || {
        let diagnosis = carry_out(&recipe, (&model, &law, &library), &trials, &progress)?;
        Ok(Diagnosed { diagnosis, recipe, model, law, trials })
    };
    tokio::task::spawn_blocking(work).await?
}

fn carry_out(
    recipe: &DiagnosisRecipe,
    (model, law, library): (&Model, &Law, &Library),
    trials: &[Trial],
    progress: &Progress,
) -> Result<Diagnosis, DeriveError> {
    let settings: Settings = serde_json::from_value(recipe.settings.clone())?;
    let trials: Vec<&Trial> = trials.iter().collect();
    let request =
        Request { model, law, effects: &library.effects, trials: &trials, settings: &settings };
    Ok(diagnose(&request, &**progress)?)
}

impl Diagnosed {
    /// Returns the version with the effects that were found; `None` if none was found.
    ///
    /// # Errors
    /// Returns an error if a number of the report is not finite.
    pub fn document(&self) -> Result<Option<VersionDocument>, serde_json::Error> {
        let Some(model) = &self.diagnosis.model else { return Ok(None) };
        Ok(Some(VersionDocument {
            format: FORMAT.to_owned(),
            ship: self.recipe.diagnosed.ship.clone(),
            recipe: Recipe::Diagnosis(self.recipe.clone()),
            model: model.clone(),
            report: report(&self.diagnosis)?,
        }))
    }
}

/// Report of a diagnosis, without the model, which the version holds, and without the series, which
/// only plots need.
fn report(diagnosis: &Diagnosis) -> Result<Value, serde_json::Error> {
    let mut report = serde_json::to_value(diagnosis)?;
    if let Some(fields) = report.as_object_mut() {
        fields.remove("model");
        fields.remove("residuals");
    }
    Ok(sorted(report))
}
