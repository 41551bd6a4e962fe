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
pub use calibrated::{corrected_with_uncertainty, with_uncertainty};
pub use derived::{Derived, Ingredients, Progress, Refined};
pub use diagnosed::{Diagnosed, diagnosed};
pub use published::published_document;
pub use refined::refined_document;

use crate::archive::Archive;
use crate::fleet;
use crate::inputs::Inputs;
use crate::recipe::Recipe;

/// Derives the version of a ship that a recipe describes.
///
/// # Errors
/// Returns an error if an input is missing or has changed, or if the derivation is refused.
pub async fn derive(
    archive: &Archive,
    ship: &str,
    recipe: &Recipe,
    progress: Progress,
) -> Result<Derived, DeriveError> {
    let inputs = &Inputs::new(archive);
    let derived = match recipe {
        Recipe::Plain(version::Recipe::Published { model, ship_sha256, law_sha256 }) => {
            published::published(inputs, ship, model, ship_sha256, law_sha256).await
        }
        Recipe::Plain(recipe @ version::Recipe::Refinement { .. }) => {
            // All reads come first: the refinement itself is a function on a blocking thread.
            let ingredients = refined::gather(inputs, ship, recipe).await?;
            let recipe = recipe.clone();
            tokio::task::spawn_blocking(move || refined::refined(ingredients, &recipe, &progress))
                .await?
        }
        Recipe::Family(recipe) => Ok(Derived::of(fleet::derived(inputs, ship, recipe).await?)),
        Recipe::Training(recipe) => trained::trained(inputs, ship, recipe, progress).await,
        Recipe::Registered(_) => Err(DeriveError::Lost(
            "the model was made elsewhere: its own bytes are all there is of it".into(),
        )),
        Recipe::Diagnosis(recipe) => {
            let document =
                diagnosed::diagnosed_from(inputs, recipe.clone(), progress).await?.document()?;
            // The recipe belongs to a version, so the diagnosis did find an effect when it was
            // made.
            let nothing = || {
                DeriveError::Lost(
                    "the diagnosis finds no effect now, so that no version comes of it".into(),
                )
            };
            Ok(Derived::of(document.ok_or_else(nothing)?))
        }
    }?;
    // Every document that was read must be named by the recipe, else it could not be derived again.
    inputs.check(recipe)?;
    Ok(derived)
}
