//! Everything that a version can be derived from, found by the hash of its bytes.

use std::path::Path;
use std::sync::Arc;

use bytes::Bytes;
use sistership_model::version::{RecipeTrial, SourceVersion, sha256};
use sistership_model::vessel::VesselFile;
use sistership_model::{Law, Model, Vessel};
use sistership_store::{MAX_LIMIT, Objects, ObjectsPlace, Page, Store, SystemClock, Version};

use crate::derive::DeriveError;
use crate::version::VersionDocument;

/// The database and the samples that belong to it.
#[derive(Debug, Clone)]
pub struct Archive {
    /// The database.
    pub store: Store,
    /// The samples of trials.
    pub objects: Objects,
}

type Result<T> = std::result::Result<T, DeriveError>;

impl Archive {
    /// Opens the database at the URL and the samples in a folder.
    ///
    /// # Errors
    /// Says which of them cannot be opened.
    pub async fn open(database_url: &str, data_dir: &Path) -> sistership_store::Result<Self> {
        Self::open_at(database_url, &ObjectsPlace::Folder(data_dir.to_path_buf())).await
    }

    /// Opens the database at the URL and the samples where they are.
    ///
    /// # Errors
    /// Says which of them cannot be opened.
    pub async fn open_at(database_url: &str, samples: &ObjectsPlace) -> sistership_store::Result<Self> {
        let objects = Objects::at(samples)?;
        match objects.mark().await {
            // The server leaves it once there is room.
            Err(error) if error.is_out_of_space() => tracing::error!(%error, "the objects could not be marked"),
            other => other?,
        }
        Ok(Self { store: Store::connect(database_url, Arc::new(SystemClock)).await?, objects })
    }

    /// The ship as she was when her document had this hash.
    pub(crate) async fn ship(&self, name: &str, hash: &str) -> Result<Vessel> {
        let mut page = Page::first(MAX_LIMIT);
        loop {
            let revisions = self.store.ships().revisions(name, &page).await?;
            if let Some(found) = revisions.items.iter().find(|revision| sha256(revision.document.as_bytes()) == hash) {
                return vessel(name, &found.document);
            }
            let lost = || DeriveError::Lost(format!("no revision of the ship `{name}` has the hash {hash}"));
            page = Page::after(revisions.next.ok_or_else(lost)?, MAX_LIMIT);
        }
    }

    /// The law of this name, whose text must have this hash.
    pub(crate) async fn law(&self, name: &str, hash: &str) -> Result<Law> {
        let law = self.store.laws().get(name).await?;
        if law.sha256 != hash {
            return Err(DeriveError::Lost(format!("the law `{name}` has the hash {}, not {hash}", law.sha256)));
        }
        Ok(Law::parse(&law.name, &law.document)?)
    }

    /// The model of a version that another starts from.
    pub(crate) async fn source(&self, source: &SourceVersion) -> Result<Model> {
        let version = self.store.versions().get(&source.ship, source.number).await?;
        if version.head.sha256 != source.sha256 {
            let SourceVersion { ship, number, sha256 } = source;
            return Err(DeriveError::Lost(format!("version {ship}/{number} has the hash {}, not {sha256}", version.head.sha256)));
        }
        Ok(document(&version)?.model)
    }

    /// The samples of trials, in their order.
    pub(crate) async fn samples(&self, trials: &[RecipeTrial]) -> Result<Vec<Bytes>> {
        let mut samples = Vec::with_capacity(trials.len());
        for trial in trials {
            samples.push(self.objects.get(&trial.sha256).await?);
        }
        Ok(samples)
    }
}

/// A ship from her document.
pub(crate) fn vessel(name: &str, document: &str) -> Result<Vessel> {
    let file: VesselFile = serde_json::from_str(document).map_err(|error| damaged("ship", name, &error))?;
    Ok(Vessel::from_file(name, file)?)
}

/// What a version holds.
pub(crate) fn document(version: &Version) -> Result<VersionDocument> {
    let name = format!("{}/{}", version.head.model, version.head.number);
    serde_json::from_str(&version.document).map_err(|error| damaged("version", &name, &error))
}

fn damaged(kind: &str, name: &str, error: &serde_json::Error) -> DeriveError {
    DeriveError::Lost(format!("the document of the {kind} `{name}` does not read: {error}"))
}
