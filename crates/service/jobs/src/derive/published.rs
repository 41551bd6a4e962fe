//! Versions of models that a ship's own document publishes.

use serde_json::Value;
use sistership_model::version::{self, FORMAT};
use sistership_model::{FileError, Law, Model, Vessel};

use super::derived::DerivedVersion;
use crate::error::DeriveError;
use crate::inputs::DerivationInputs;
use crate::recipe::DerivationRecipe;
use crate::version::VersionDocument;

/// Derives the version from the ship's document that the recipe names by hash.
pub(super) async fn derive_published(
    inputs: &DerivationInputs<'_>,
    ship: &str,
    model: &str,
    ship_sha256: &str,
    law_sha256: &str,
) -> Result<DerivedVersion, DeriveError> {
    let vessel = inputs.read_ship(ship, ship_sha256).await?;
    let lost = || DeriveError::Lost(format!("the ship `{ship}` has no model `{model}`"));
    // The recipe names no law: the ship's document does.
    let file = vessel.file.models.iter().find(|file| file.name == model).ok_or_else(lost)?;
    let law = inputs.read_law(&file.law, law_sha256).await?;
    let document = published_document(&vessel, model, &law, ship_sha256, law_sha256)?;
    Ok(DerivedVersion::from_document(document))
}

/// Returns the version of a model that a ship's own document publishes.
pub fn published_document(
    vessel: &Vessel,
    model: &str,
    law: &Law,
    ship_sha256: &str,
    law_sha256: &str,
) -> Result<VersionDocument, FileError> {
    Ok(VersionDocument {
        format: FORMAT.to_owned(),
        ship: vessel.name().to_owned(),
        recipe: DerivationRecipe::Plain(version::VersionRecipe::Published {
            model: model.to_owned(),
            ship_sha256: ship_sha256.to_owned(),
            law_sha256: law_sha256.to_owned(),
        }),
        model: Model::from_published(vessel, Some(model), law)?,
        report: Value::Null,
    })
}
