//! Database and objects of an archive, with the inputs of derivations looked up by the SHA-256 of
//! their bytes.

use std::path::Path;
use std::sync::Arc;

use bytes::Bytes;
use sistership_fleet::family::FamilyPrior;
use sistership_model::trial::Trial;
use sistership_model::version::{RecipeTrial, SourceVersion, sha256_hex};
use sistership_model::vessel::VesselFile;
use sistership_model::{Law, Model, Vessel};
use sistership_store::{
    MAX_LIMIT, ObjectStorage, ObjectsPlace, PageRequest, Store, StoreError, SystemClock, Version,
};
use sistership_trials::samples::from_parquet;

use crate::error::DeriveError;
use crate::library::{self, EffectLibrary};
use crate::recipe::PriorName;
use crate::version::VersionDocument;

/// Database with the object store that belongs to it.
#[derive(Debug, Clone)]
pub struct Archive {
    /// The database.
    pub store: Store,
    /// Samples of trials, and weights of learned corrections.
    pub objects: ObjectStorage,
}

type Result<T> = std::result::Result<T, DeriveError>;

impl Archive {
    /// Opens the database at the URL with the objects in a folder.
    ///
    /// # Errors
    /// Returns an error that names which of them cannot be opened.
    pub async fn open(database_url: &str, data_dir: &Path) -> sistership_store::Result<Self> {
        Self::open_at(database_url, &ObjectsPlace::Folder(data_dir.to_path_buf())).await
    }

    /// Opens the database at the URL with the objects at a place (folder or object store).
    ///
    /// # Errors
    /// Returns an error that names which of them cannot be opened.
    pub async fn open_at(
        database_url: &str,
        samples: &ObjectsPlace,
    ) -> sistership_store::Result<Self> {
        let objects = ObjectStorage::open_at(samples)?;
        match objects.write_marker().await {
            // Not fatal: the server writes the mark once there is space again.
            Err(error) if error.is_out_of_space() => {
                tracing::error!(%error, "the objects could not be marked")
            }
            // Not fatal: requests that need no objects are served, and `/readyz` reports that the
            // object store does not answer.
            Err(error) if error.is_transient() => {
                tracing::error!(%error, "the object store does not answer")
            }
            other => other?,
        }
        let store = Store::connect(database_url, Arc::new(SystemClock)).await?;
        match library::store_library(&store).await {
            // Not fatal: derivations of this release wait for space on the disk, too.
            Err(error) if error.is_out_of_space() => {
                tracing::error!(%error, "the library of effects could not be stored")
            }
            other => other?,
        }
        Ok(Self { store, objects })
    }

    /// Returns the ship at the revision whose document has this hash.
    pub async fn ship_by_hash(&self, name: &str, hash: &str) -> Result<Vessel> {
        // Revisions are found by the hash of the document itself: the recipe names no revision
        // number.
        let mut page = PageRequest::first_page(MAX_LIMIT);
        loop {
            let revisions = self.store.ships().list_revisions(name, &page).await?;
            if let Some(found) = revisions
                .items
                .iter()
                .find(|revision| sha256_hex(revision.document.as_bytes()) == hash)
            {
                return parse_vessel(name, &found.document);
            }
            let lost = || {
                DeriveError::Lost(format!("no revision of the ship `{name}` has the hash {hash}"))
            };
            page = PageRequest::after_key(revisions.next.ok_or_else(lost)?, MAX_LIMIT);
        }
    }

    /// Returns the law of this name, whose text must have this hash.
    pub async fn law_by_hash(&self, name: &str, hash: &str) -> Result<Law> {
        let law = self.store.laws().get(name).await?;
        check_hash(&format!("the law `{name}`"), &law.document, hash)?;
        Ok(Law::parse(&law.name, &law.document)?)
    }

