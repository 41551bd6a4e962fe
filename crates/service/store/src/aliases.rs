//! Aliases: names of versions that move by compare-and-swap and remember every move.

use serde_json::{Value, json};

use crate::arguments::args;
use crate::checks;
use crate::database::AuditedTransaction;
use crate::error::{Result, StoreError};
use crate::page::{ListPage, PageRequest};
use crate::record::record;
use crate::search_index;
use crate::settings;
use crate::statements::{pair, same, statements};
use crate::store::Store;
use crate::version;
use crate::webhooks;

/// The alias whose moves are reported to webhooks.
const CHAMPION_ALIAS: &str = "champion";

statements! {
    // The row of the model is locked, so that moves within one model are serial and the history has
    // no gap. SQLite has one writer and needs no row lock.
    LOCK = pair("SELECT name FROM models WHERE name = $1", "SELECT name FROM models WHERE name = \
        $1 FOR UPDATE");
    PUT = same("INSERT INTO aliases (model, alias, version_number, revision) VALUES ($1, $2, $3, \
        1) ON CONFLICT (model, alias) DO UPDATE SET version_number = excluded.version_number, \
        revision = aliases.revision + 1 RETURNING model, alias, version_number, revision");
    REMEMBER = same("INSERT INTO alias_moves (id, model, alias, from_number, to_number, revision, \
        reason, actor, moved_us) VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9)");
    GET = same("SELECT model, alias, version_number, revision FROM aliases WHERE model = $1 AND \
        alias = $2");
    LIST = same("SELECT model, alias, version_number, revision FROM aliases \
        WHERE model = $1 AND alias > COALESCE($2, '') ORDER BY alias LIMIT $3");
    // Descending list: without a cursor it starts below i64::MAX, that is, at the latest revision.
    HISTORY = same("SELECT id, model, alias, from_number, to_number, revision, reason, actor, \
        moved_us FROM alias_moves WHERE model = $1 AND alias = $2 AND revision < COALESCE($3, \
        9223372036854775807) ORDER BY revision DESC LIMIT $4");
}

record! {
    /// An alias and the version that it points to.
    pub struct Alias {
        /// The model.
        pub model: String,
        /// The alias: `champion`, `candidate`, any.
        pub alias: String,
        /// Number of the version that it points to.
        pub version_number: i64,
        /// Revision of the alias: 1 at first, increased by one with each move.
        pub revision: i64,
    }
}

record! {
    /// One move of an alias.
    pub struct AliasChange {
        /// Its id.
        pub id: String,
        /// The model.
        pub model: String,
        /// The alias.
        pub alias: String,
        /// Number of the version before the move; none for the first one.
        pub from_number: Option<i64>,
        /// Number of the version after the move.
        pub to_number: i64,
        /// Revision of the alias after the move.
        pub revision: i64,
        /// Reason of the move.
        pub reason: String,
        /// Author of the move.
        pub actor: String,
        /// Time of the move, microseconds since 1970.
        pub moved_us: i64,
    }
}

record! {
    /// A model whose row is locked.
    pub struct LockedModel {
        /// The model.
        pub name: String,
    }
}

/// Precondition on the present revision of an alias that is to move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExpectedRevision {
    /// No condition.
    Any,
    /// The alias does not exist yet.
    Absent,
    /// The alias is at this revision.
    Revision(i64),
}

impl ExpectedRevision {
    fn is_fulfilled(self, current: Option<i64>) -> bool {
        match self {
            Self::Any => true,
            Self::Absent => current.is_none(),
            Self::Revision(revision) => current == Some(revision),
        }
    }
}

/// A requested move of an alias.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AliasMove {
    /// The alias.
    pub alias: String,
    /// Precondition of the move (compare-and-swap).
    pub expect: ExpectedRevision,
    /// Reason of the move, kept in the history.
    pub reason: String,
    /// Author of the move, kept in the history.
    pub actor: String,
}

/// Repository of aliases.
#[derive(Debug, Clone, Copy)]
pub struct AliasRepository<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the repository of aliases and their history.
    pub fn aliases(&self) -> AliasRepository<'_> {
        AliasRepository(self)
    }
}

