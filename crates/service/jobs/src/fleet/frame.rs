//! The model that a member is refined from: its champion, or the foundation carried over to it.

use sistership_model::version::{SourceVersion, sha256};
use sistership_model::{Law, Model};
use sistership_priors::transfer::transfer;
use sistership_store::Version;

use super::choices::Start;
use super::order::Loaded;
use crate::archive::{Archive, document, vessel};
use crate::error::DeriveError;
use crate::inputs::Inputs;
use crate::line::CHAMPION;
use crate::recipe::FamilyRecipe;

/// Finds the frames of a family's members.
pub struct Frames<'a> {
    /// Where champions and documents are.
    pub archive: &'a Archive,
    /// What the family is founded on.
    pub foundation: &'a SourceVersion,
    /// Its model.
    pub model: &'a Model,
    /// Its law.
    pub law: &'a Law,
}

/// Where a member starts.
#[derive(Debug)]
pub struct Framed {
    /// The model that is refined.
    pub model: Model,
    /// The version that it is from.
    pub from: SourceVersion,
    /// The hash of its document, where the foundation was carried over to it.
    pub ship_sha256: Option<String>,
    /// The id of the version, if it is its own.
    pub version_id: Option<String>,
    /// The revision of its champion.
    pub champion: Option<i64>,
    /// Whether the version has effects or a learned correction, which the model that is refined
    /// does without.
    pub is_reduced: bool,
}

impl Frames<'_> {
    /// Where a member starts now.
    ///
    /// # Errors
    /// A version that is damaged, or of another kind than the foundation.
    pub async fn of(&self, ship: &str, start: Start) -> Result<Framed, DeriveError> {
        let store = &self.archive.store;
        let champion = match store.aliases().get(ship, CHAMPION).await {
            Ok(alias) => Some(alias),
            Err(sistership_store::StoreError::NotFound { .. }) => None,
            Err(error) => return Err(error.into()),
        };
        let revision = champion.as_ref().map(|alias| alias.revision);
        if let (Start::Champion, Some(alias)) = (start, champion) {
            let version = store.versions().get(ship, alias.version_number).await?;
            return Ok(Framed { champion: revision, ..self.own(version)? });
        }
        let row = store.ships().get(ship).await?;
        let model = transfer(self.model, self.law, &vessel(ship, &row.document)?, None);
        let ship_sha256 = Some(sha256(row.document.as_bytes()));
        Ok(Framed {
            model,
            from: self.foundation.clone(),
            ship_sha256,
            version_id: None,
            champion: revision,
            is_reduced: false,
        })
    }

    fn own(&self, version: Version) -> Result<Framed, DeriveError> {
        let whole = document(&version)?.model;
        let is_reduced = whole.branch.is_some() || !whole.effects.is_empty();
        let model = reduced(whole);
        if model.law != self.model.law
            || !model.coefficients.keys().eq(self.model.coefficients.keys())
        {
            let (own, family) = (&model.name, &self.model.name);
            let message = format!(
                "`{own}` does not have the law and coefficients of the foundation `{family}`; \
                 start at the foundation"
            );
            return Err(DeriveError::Lost(message));
        }
        let from = SourceVersion {
            ship: version.head.model,
            number: version.head.number,
            sha256: version.head.sha256,
        };
        Ok(Framed {
            model,
            from,
            ship_sha256: None,
            version_id: Some(version.head.id),
            champion: None,
            is_reduced,
        })
    }
}

/// A model whose coefficients statistics describe: without a learned correction, and without
/// effects, which belong to its own trials.
fn reduced(model: Model) -> Model {
    Model { effects: Vec::new(), ..model.foundation() }
}

/// Where a member started, as a recipe has it.
pub(super) async fn recorded(
    inputs: &Inputs<'_>,
    loaded: &Loaded,
    ship: &str,
    recipe: &FamilyRecipe,
) -> Result<Model, DeriveError> {
    match &recipe.ship_sha256 {
        Some(hash) => {
            Ok(transfer(&loaded.foundation, &loaded.law, &inputs.ship(ship, hash).await?, None))
        }
        None => Ok(reduced(inputs.source(&recipe.start).await?)),
    }
}