    /// Returns the model of a version, with the weights of its learned correction, if it has one.
    ///
    /// # Errors
    /// Returns an error if the version cannot be read, or if its weights are missing, damaged or
    /// those of another model.
    pub async fn model_with_weights(&self, version: &Version) -> Result<Model> {
        let mut model = version_document(version)?.model;
        self.attach_weights(&mut model).await?;
        Ok(model)
    }

    /// Attaches the weights of a model's learned correction, if it has one.
    ///
    /// # Errors
    /// Returns an error if the weights are missing, damaged or those of another model.
    pub async fn attach_weights(&self, model: &mut Model) -> Result<()> {
        let Some(branch) = &model.branch else { return Ok(()) };
        let weights = self.objects.get(&branch.weights_sha256).await?;
        Ok(sistership_learned::attach(model, &weights)?)
    }

    /// Returns the source model of a refinement, without the weights of its learned correction.
    pub async fn source_model(&self, source: &SourceVersion) -> Result<Model> {
        let version = self.store.versions().get(&source.ship, source.number).await?;
        let SourceVersion { ship, number, sha256 } = source;
        check_hash(&format!("version {ship}/{number}"), &version.document, sha256)?;
        Ok(version_document(&version)?.model)
    }

    /// Returns the library of effects with this hash.
    pub async fn effect_library(&self, hash: &str) -> Result<EffectLibrary> {
        let found = match self.store.effect_libraries().get(hash).await {
            Err(StoreError::NotFound { .. }) => {
                let mend = "restore it from a backup, or open the store once with a release that \
                            includes it";
                return Err(DeriveError::Lost(format!(
                    "the store has no library of effects {hash}: {mend}"
                )));
            }
            other => other?,
        };
        check_hash("the library of effects", &found.document, hash)?;
        Ok(EffectLibrary::parse(&found.document)?)
    }

    /// Returns the prior of a family at the revision that a recipe names.
    pub async fn family_prior(&self, name: &PriorName) -> Result<FamilyPrior> {
        let PriorName { family, revision, sha256 } = name;
        let row = self.store.families().get_prior(family, Some(*revision)).await?;
        check_hash(
            &format!("the prior of the family `{family}` at revision {revision}"),
            &row.document,
            sha256,
        )?;
        Ok(serde_json::from_str(&row.document)?)
    }

    /// Returns trials with their samples, in the order given. Each is decoded before the next is
    /// fetched, so that at most one is in memory in its stored form.
    pub async fn read_trials(&self, trials: &[RecipeTrial]) -> Result<Vec<Trial>> {
        let mut read = Vec::with_capacity(trials.len());
        for trial in trials {
            let samples: Bytes = self.objects.get(&trial.sha256).await?;
            read.push(tokio::task::spawn_blocking(move || from_parquet(samples)).await??);
        }
        Ok(read)
    }
}

/// Parses a ship from its document.
pub fn parse_vessel(name: &str, document: &str) -> Result<Vessel> {
    let file: VesselFile =
        serde_json::from_str(document).map_err(|error| damaged_document("ship", name, &error))?;
    Ok(Vessel::from_file(name, file)?)
}

/// Checks that a document has the hash that is asked for. The hash is computed from the bytes: the
/// recorded one may belong to a document that was damaged later.
fn check_hash(what: &str, document: &str, hash: &str) -> Result<()> {
    match sha256_hex(document.as_bytes()) {
        actual if actual == hash => Ok(()),
        actual => Err(DeriveError::Lost(format!(
            "{what} has the hash {actual} instead of {hash}: it is damaged or was replaced"
        ))),
    }
}

/// Parses the document of a version.
pub fn version_document(version: &Version) -> Result<VersionDocument> {
    let name = format!("{}/{}", version.head.model, version.head.number);
    serde_json::from_str(&version.document)
        .map_err(|error| damaged_document("version", &name, &error))
}

fn damaged_document(kind: &str, name: &str, error: &serde_json::Error) -> DeriveError {
    DeriveError::Lost(format!("the document of the {kind} `{name}` cannot be parsed: {error}"))
}
