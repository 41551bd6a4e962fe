//! Versions of models: insert-only, and numbered without gaps.

use serde_json::json;

use crate::actor::Actor;
use crate::aliases::{self, AliasMove};
use crate::arguments::args;
use crate::database::Transaction;
use crate::error::{Result, StoreError};
use crate::objects::{Objects, sha256_hex};
use crate::page::{List, Page};
use crate::questions::CurrentVersion;
use crate::record::record;
use crate::statements::{same, statements};
use crate::store::Store;
use crate::version::{NewVersion, Version, VersionHead, check_id, missing};

statements! {
    // The row of the model stays locked until the commit, and a rolled back transaction returns its
    // number: the numbers have no gaps.
    NUMBER = same("INSERT INTO models (name, next_number) VALUES ($1, 2) \
        ON CONFLICT (name) DO UPDATE SET next_number = models.next_number + 1 RETURNING \
        next_number - 1 AS number");
    INSERT = same("INSERT INTO versions (id, model, number, parent, law, method, document, sha256, \
        created_us, weights_key, author) VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11) \
        RETURNING id, model, number, parent, law, method, sha256, created_us, author");
    GET = same("SELECT id, model, number, parent, law, method, document, sha256, created_us, \
        author FROM versions WHERE model = $1 AND number = $2");
    HEAD = same("SELECT id, model, number, parent, law, method, sha256, created_us, author FROM \
        versions WHERE model = $1 AND number = $2");
    BY_ID = same("SELECT id, model, number, parent, law, method, document, sha256, created_us, \
        author FROM versions WHERE id = $1");
    // By the index of model and number, read backwards.
    LATEST = same("SELECT id, model, number, parent, law, method, document, sha256, created_us, \
        author FROM versions WHERE model = $1 ORDER BY number DESC LIMIT 1");
    LIST = same("SELECT id, model, number, parent, law, method, sha256, created_us, author FROM \
        versions WHERE model = $1 AND number < COALESCE($2, 9223372036854775807) ORDER BY number \
        DESC LIMIT $3");
    // Ids sort by time: the order of ids is that of creation.
    ALL = same("SELECT id, model, number, parent, law, method, document, sha256, created_us, \
        author FROM versions WHERE id > COALESCE($1, '') ORDER BY id LIMIT $2");
    CHILDREN = same("SELECT id, model, number, parent, law, method, sha256, created_us, author \
        FROM versions WHERE parent = $1 AND id > COALESCE($2, '') ORDER BY id LIMIT $3");
    WEIGHTS = same("SELECT DISTINCT weights_key FROM versions WHERE weights_key > COALESCE($1, '') \
        ORDER BY weights_key LIMIT $2");
}

record! {
    /// Key of an object with the weights of a learned correction.
    pub struct WeightsKey {
        /// Its key.
        pub weights_key: String,
    }
}

record! {
    /// Number of a new version.
    pub struct NextNumber {
        /// The number.
        pub number: i64,
    }
}

/// Repository of versions.
#[derive(Debug, Clone, Copy)]
pub struct Versions<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the repository of versions (insert-only).
    pub fn versions(&self) -> Versions<'_> {
        Versions(self)
    }
}

