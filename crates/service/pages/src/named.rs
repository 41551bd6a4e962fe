//! Resolution of version names: `ship`, `ship/number`, `ship/alias`.

use sistership_jobs::Archive;
use sistership_jobs::aliases::{CHAMPION, find_alias};
use sistership_jobs::archive::version_document;
use sistership_jobs::version::VersionDocument;
use sistership_model::Law;
use sistership_store::{StoreError, Version, VersionHead};

use crate::error::{PageError, Result};
use crate::language::say;

/// A version with its document and law, ready to be simulated.
pub(crate) struct NamedVersion {
    pub head: VersionHead,
    pub document: VersionDocument,
    pub law: Law,
}

impl NamedVersion {
    /// Returns the version that a name refers to; `field` is named in errors.
    ///
    /// # Errors
    /// Returns an error if the name refers to nothing, or if the archive fails.
    pub async fn find(archive: &Archive, field: &str, name: &str) -> Result<Self> {
        let version = find_version(archive, field, name).await?;
        let mut document = version_document(&version)?;
        archive.attach_weights(&mut document.model).await?;
        let law = archive.law_by_hash(&document.model.law, document.recipe.law_sha256()).await?;
        Ok(Self { head: version.head, document, law })
    }

    /// Ship and number.
    pub fn label(&self) -> String {
        format!("{}/{}", self.head.model, self.head.number)
    }
}

async fn find_version(archive: &Archive, field: &str, name: &str) -> Result<Version> {
    let nothing = || PageError::invalid_field(field, say("form-no-model").with("name", name));
    let (ship, rest) = name.split_once('/').unwrap_or((name, CHAMPION));
    let number = match rest.parse() {
        Ok(number) => number,
        Err(_) => find_alias(&archive.store, ship, rest).await?.ok_or_else(nothing)?.version_number,
    };
    match archive.store.versions().get(ship, number).await {
        Err(StoreError::NotFound { .. }) => Err(nothing()),
        other => Ok(other?),
    }
}
