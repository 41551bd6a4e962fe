//! Versions as rows, and checks of their existence.

use crate::arguments::args;
use crate::checks;
use crate::database::AuditedTransaction;
use crate::error::{Result, StoreError};
use crate::record::record;
use crate::statements::{same, statements};

statements! {
    HEAD = same("SELECT id, model, number, parent, law, method, sha256, created_us, author FROM \
        versions WHERE model = $1 AND number = $2");
    HEAD_BY_ID = same("SELECT id, model, number, parent, law, method, sha256, created_us, author \
        FROM versions WHERE id = $1");
}

record! {
    /// A version without its document.
    pub struct VersionHead {
        /// Its id.
        pub id: String,
        /// The model (the ship's name).
        pub model: String,
        /// Number: 1, 2, 3, ... within the model.
        pub number: i64,
        /// Id of the version from which it was made.
        pub parent: Option<String>,
        /// The law of motion.
        pub law: String,
        /// Method: `published-source`, `published`, `weak`, `trajectory`, ...
        pub method: String,
        /// The SHA-256 of the document.
        pub sha256: String,
        /// When it was made.
        pub created_us: i64,
        /// Author, as the audit names it.
        pub author: String,
    }
}

record! {
    /// A version.
    pub struct Version {
        flatten head: VersionHead,
        /// Version document as canonical JSON, byte for byte.
        pub document: String,
    }
}

/// A version to be stored. The document holds neither number nor time: the same recipe gives the
/// same bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NewVersion {
    /// The model (the ship's name).
    pub model: String,
    /// Id of the version from which it is made.
    pub parent: Option<String>,
    /// The law of motion.
    pub law: String,
    /// Method.
    pub method: String,
    /// Version document as canonical JSON.
    pub document: String,
    /// Key of the object with the weights of its learned correction, if it has one.
    pub weights: Option<String>,
}

impl NewVersion {
    /// Checks that all fields can be stored.
    pub(crate) fn check_fields(&self) -> Result<()> {
        checks::check_name("model", &self.model)?;
        checks::check_name("law", &self.law)?;
        checks::check_name("method", &self.method)?;
        self.weights.as_deref().map_or(Ok(()), |key| checks::check_sha256("weights", key))?;
        checks::check_json("document", &self.document)
    }
}

/// Checks that the transaction sees a version of this number.
pub(crate) async fn check_exists(
    tx: &mut AuditedTransaction,
    model: &str,
    number: i64,
) -> Result<()> {
    let version: Option<VersionHead> =
        tx.fetch_optional(HEAD, args![model: model, number: number]).await?;
    version.map(drop).ok_or_else(|| missing_version(model, number))
}

/// Checks that the transaction sees the version of an id; an error names `field`.
pub(crate) async fn check_id(
    tx: &mut AuditedTransaction,
    field: &'static str,
    id: &str,
) -> Result<()> {
    let version: Option<VersionHead> = tx.fetch_optional(HEAD_BY_ID, args![id: id]).await?;
    version
        .map(drop)
        .ok_or_else(|| StoreError::invalid(field, format!("there is no version `{id}`")))
}

/// Returns the error of a missing version.
pub(crate) fn missing_version(model: &str, number: i64) -> StoreError {
    StoreError::not_found("version", format!("{model}/{number}"))
}