impl Versions<'_> {
    /// Creates the next version of a model and moves aliases to it, all or nothing.
    pub async fn create(&self, new: &NewVersion, moves: &[AliasMove]) -> Result<VersionHead> {
        let mut tx = self.0.begin().await?;
        let version = insert(self.0, &mut tx, new, moves).await?;
        tx.commit().await?;
        Ok(version)
    }

    /// Returns a version without its document.
    pub async fn head(&self, model: &str, number: i64) -> Result<VersionHead> {
        let found = self.0.database().optional(HEAD, args![model: model, number: number]).await?;
        found.ok_or_else(|| missing(model, number))
    }

    /// Returns a version by its number.
    pub async fn get(&self, model: &str, number: i64) -> Result<Version> {
        let version = self.0.database().optional(GET, args![model: model, number: number]).await?;
        version.ok_or_else(|| missing(model, number))
    }

    /// Returns the version that an alias of a ship points to now; none if the ship or the alias
    /// does not exist.
    pub async fn current(&self, ship: &str, alias: &str) -> Result<Option<CurrentVersion>> {
        self.0.current(ship, alias).await
    }

    /// Returns a version by its id.
    pub async fn by_id(&self, id: &str) -> Result<Version> {
        let version = self.0.database().optional(BY_ID, args![id: id]).await?;
        version.ok_or_else(|| StoreError::missing("version", id))
    }

    /// Returns the version of a model with the highest number.
    pub async fn latest(&self, model: &str) -> Result<Version> {
        let version = self.0.database().optional(LATEST, args![model: model]).await?;
        version.ok_or_else(|| StoreError::missing("model", model))
    }

    /// Lists the versions of a model, the latest first.
    pub async fn list(&self, model: &str, page: &Page<i64>) -> Result<List<VersionHead, i64>> {
        let values = args![model: model, after: page.after, limit: page.fetch()?];
        let versions = self.0.database().all(LIST, values).await?;
        Ok(page.of(versions, |version: &VersionHead| version.number))
    }

    /// Lists all versions of all models with their documents, in the order of their creation.
    pub async fn all(&self, page: &Page) -> Result<List<Version>> {
        let versions =
            self.0.database().all(ALL, args![after: &page.after, limit: page.fetch()?]).await?;
        Ok(page.of(versions, |version: &Version| version.head.id.clone()))
    }

    /// Lists the keys of objects with the weights of learned corrections.
    pub async fn weights(&self, page: &Page) -> Result<List<WeightsKey>> {
        let values = args![after: &page.after, limit: page.fetch()?];
        let keys = self.0.database().all(WEIGHTS, values).await?;
        Ok(page.of(keys, |key: &WeightsKey| key.weights_key.clone()))
    }

    /// Creates the next version of a model, whose learned correction has its weights in `objects`,
    /// and moves aliases to it, all or nothing. If the weights are no longer there, because
    /// [`Store::remove_unreferred`] has removed them meanwhile, nothing is created.
    pub async fn create_with_weights(
        &self,
        objects: &Objects,
        new: &NewVersion,
        moves: &[AliasMove],
    ) -> Result<VersionHead> {
        let mut tx = self.0.begin().await?;
        let version = insert(self.0, &mut tx, new, moves).await?;
        objects.must_have(new.weights.iter().cloned()).await?;
        tx.commit().await?;
        Ok(version)
    }

    /// Lists the versions of any model that were made from the version `id`, the oldest first.
    pub async fn children(&self, id: &str, page: &Page) -> Result<List<VersionHead>> {
        let values = args![parent: id, after: &page.after, limit: page.fetch()?];
        let versions = self.0.database().all(CHILDREN, values).await?;
        Ok(page.of(versions, |version: &VersionHead| version.id.clone()))
    }
}

/// Creates a version and moves aliases to it within a transaction.
pub(crate) async fn insert(
    store: &Store,
    tx: &mut Transaction,
    new: &NewVersion,
    moves: &[AliasMove],
) -> Result<VersionHead> {
    new.check()?;
    if let Some(parent) = &new.parent {
        check_id(tx, "parent", parent).await?;
    }
    // From here on the row of the model is locked until the commit.
    let NextNumber { number } = tx.one(NUMBER, args![model: &new.model]).await?;
    let (id, sha256) = (store.new_id(), sha256_hex(new.document.as_bytes()));
    let author = Actor::current().name;
    let values = args![id: &id, model: &new.model, number: number, parent: &new.parent,
        law: &new.law, method: &new.method,
        document: &new.document, sha256: &sha256, created_us: store.now_us(),
        weights_key: &new.weights, author: &author];
    let version: VersionHead = tx.one(INSERT, values).await?;
    let after = json!({ "sha256": sha256, "method": new.method, "law": new.law });
    tx.note(
        store.now_us(),
        "version.create",
        format!("version:{}/{number}", new.model),
        None,
        Some(after),
    );
    for alias in moves {
        aliases::shift(store, tx, &new.model, number, alias).await?;
    }
    Ok(version)
}
