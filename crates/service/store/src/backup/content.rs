//! Content of a backup: a copy of the database, as files and, for PostgreSQL, tables.

use serde::{Deserialize, Serialize};

/// Query of the keys of all objects that rows refer to: the samples of trials, and the weights of
/// learned corrections.
pub(crate) const OBJECT_KEYS: &str = "SELECT object_key FROM trials UNION \
    SELECT weights_key FROM versions WHERE weights_key IS NOT NULL ORDER BY 1";

/// Kind of database.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum DatabaseKind {
    /// SQLite: one file.
    Sqlite,
    /// PostgreSQL: one file for each table.
    Postgres,
}

/// A file of a backup.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileHead {
    /// Size, bytes.
    pub bytes: u64,
    /// The SHA-256 of its bytes.
    pub sha256: String,
}

/// A table that is a file of its own.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TableHead {
    /// Its name.
    pub name: String,
    /// Its columns in the order of the file.
    pub columns: Vec<String>,
}

/// Copy of a database as it was at one moment.
pub(crate) struct DatabaseCopy {
    pub kind: DatabaseKind,
    pub schema: i64,
    /// Files below the backup's folder.
    pub files: Vec<String>,
    pub tables: Vec<TableHead>,
    /// The objects that its rows refer to.
    pub keys: Vec<String>,
}

impl DatabaseKind {
    /// Returns the scheme with which the URL of such a database begins.
    pub(crate) fn url_scheme(self) -> &'static str {
        match self {
            Self::Sqlite => "sqlite:",
            Self::Postgres => "postgres:",
        }
    }

    /// Returns true if a URL names a database of this kind.
    pub(crate) fn matches_url(self, url: &str) -> bool {
        match self {
            Self::Sqlite => url.starts_with("sqlite:"),
            Self::Postgres => url.starts_with("postgres:") || url.starts_with("postgresql:"),
        }
    }
}
