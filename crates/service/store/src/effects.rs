//! Libraries of effects: documents under their hashes, nothing that ever changes.

use crate::arguments::args;
use crate::error::{Result, StoreError};
use crate::objects::sha256_hex;
use crate::page::{List, Page};
use crate::record::record;
use crate::statements::{same, statements};
use crate::store::Store;

statements! {
    INSERT = same("INSERT INTO effect_libraries (sha256, document, created_us) VALUES ($1, $2, $3) \
        ON CONFLICT (sha256) DO NOTHING");
    GET = same("SELECT sha256, document, created_us FROM effect_libraries WHERE sha256 = $1");
    LIST = same("SELECT sha256, document, created_us FROM effect_libraries WHERE sha256 > \
        COALESCE($1, '') ORDER BY sha256 LIMIT $2");
}

record! {
    /// A library of effects as it was put in.
    pub struct EffectLibrary {
        /// The SHA-256 of the document.
        pub sha256: String,
        /// The files of its effects one after another, byte for byte.
        pub document: String,
        /// When it was put in.
        pub created_us: i64,
    }
}

/// The libraries of effects of a store.
#[derive(Debug, Clone, Copy)]
pub struct EffectLibraries<'a>(pub(crate) &'a Store);

impl Store {
    /// Libraries of effects, insert-only.
    pub fn effects(&self) -> EffectLibraries<'_> {
        EffectLibraries(self)
    }
}

impl EffectLibraries<'_> {
    /// Puts a library in, beside those that are there, and answers its hash. One that is there is
    /// not written again, so that this costs a look where nothing is new.
    pub async fn keep(&self, document: &str) -> Result<String> {
        let sha256 = sha256_hex(document.as_bytes());
        if self.find(&sha256).await?.is_none() {
            let mut tx = self.0.begin().await?;
            tx.execute(
                INSERT,
                args![sha256: &sha256, document: document, created_us: self.0.now_us()],
            )
            .await?;
            tx.commit().await?;
        }
        Ok(sha256)
    }

    /// The library of this hash.
    pub async fn get(&self, sha256: &str) -> Result<EffectLibrary> {
        self.find(sha256).await?.ok_or_else(|| StoreError::missing("library of effects", sha256))
    }

    async fn find(&self, sha256: &str) -> Result<Option<EffectLibrary>> {
        self.0.database().optional(GET, args![sha256: sha256]).await
    }

    /// All libraries by hash.
    pub async fn list(&self, page: &Page) -> Result<List<EffectLibrary>> {
        let libraries =
            self.0.database().all(LIST, args![after: &page.after, limit: page.fetch()?]).await?;
        Ok(page.of(libraries, |library: &EffectLibrary| library.sha256.clone()))
    }
}
