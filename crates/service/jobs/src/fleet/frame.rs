//! Starting model of a member: its champion, or the foundation transferred to it.

use sistership_model::version::{SourceVersion, sha256_hex};
use sistership_model::{Law, Model};
use sistership_priors::transfer::transfer_model;
use sistership_store::Version;

use super::choices::Start;
use super::order::LoadedOrder;
use crate::aliases::CHAMPION;
use crate::archive::{Archive, parse_vessel, version_document};
use crate::error::DeriveError;
use crate::inputs::DerivationInputs;
use crate::recipe::FamilyRecipe;

/// Source of the starting models of a family's members.
pub struct StartingModels<'a> {
    /// Archive with champions and documents.
    pub archive: &'a Archive,
    /// Version that the family is founded on.
    pub foundation: &'a SourceVersion,
    /// Its model.
    pub model: &'a Model,
    /// Its law.
    pub law: &'a Law,
}

/// Starting model of a member.
#[derive(Debug)]
pub struct StartingModel {
    /// The model that is refined.
    pub model: Model,
    /// The version that it comes from.
    pub from: SourceVersion,
    /// The hash of the ship's document, if the foundation was transferred to it.
    pub ship_sha256: Option<String>,
    /// The id of the version, if it is one of the ship.
    pub version_id: Option<String>,
    /// The revision of its champion.
    pub champion: Option<i64>,
    /// True if the version has effects or a learned correction, which are removed from the model
    /// that is refined.
    pub is_reduced: bool,
}

impl StartingModels<'_> {
    /// Returns the present starting model of a member.
    ///
    /// # Errors
    /// Returns an error if the version is damaged, or if its law or coefficients differ from those
    /// of the foundation.
    pub async fn for_member(&self, ship: &str, start: Start) -> Result<StartingModel, DeriveError> {
        let store = &self.archive.store;
        let champion = match store.aliases().get(ship, CHAMPION).await {
            Ok(alias) => Some(alias),
            Err(sistership_store::StoreError::NotFound { .. }) => None,
            Err(error) => return Err(error.into()),
        };
        // The revision is kept also for a start at the foundation: a promotion must not overwrite a
        // champion that was set meanwhile.
        let revision = champion.as_ref().map(|alias| alias.revision);
        if let (Start::Champion, Some(alias)) = (start, champion) {
            let version = store.versions().get(ship, alias.version_number).await?;
            return Ok(StartingModel { champion: revision, ..self.champion_start(version)? });
        }
        let row = store.ships().get(ship).await?;
        let model = transfer_model(self.model, self.law, &parse_vessel(ship, &row.document)?, None);
        let ship_sha256 = Some(sha256_hex(row.document.as_bytes()));
        Ok(StartingModel {
            model,
            from: self.foundation.clone(),
            ship_sha256,
            version_id: None,
            champion: revision,
            is_reduced: false,
        })
    }

    fn champion_start(&self, version: Version) -> Result<StartingModel, DeriveError> {
        let whole = version_document(&version)?.model;
        let is_reduced = whole.branch.is_some() || !whole.effects.is_empty();
        let model = without_extras(whole);
        // Statistics and prior of a family are those of one law and one set of coefficients.
        if model.law != self.model.law
            || !model.coefficients.keys().eq(self.model.coefficients.keys())
        {
            let (own, family) = (&model.name, &self.model.name);
            let message = format!(
                "`{own}` does not have the law and coefficients of the foundation of `{family}`; \
                 start from the foundation"
            );
            return Err(DeriveError::Lost(message));
        }
        let from = SourceVersion {
            ship: version.head.model,
            number: version.head.number,
            sha256: version.head.sha256,
        };
        Ok(StartingModel {
            model,
            from,
            ship_sha256: None,
            version_id: Some(version.head.id),
            champion: None,
            is_reduced,
        })
    }
}

/// Returns the model without its learned correction and effects, which belong to its own trials:
/// the statistics describe only the coefficients.
fn without_extras(model: Model) -> Model {
    Model { effects: Vec::new(), ..model.without_correction() }
}

/// Returns the starting model of a member that a recipe records.
pub(super) async fn recorded_start(
    inputs: &DerivationInputs<'_>,
    loaded: &LoadedOrder,
    ship: &str,
    recipe: &FamilyRecipe,
) -> Result<Model, DeriveError> {
    match &recipe.ship_sha256 {
        Some(hash) => Ok(transfer_model(
            &loaded.foundation,
            &loaded.law,
            &inputs.read_ship(ship, hash).await?,
            None,
        )),
        // Without the hash of a ship's document the member started at its own version.
        None => Ok(without_extras(inputs.read_source(&recipe.start).await?)),
    }
}
