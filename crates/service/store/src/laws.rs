//! Laws of motion: immutable documents by name.

use serde_json::json;

use crate::arguments::args;
use crate::checks;
use crate::error::{Result, StoreError};
use crate::objects::sha256_hex;
use crate::page::{ListPage, PageRequest};
use crate::record::record;
use crate::statements::{same, statements};
use crate::store::Store;

statements! {
    INSERT = same("INSERT INTO laws (name, document, sha256, created_us) VALUES ($1, $2, $3, $4) \
        ON CONFLICT (name) DO NOTHING");
    GET = same("SELECT name, document, sha256, created_us FROM laws WHERE name = $1");
    LIST = same("SELECT name, document, sha256, created_us FROM laws WHERE name > COALESCE($1, '') \
        ORDER BY name LIMIT $2");
}

record! {
    /// A law of motion.
    pub struct Law {
        /// Its name.
        pub name: String,
        /// Document, byte for byte.
        pub document: String,
        /// SHA-256 of the document, hexadecimal.
        pub sha256: String,
        /// When it was put in.
        pub created_us: i64,
    }
}

/// Repository of laws.
#[derive(Debug, Clone, Copy)]
pub struct LawRepository<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the repository of laws of motion (insert-only).
    pub fn laws(&self) -> LawRepository<'_> {
        LawRepository(self)
    }
}

impl LawRepository<'_> {
    /// Inserts a law. The same document again changes nothing; another document under the same name
    /// is a conflict.
    pub async fn insert(&self, name: &str, document: &str) -> Result<Law> {
        checks::check_name("name", name)?;
        let sha256 = sha256_hex(document.as_bytes());
        let mut tx = self.0.begin().await?;
        let values =
            args![name: name, document: document, sha256: &sha256, created_us: self.0.now_us()];
        if tx.execute(INSERT, values).await? > 0 {
            let after = json!({ "sha256": sha256 });
            tx.record_audit_event(
                self.0.now_us(),
                "law.create",
                format!("law:{name}"),
                None,
                Some(after),
            );
        }
        // Reads the stored document, which may be an older one of this name.
        let law: Law = tx.fetch_one(GET, args![name: name]).await?;
        tx.commit().await?;
        match law.sha256 == sha256 {
            true => Ok(law),
            false => Err(StoreError::conflict(
                "law",
                name,
                "exists with a different text; a stored law cannot be changed, so choose another \
                 name",
            )),
        }
    }

    /// Returns the law of a name.
    pub async fn get(&self, name: &str) -> Result<Law> {
        let law = self.0.database().fetch_optional(GET, args![name: name]).await?;
        law.ok_or_else(|| StoreError::not_found("law", name))
    }

    /// Lists all laws by name.
    pub async fn list(&self, page: &PageRequest) -> Result<ListPage<Law>> {
        let laws = self
            .0
            .database()
            .fetch_all(LIST, args![after: &page.after, limit: page.fetch_limit()?])
            .await?;
        Ok(page.build_page(laws, |law: &Law| law.name.clone()))
    }
}
