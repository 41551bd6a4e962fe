//! Versions of models: insert-only, and numbered without gaps.

use serde_json::json;

use crate::actor::Actor;
use crate::alias_lookups::CurrentVersion;
use crate::aliases::{self, AliasMove};
use crate::arguments::args;
use crate::database::AuditedTransaction;
use crate::error::{Result, StoreError};
use crate::objects::{ObjectStorage, sha256_hex};
use crate::page::{ListPage, PageRequest};
use crate::record::record;
use crate::statements::{same, statements};
use crate::store::Store;
use crate::version::{NewVersion, Version, VersionHead, check_id, missing_version};

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
pub struct VersionRepository<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the repository of versions (insert-only).
    pub fn versions(&self) -> VersionRepository<'_> {
        VersionRepository(self)
    }
}

impl VersionRepository<'_> {
    /// Creates the next version of a model and moves aliases to it, all or nothing.
    pub async fn create(&self, new: &NewVersion, moves: &[AliasMove]) -> Result<VersionHead> {
        let mut tx = self.0.begin().await?;
        let version = insert_version(self.0, &mut tx, new, moves).await?;
        tx.commit().await?;
        Ok(version)
    }

    /// Returns a version without its document.
    pub async fn get_head(&self, model: &str, number: i64) -> Result<VersionHead> {
        let found =
            self.0.database().fetch_optional(HEAD, args![model: model, number: number]).await?;
        found.ok_or_else(|| missing_version(model, number))
    }

    /// Returns a version by its number.
    pub async fn get(&self, model: &str, number: i64) -> Result<Version> {
        let version =
            self.0.database().fetch_optional(GET, args![model: model, number: number]).await?;
        version.ok_or_else(|| missing_version(model, number))
    }

    /// Returns the version that an alias of a ship points to now; none if the ship or the alias
    /// does not exist.
    pub async fn current_version(&self, ship: &str, alias: &str) -> Result<Option<CurrentVersion>> {
        self.0.current_version(ship, alias).await
    }

    /// Returns a version by its id.
    pub async fn by_id(&self, id: &str) -> Result<Version> {
        let version = self.0.database().fetch_optional(BY_ID, args![id: id]).await?;
        version.ok_or_else(|| StoreError::not_found("version", id))
    }

    /// Returns the version of a model with the highest number.
    pub async fn latest(&self, model: &str) -> Result<Version> {
        let version = self.0.database().fetch_optional(LATEST, args![model: model]).await?;
        version.ok_or_else(|| StoreError::not_found("model", model))
    }

    /// Lists the versions of a model, the latest first.
    pub async fn list(
        &self,
        model: &str,
        page: &PageRequest<i64>,
    ) -> Result<ListPage<VersionHead, i64>> {
        let values = args![model: model, after: page.after, limit: page.fetch_limit()?];
        let versions = self.0.database().fetch_all(LIST, values).await?;
        Ok(page.build_page(versions, |version: &VersionHead| version.number))
    }

    /// Lists all versions of all models with their documents, in the order of their creation.
    pub async fn list_all(&self, page: &PageRequest) -> Result<ListPage<Version>> {
        let versions = self
            .0
            .database()
            .fetch_all(ALL, args![after: &page.after, limit: page.fetch_limit()?])
            .await?;
        Ok(page.build_page(versions, |version: &Version| version.head.id.clone()))
    }

    /// Lists the keys of objects with the weights of learned corrections.
    pub async fn list_weights(&self, page: &PageRequest) -> Result<ListPage<WeightsKey>> {
        let values = args![after: &page.after, limit: page.fetch_limit()?];
        let keys = self.0.database().fetch_all(WEIGHTS, values).await?;
        Ok(page.build_page(keys, |key: &WeightsKey| key.weights_key.clone()))
    }

    /// Creates the next version of a model, whose learned correction has its weights in `objects`,
    /// and moves aliases to it, all or nothing. If the weights are no longer there, because
    /// [`Store::remove_unreferred`] has removed them meanwhile, nothing is created.
    pub async fn create_with_weights(
        &self,
        objects: &ObjectStorage,
        new: &NewVersion,
        moves: &[AliasMove],
    ) -> Result<VersionHead> {
        let mut tx = self.0.begin().await?;
        let version = insert_version(self.0, &mut tx, new, moves).await?;
        objects.check_present(new.weights.iter().cloned()).await?;
        tx.commit().await?;
        Ok(version)
    }

    /// Lists the versions of any model that were made from the version `id`, the oldest first.
    pub async fn list_children(
        &self,
        id: &str,
        page: &PageRequest,
    ) -> Result<ListPage<VersionHead>> {
        let values = args![parent: id, after: &page.after, limit: page.fetch_limit()?];
        let versions = self.0.database().fetch_all(CHILDREN, values).await?;
        Ok(page.build_page(versions, |version: &VersionHead| version.id.clone()))
    }
}

/// Creates a version and moves aliases to it within a transaction.
pub(crate) async fn insert_version(
    store: &Store,
    tx: &mut AuditedTransaction,
    new: &NewVersion,
    moves: &[AliasMove],
) -> Result<VersionHead> {
    new.check_fields()?;
    if let Some(parent) = &new.parent {
        check_id(tx, "parent", parent).await?;
    }
    // From here on the row of the model is locked until the commit.
    let NextNumber { number } = tx.fetch_one(NUMBER, args![model: &new.model]).await?;
    let (id, sha256) = (store.new_id(), sha256_hex(new.document.as_bytes()));
    let author = Actor::current().name;
    let values = args![id: &id, model: &new.model, number: number, parent: &new.parent,
        law: &new.law, method: &new.method,
        document: &new.document, sha256: &sha256, created_us: store.now_us(),
        weights_key: &new.weights, author: &author];
    let version: VersionHead = tx.fetch_one(INSERT, values).await?;
    let after = json!({ "sha256": sha256, "method": new.method, "law": new.law });
    tx.record_audit_event(
        store.now_us(),
        "version.create",
        format!("version:{}/{number}", new.model),
        None,
        Some(after),
    );
    for alias in moves {
        aliases::move_alias(store, tx, &new.model, number, alias).await?;
    }
    Ok(version)
}
