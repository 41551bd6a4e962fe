//! Libraries of effects: immutable documents, named by their hashes.

use crate::arguments::args;
use crate::error::{Result, StoreError};
use crate::objects::sha256_hex;
use crate::page::{ListPage, PageRequest};
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
    /// A library of effects.
    pub struct EffectLibrary {
        /// The SHA-256 of the document.
        pub sha256: String,
        /// Concatenated files of its effects, byte for byte.
        pub document: String,
        /// When it was put in.
        pub created_us: i64,
    }
}

/// Repository of libraries of effects.
#[derive(Debug, Clone, Copy)]
pub struct EffectLibraries<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the repository of libraries of effects (insert-only).
    pub fn effect_libraries(&self) -> EffectLibraries<'_> {
        EffectLibraries(self)
    }
}

impl EffectLibraries<'_> {
    /// Inserts a library unless it exists, and returns its hash. The existing one is found by a
    /// read, so that repeated calls write nothing.
    pub async fn insert_absent(&self, document: &str) -> Result<String> {
        let sha256 = sha256_hex(document.as_bytes());
        if self.find(&sha256).await?.is_none() {
            let mut tx = self.0.begin().await?;
            // Another process may have inserted it since the read; the conflict is ignored.
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
        self.find(sha256).await?.ok_or_else(|| StoreError::not_found("library of effects", sha256))
    }

    async fn find(&self, sha256: &str) -> Result<Option<EffectLibrary>> {
        self.0.database().fetch_optional(GET, args![sha256: sha256]).await
    }

    /// All libraries by hash.
    pub async fn list(&self, page: &PageRequest) -> Result<ListPage<EffectLibrary>> {
        let libraries = self
            .0
            .database()
            .fetch_all(LIST, args![after: &page.after, limit: page.fetch_limit()?])
            .await?;
        Ok(page.build_page(libraries, |library: &EffectLibrary| library.sha256.clone()))
    }
}
