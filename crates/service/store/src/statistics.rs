//! Sufficient statistics of trials, keyed by the hash of all their inputs. They can be computed
//! again from the samples, so that concurrent writers need no order: the first one is kept.

use crate::arguments::args;
use crate::checks;
use crate::error::{Result, StoreError};
use crate::objects::sha256_hex;
use crate::record::record;
use crate::statements::{same, statements};
use crate::store::Store;

statements! {
    PUT = same("INSERT INTO trial_statistics (key, document, sha256, created_us) VALUES ($1, $2, \
        $3, $4) ON CONFLICT (key) DO NOTHING");
    GET = same("SELECT key, document, sha256 FROM trial_statistics WHERE key = $1");
}

record! {
    /// The statistics of a trial.
    pub struct StatisticsRow {
        /// Hash of all inputs of the statistics.
        pub key: String,
        /// The statistics, JSON.
        pub document: String,
        /// The hash of the document.
        pub sha256: String,
    }
}

/// Repository of sufficient statistics.
#[derive(Debug, Clone, Copy)]
pub struct TrialStatistics<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the repository of sufficient statistics.
    pub fn statistics(&self) -> TrialStatistics<'_> {
        TrialStatistics(self)
    }
}

impl TrialStatistics<'_> {
    /// Stores statistics, pairs of key and document, all or nothing; existing ones stay.
    pub async fn insert_all(&self, all: &[(String, String)]) -> Result<()> {
        let mut tx = self.0.begin().await?;
        for (key, document) in all {
            checks::check_sha256("key", key)?;
            checks::check_json("document", document)?;
            let sha256 = sha256_hex(document.as_bytes());
            let values =
                args![key: key, document: document, sha256: &sha256, created_us: self.0.now_us()];
            tx.execute(PUT, values).await?;
        }
        tx.commit().await
    }

    /// Returns the document of a key, if it exists.
    ///
    /// # Errors
    /// Returns a conflict if the document does not have its hash.
    pub async fn get(&self, key: &str) -> Result<Option<String>> {
        let Some(found) =
            self.0.database().fetch_optional::<StatisticsRow>(GET, args![key: key]).await?
        else {
            return Ok(None);
        };
        match sha256_hex(found.document.as_bytes()) == found.sha256 {
            true => Ok(Some(found.document)),
            false => Err(StoreError::conflict(
                "statistics",
                key,
                "the document does not have its hash: the database is damaged",
            )),
        }
    }
}
