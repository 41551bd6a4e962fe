//! Versions as rows, and whether there is one.

use crate::arguments::args;
use crate::checks;
use crate::database::Transaction;
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
    /// A version, but for its document.
    pub struct VersionHead {
        /// Its id.
        pub id: String,
        /// The model (the ship's name).
        pub model: String,
        /// 1, 2, 3, ... within the model.
        pub number: i64,
        /// The id of the version it was made from.
        pub parent: Option<String>,
        /// The law of motion.
        pub law: String,
        /// How it was made: `published-source`, `published`, `weak`, `trajectory`, ...
        pub method: String,
        /// The SHA-256 of the document.
        pub sha256: String,
        /// When it was made.
        pub created_us: i64,
        /// Who asked for it; none where it was made before that was kept.
        pub author: Option<String>,
    }
}

record! {
    /// A version.
    pub struct Version {
        flatten head: VersionHead,
        /// The whole record of the version as canonical JSON, byte for byte.
        pub document: String,
    }
}

/// What a version is made of. The document holds neither the number nor the time: the same recipe
/// gives the same bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NewVersion {
    /// The model (the ship's name).
    pub model: String,
    /// The id of the version it is made from.
    pub parent: Option<String>,
    /// The law of motion.
    pub law: String,
    /// How it was made.
    pub method: String,
    /// The whole record of the version as canonical JSON.
    pub document: String,
    /// The key of the object with the weights of its learned branch, where it has one.
    pub weights: Option<String>,
}

impl NewVersion {
    /// Whether every field may be kept.
    pub(crate) fn check(&self) -> Result<()> {
        checks::name("model", &self.model)?;
        checks::name("law", &self.law)?;
        checks::name("method", &self.method)?;
        self.weights.as_deref().map_or(Ok(()), |key| checks::sha256("weights", key))?;
        checks::json("document", &self.document)
    }
}

/// Whether the transaction sees this version.
pub(crate) async fn check_exists(tx: &mut Transaction, model: &str, number: i64) -> Result<()> {
    let version: Option<VersionHead> =
        tx.optional(HEAD, args![model: model, number: number]).await?;
    version.map(drop).ok_or_else(|| missing(model, number))
}

/// Whether the transaction sees the version that `field` names.
pub(crate) async fn check_id(tx: &mut Transaction, field: &'static str, id: &str) -> Result<()> {
    let version: Option<VersionHead> = tx.optional(HEAD_BY_ID, args![id: id]).await?;
    version
        .map(drop)
        .ok_or_else(|| StoreError::invalid(field, format!("there is no version `{id}`")))
}

/// The error of a version that is not there.
pub(crate) fn missing(model: &str, number: i64) -> StoreError {
    StoreError::missing("version", format!("{model}/{number}"))
}