impl AliasRepository<'_> {
    /// Moves an alias of a model to the version number `to`.
    ///
    /// # Errors
    /// Returns an error if the precondition of the move does not hold, or if the version does not
    /// exist.
    pub async fn move_to(&self, model: &str, to: i64, change: &AliasMove) -> Result<Alias> {
        let mut tx = self.0.begin().await?;
        let alias = move_alias(self.0, &mut tx, model, to, change).await?;
        tx.commit().await?;
        Ok(alias)
    }

    /// Returns an alias of a model.
    pub async fn get(&self, model: &str, alias: &str) -> Result<Alias> {
        let found =
            self.0.database().fetch_optional(GET, args![model: model, alias: alias]).await?;
        found.ok_or_else(|| StoreError::not_found("alias", format!("{model}/{alias}")))
    }

    /// Lists the aliases of a model, ordered by name.
    pub async fn list(&self, model: &str, page: &PageRequest) -> Result<ListPage<Alias>> {
        let values = args![model: model, after: &page.after, limit: page.fetch_limit()?];
        let aliases = self.0.database().fetch_all(LIST, values).await?;
        Ok(page.build_page(aliases, |alias: &Alias| alias.alias.clone()))
    }

    /// Lists the moves of an alias, the latest first; the cursor is the revision.
    pub async fn list_history(
        &self,
        model: &str,
        alias: &str,
        page: &PageRequest<i64>,
    ) -> Result<ListPage<AliasChange, i64>> {
        let values =
            args![model: model, alias: alias, after: page.after, limit: page.fetch_limit()?];
        let changes = self.0.database().fetch_all(HISTORY, values).await?;
        Ok(page.build_page(changes, |change: &AliasChange| change.revision))
    }
}

/// Moves an alias within a transaction.
pub(crate) async fn move_alias(
    store: &Store,
    tx: &mut AuditedTransaction,
    model: &str,
    to: i64,
    change: &AliasMove,
) -> Result<Alias> {
    checks::check_name("alias", &change.alias)?;
    // The lock comes before the read of the present revision: between both no other move may pass.
    lock_model(tx, model).await?;
    version::check_exists(tx, model, to).await?;
    let before: Option<Alias> =
        tx.fetch_optional(GET, args![model: model, alias: &change.alias]).await?;
    let current = before.as_ref().map(|alias| alias.revision);
    if !change.expect.is_fulfilled(current) {
        return Err(StoreError::precondition_failed(
            "alias",
            format!("{model}/{}", change.alias),
            current,
        ));
    }
    settings::check_promotion(tx, model, &change.alias, to).await?;
    let after =
        tx.fetch_one(PUT, args![model: model, alias: &change.alias, version_number: to]).await?;
    let from = before.as_ref().map(|alias| alias.version_number);
    record_move(store, tx, before, &after, change).await?;
    search_index::queue_moved(store, tx, model, &change.alias).await?;
    if change.alias == CHAMPION_ALIAS {
        let about =
            json!({ "from": from, "version": to, "reason": change.reason, "actor": change.actor });
        // Within the same transaction: a move that is undone is never reported.
        webhooks::notify(store, tx, webhooks::CHAMPION_MOVED, model, about).await?;
    }
    Ok(after)
}

async fn lock_model(tx: &mut AuditedTransaction, model: &str) -> Result<()> {
    let locked: Option<LockedModel> = tx.fetch_optional(LOCK, args![model: model]).await?;
    locked.map(drop).ok_or_else(|| StoreError::not_found("model", model))
}

async fn record_move(
    store: &Store,
    tx: &mut AuditedTransaction,
    before: Option<Alias>,
    after: &Alias,
    change: &AliasMove,
) -> Result<()> {
    let place =
        |alias: &Alias| json!({ "version": alias.version_number, "revision": alias.revision });
    let mut now = place(after);
    now["reason"] = Value::from(change.reason.as_str());
    let subject = format!("alias:{}/{}", after.model, after.alias);
    tx.record_audit_event(
        store.now_us(),
        "alias.move",
        subject,
        before.as_ref().map(place),
        Some(now),
    );
    let from = before.map(|alias| alias.version_number);
    let id = store.new_id();
    let values = args![id: &id, model: &after.model, alias: &after.alias, from_number: from,
        to_number: after.version_number,
        revision: after.revision, reason: &change.reason, actor: &change.actor,
        moved_us: store.now_us()];
    tx.execute(REMEMBER, values).await.map(drop)
}
