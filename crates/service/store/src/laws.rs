//! Laws of motion: a name, its document, nothing that ever changes.

use serde_json::json;

use crate::arguments::args;
use crate::checks;
use crate::error::{Result, StoreError};
use crate::objects::sha256_hex;
use crate::page::{List, Page};
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
    /// A law of motion as it was put in.
    pub struct Law {
        /// Its name.
        pub name: String,
        /// Its text, byte for byte.
        pub document: String,
        /// The SHA-256 of the text.
        pub sha256: String,
        /// When it was put in.
        pub created_us: i64,
    }
}

/// The laws of a store.
#[derive(Debug, Clone, Copy)]
pub struct Laws<'a>(pub(crate) &'a Store);

impl Store {
    /// Laws of motion, insert-only.
    pub fn laws(&self) -> Laws<'_> {
        Laws(self)
    }
}

impl Laws<'_> {
    /// Puts a law in. The same text again changes nothing; another text under the same name is a
    /// conflict.
    pub async fn insert(&self, name: &str, document: &str) -> Result<Law> {
        checks::name("name", name)?;
        let sha256 = sha256_hex(document.as_bytes());
        let mut tx = self.0.begin().await?;
        let values =
            args![name: name, document: document, sha256: &sha256, created_us: self.0.now_us()];
        if tx.execute(INSERT, values).await? > 0 {
            let after = json!({ "sha256": sha256 });
            tx.note(self.0.now_us(), "law.create", format!("law:{name}"), None, Some(after));
        }
        let law: Law = tx.one(GET, args![name: name]).await?;
        tx.commit().await?;
        match law.sha256 == sha256 {
            true => Ok(law),
            false => Err(StoreError::conflict(
                "law",
                name,
                "exists with another text, and a law never changes",
            )),
        }
    }

    /// The law of this name.
    pub async fn get(&self, name: &str) -> Result<Law> {
        let law = self.0.database().optional(GET, args![name: name]).await?;
        law.ok_or_else(|| StoreError::missing("law", name))
    }

    /// All laws by name.
    pub async fn list(&self, page: &Page) -> Result<List<Law>> {
        let laws =
            self.0.database().all(LIST, args![after: &page.after, limit: page.fetch()?]).await?;
        Ok(page.of(laws, |law: &Law| law.name.clone()))
    }
}
