//! Derivation of a diagnosis and of the version with the effects that it finds: a function of the
//! inputs that its recipe names by hash.

use serde_json::Value;
use sistership_diagnosis::{Diagnosis, DiagnosisInputs, Settings, diagnose};
use sistership_model::trial::Trial;
use sistership_model::version::FORMAT;
use sistership_model::{Law, Model};

use super::derived::ProgressCallback;
use crate::archive::Archive;
use crate::error::DeriveError;
use crate::inputs::DerivationInputs;
use crate::library::EffectLibrary;
use crate::recipe::{DerivationRecipe, DiagnosisRecipe};
use crate::sorted_json::sort_keys;
use crate::version::VersionDocument;

/// Diagnosis with its inputs.
#[derive(Debug)]
pub struct DiagnosisRun {
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
pub async fn run_diagnosis(
    archive: &Archive,
    recipe: DiagnosisRecipe,
    progress: ProgressCallback,
) -> Result<DiagnosisRun, DeriveError> {
    let inputs = DerivationInputs::new(archive);
    let named = DerivationRecipe::Diagnosis(recipe.clone());
    let diagnosed = run_diagnosis_on(&inputs, recipe, progress).await?;
    // Every document that was read must be named by the recipe, else it could not be derived again.
    inputs.check_recipe(&named)?;
    Ok(diagnosed)
}

/// Runs the diagnosis on inputs that record what is read.
pub(super) async fn run_diagnosis_on(
    inputs: &DerivationInputs<'_>,
    recipe: DiagnosisRecipe,
    progress: ProgressCallback,
) -> Result<DiagnosisRun, DeriveError> {
    let model = inputs.read_model(&recipe.diagnosed).await?;
    let law = inputs.read_law(&model.law, &recipe.law_sha256).await?;
    let library = inputs.read_effects(&recipe.effects_sha256).await?;
    let trials = inputs.read_trials(&recipe.trials).await?;
    let work = move || {
        let diagnosis = diagnose_trials(&recipe, (&model, &law, &library), &trials, &progress)?;
        Ok(DiagnosisRun { diagnosis, recipe, model, law, trials })
    };
    tokio::task::spawn_blocking(work).await?
}

fn diagnose_trials(
    recipe: &DiagnosisRecipe,
    (model, law, library): (&Model, &Law, &EffectLibrary),
    trials: &[Trial],
    progress: &ProgressCallback,
) -> Result<Diagnosis, DeriveError> {
    let settings: Settings = serde_json::from_value(recipe.settings.clone())
        .map_err(|error| DeriveError::Lost(format!("the recipe's settings: {error}")))?;
    let trials: Vec<&Trial> = trials.iter().collect();
    let request = DiagnosisInputs {
        model,
        law,
        effects: &library.effects,
        trials: &trials,
        settings: &settings,
    };
    Ok(diagnose(&request, &**progress)?)
}

impl DiagnosisRun {
    /// Returns the version with the effects that were found; `None` if none was found.
    ///
    /// # Errors
    /// Returns an error if a number of the report is not finite.
    pub fn to_version(&self) -> Result<Option<VersionDocument>, serde_json::Error> {
        let Some(model) = &self.diagnosis.model else { return Ok(None) };
        Ok(Some(VersionDocument {
            format: FORMAT.to_owned(),
            ship: self.recipe.diagnosed.ship.clone(),
            recipe: DerivationRecipe::Diagnosis(self.recipe.clone()),
            model: model.clone(),
            report: report_without_model(&self.diagnosis)?,
        }))
    }
}

/// Report of a diagnosis, without the model, which the version holds, without the series, which only
/// plots need, and without the history of effects, which only the next diagnosis needs.
fn report_without_model(diagnosis: &Diagnosis) -> Result<Value, serde_json::Error> {
    let mut report = serde_json::to_value(diagnosis)?;
    if let Some(fields) = report.as_object_mut() {
        fields.remove("model");
        fields.remove("residuals");
        fields.remove("history");
    }
    Ok(sort_keys(report))
}
