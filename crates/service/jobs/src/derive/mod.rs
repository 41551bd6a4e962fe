//! Derivation of the version that a recipe describes. Jobs and [`verify`](mod@crate::verify) both
//! use it, so that their results cannot differ.

mod calibrated;
mod derived;
mod diagnosed;
mod published;
mod refined;
#[cfg(test)]
mod tests;
mod trained;

use sistership_model::version;

pub use crate::error::DeriveError;
pub use calibrated::{correction_with_uncertainty, with_uncertainty};
pub use derived::{DerivedVersion, ProgressCallback, RefinementInputs, RefinementRun};
pub use diagnosed::{DiagnosisRun, run_diagnosis};
pub use published::published_document;
pub use refined::refined_document;

use crate::archive::Archive;
use crate::fleet;
use crate::inputs::DerivationInputs;
use crate::recipe::DerivationRecipe;

/// Derives the version of a ship that a recipe describes.
///
/// # Errors
/// Returns an error if an input is missing or has changed, or if the derivation is refused.
pub async fn derive(
    archive: &Archive,
    ship: &str,
    recipe: &DerivationRecipe,
    progress: ProgressCallback,
) -> Result<DerivedVersion, DeriveError> {
    let inputs = &DerivationInputs::new(archive);
    let derived = match recipe {
        DerivationRecipe::Plain(version::VersionRecipe::Published {
            model,
            ship_sha256,
            law_sha256,
        }) => published::derive_published(inputs, ship, model, ship_sha256, law_sha256).await,
        DerivationRecipe::Plain(recipe @ version::VersionRecipe::Refinement { .. }) => {
            // All reads come first: the refinement itself is a function on a blocking thread.
            let ingredients = refined::load_inputs(inputs, ship, recipe).await?;
            let recipe = recipe.clone();
            tokio::task::spawn_blocking(move || {
                refined::derive_refined(ingredients, &recipe, &progress)
            })
            .await?
        }
        DerivationRecipe::Family(recipe) => {
            Ok(DerivedVersion::from_document(fleet::derive_member(inputs, ship, recipe).await?))
        }
        DerivationRecipe::Training(recipe) => {
            trained::derive_trained(inputs, ship, recipe, progress).await
        }
        DerivationRecipe::Registered(_) => Err(DeriveError::Lost(
            "the model was imported and has no recipe: it cannot be reproduced here".into(),
        )),
        DerivationRecipe::Diagnosis(recipe) => {
            let document = diagnosed::run_diagnosis_on(inputs, recipe.clone(), progress)
                .await?
                .to_version()?;
            // The recipe belongs to a version, so the diagnosis did find an effect when it was
            // made.
            let nothing = || {
                DeriveError::Lost(
                    "the repeated diagnosis finds no effect, so that it gives no version".into(),
                )
            };
            Ok(DerivedVersion::from_document(document.ok_or_else(nothing)?))
        }
    }?;
    // Every document that was read must be named by the recipe, else it could not be derived again.
    inputs.check_recipe(recipe)?;
    Ok(derived)
}
