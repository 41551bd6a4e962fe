//! Trials: metadata of recorded manoeuvres; their samples are objects, named by their hash.

use std::collections::BTreeSet;

use serde_json::{Value, json};

use crate::arguments::args;
use crate::checks;
use crate::database::AuditedTransaction;
use crate::error::{Result, StoreError};
use crate::job::{Job, NewJob};
use crate::jobs;
use crate::objects::ObjectStorage;
use crate::page::{ListPage, PageRequest};
use crate::record::{RowCount, record};
use crate::search_index;
use crate::ships;
use crate::statements::{pair, same, statements};
use crate::store::Store;

statements! {
    // The same samples of a ship again: no row is inserted, and the next statement returns the
    // existing one.
    INSERT = same("INSERT INTO trials (id, ship, sha256, name, manifest, conventions, manoeuvre, \
        sample_rows, duration_s, warnings, object_key, created_us) VALUES ($1, $2, $3, $4, $5, $6, \
        $7, $8, $9, $10, $11, $12) ON CONFLICT (ship, sha256) DO NOTHING");
    // Deleted or not. On PostgreSQL the row is locked, so that it is not deleted before the commit.
    STORED = pair(
        "SELECT id, ship, sha256, name, manifest, conventions, manoeuvre, sample_rows, \
            duration_s, warnings, object_key, created_us, deleted_us FROM trials WHERE ship = $1 \
            AND sha256 = $2",
        "SELECT id, ship, sha256, name, manifest, conventions, manoeuvre, sample_rows, \
            duration_s, warnings, object_key, created_us, deleted_us FROM trials WHERE ship = $1 \
            AND sha256 = $2 FOR NO KEY UPDATE",
    );
    GET = same("SELECT id, ship, sha256, name, manifest, conventions, manoeuvre, sample_rows, \
        duration_s, warnings, object_key, created_us, deleted_us FROM trials WHERE id = $1 AND \
        deleted_us IS NULL");
    FIND = same("SELECT id, ship, sha256, name, manifest, conventions, manoeuvre, sample_rows, \
        duration_s, warnings, object_key, created_us, deleted_us FROM trials WHERE ship = $1 AND \
        sha256 = $2 AND deleted_us IS NULL");
    LIST = same("SELECT id, ship, sha256, name, manifest, conventions, manoeuvre, sample_rows, \
        duration_s, warnings, object_key, created_us, deleted_us FROM trials \
        WHERE ship = $1 AND id > COALESCE($2, '') AND deleted_us IS NULL ORDER BY id LIMIT $3");
    // Includes deleted trials, which versions may still name.
    WAS = same("SELECT COUNT(*) AS rows FROM trials WHERE id = $1");
    ALL = same("SELECT id, ship, sha256, name, manifest, conventions, manoeuvre, sample_rows, \
        duration_s, warnings, object_key, created_us, deleted_us FROM trials WHERE id > \
        COALESCE($1, '') ORDER BY id LIMIT $2");
    DELETE = same("UPDATE trials SET deleted_us = $2 WHERE id = $1 AND deleted_us IS NULL \
        RETURNING id, ship, sha256, name, manifest, conventions, manoeuvre, sample_rows, \
        duration_s, warnings, object_key, created_us, deleted_us");
    UNDELETE = same("UPDATE trials SET deleted_us = NULL WHERE id = $1 AND deleted_us IS NOT NULL \
        RETURNING id, ship, sha256, name, manifest, conventions, manoeuvre, sample_rows, \
        duration_s, warnings, object_key, created_us, deleted_us");
}

record! {
    /// A trial of a ship.
    pub struct Trial {
        /// Its id.
        pub id: String,
        /// The ship.
        pub ship: String,
        /// The SHA-256 of the samples.
        pub sha256: String,
        /// Name given by the uploader.
        pub name: String,
        /// The manifest, JSON.
        pub manifest: String,
        /// Conventions of the input file, JSON.
        pub conventions: String,
        /// Manoeuvre, if known.
        pub manoeuvre: Option<String>,
        /// The number of samples.
        pub sample_rows: i64,
        /// Duration, s.
        pub duration_s: f64,
        /// Warnings of the checks, JSON.
        pub warnings: String,
        /// Key of the object with the samples, see [`crate::Objects`].
        pub object_key: String,
        /// Time of the upload, microseconds since 1970.
        pub created_us: i64,
        /// When it was deleted, if it is.
        pub deleted_us: Option<i64>,
    }
}

/// A trial to be stored. Its object must be in the object store before the trial is inserted.
#[derive(Debug, Clone, PartialEq)]
pub struct NewTrial {
    /// The ship.
    pub ship: String,
    /// The SHA-256 of the samples.
    pub sha256: String,
    /// Name given by the uploader.
    pub name: String,
    /// The manifest, JSON.
    pub manifest: String,
    /// Conventions of the input file, JSON.
    pub conventions: String,
    /// Manoeuvre, if known.
    pub manoeuvre: Option<String>,
    /// The number of samples.
    pub sample_rows: i64,
    /// Duration, s.
    pub duration_s: f64,
    /// Warnings of the checks, JSON.
    pub warnings: String,
    /// Key of the object with the samples.
    pub object_key: String,
}

impl NewTrial {
    fn check_fields(&self) -> Result<()> {
        checks::check_sha256("sha256", &self.sha256)?;
        checks::check_sha256("object_key", &self.object_key)?;
        checks::check_json("manifest", &self.manifest)?;
        checks::check_json("conventions", &self.conventions)?;
        checks::check_json("warnings", &self.warnings)?;
        checks::check_count("sample_rows", self.sample_rows)?;
        checks::check_not_negative("duration_s", self.duration_s)
    }
}

/// Result of an insertion that may find an existing row.
#[derive(Debug, Clone, PartialEq)]
pub struct InsertOutcome<T> {
    /// The inserted or existing row.
    pub row: T,
    /// True if this call has inserted it.
    pub new: bool,
}

/// Repository of trials.
#[derive(Debug, Clone, Copy)]
pub struct TrialRepository<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the repository of trials; their samples are [`crate::Objects`].
    pub fn trials(&self) -> TrialRepository<'_> {
        TrialRepository(self)
    }
}

impl TrialRepository<'_> {
    /// Inserts a trial. If the ship has a trial with the same samples, that one is returned, and
    /// restored if it was deleted.
    pub async fn insert(&self, new: &NewTrial) -> Result<InsertOutcome<Trial>> {
        let mut inserted = self.insert_all(std::slice::from_ref(new)).await?;
        inserted.pop().ok_or_else(|| StoreError::not_found("trial", &new.name))
    }

    /// Inserts several trials, all or none.
    pub async fn insert_all(&self, all: &[NewTrial]) -> Result<Vec<InsertOutcome<Trial>>> {
        self.insert_with_job(all, None, |_| None).await.map(|(inserted, _)| inserted)
    }

    /// Inserts several trials, all or none, with a subsequent job if `job` returns one: trials and
    /// job become visible together. If an object of theirs is no longer in `objects`, because
    /// [`Store::remove_unreferred`] has removed it meanwhile, the result is an error for the
    /// missing object and nothing is inserted; store the object again and retry.
    pub async fn insert_all_and_enqueue<F>(
        &self,
        all: &[NewTrial],
        objects: &ObjectStorage,
        job: F,
    ) -> Result<(Vec<InsertOutcome<Trial>>, Option<Job>)>
    where
        F: FnOnce(&[InsertOutcome<Trial>]) -> Option<NewJob>,
    {
        self.insert_with_job(all, Some(objects), job).await
    }

    async fn insert_with_job<F>(
        &self,
        all: &[NewTrial],
        objects: Option<&ObjectStorage>,
        job: F,
    ) -> Result<(Vec<InsertOutcome<Trial>>, Option<Job>)>
    where
        F: FnOnce(&[InsertOutcome<Trial>]) -> Option<NewJob>,
    {
        all.iter().try_for_each(NewTrial::check_fields)?;
        let mut tx = self.0.begin().await?;
        let mut inserted = Vec::with_capacity(all.len());
        for new in all {
            inserted.push(self.insert_one(&mut tx, new).await?);
        }
        // Checked after the insertions, which wait for a removal of unreferenced objects in
        // progress.
        if let Some(objects) = objects {
            objects
                .check_present(inserted.iter().map(|trial| trial.row.object_key.clone()))
                .await?;
        }
        // In a fixed order: two transactions that insert trials of the same ships could deadlock
        // otherwise.
        for ship in all.iter().map(|new| &new.ship).collect::<BTreeSet<_>>() {
            search_index::queue_ship(self.0, &mut tx, ship).await?;
        }
        let job = match job(&inserted) {
            Some(new) => Some(jobs::insert_job(self.0, &mut tx, &new).await?),
            None => None,
        };
        tx.commit().await?;
        Ok((inserted, job))
    }

    async fn insert_one(
        &self,
        tx: &mut AuditedTransaction,
        new: &NewTrial,
    ) -> Result<InsertOutcome<Trial>> {
        let id = self.0.new_id();
        ships::find_ship(tx, &new.ship).await?;
        let values = args![id: &id, ship: &new.ship, sha256: &new.sha256, name: &new.name,
            manifest: &new.manifest,
            conventions: &new.conventions, manoeuvre: &new.manoeuvre, sample_rows: new.sample_rows,
            duration_s: new.duration_s, warnings: &new.warnings, object_key: &new.object_key,
            created_us: self.0.now_us()];
        let new_row = tx.execute(INSERT, values).await? == 1;
        let row: Trial = tx.fetch_one(STORED, args![ship: &new.ship, sha256: &new.sha256]).await?;
        if new_row {
            tx.record_audit_event(
                self.0.now_us(),
                "trial.create",
                audit_subject(&row),
                None,
                Some(audit_state(&row)),
            );
        }
        // The upload of a deleted trial restores it.
        let row = if row.deleted_us.is_some() {
            self.restore_row(tx, &row.id).await?.unwrap_or(row)
        } else {
            row
        };
        Ok(InsertOutcome { row, new: new_row })
    }

    /// Removes the mark of deletion within a transaction; `None` if no deleted trial has this id.
    async fn restore_row(&self, tx: &mut AuditedTransaction, id: &str) -> Result<Option<Trial>> {
        let trial: Option<Trial> = tx.fetch_optional(UNDELETE, args![id: id]).await?;
        if let Some(trial) = &trial {
            tx.record_audit_event(
                self.0.now_us(),
                "trial.undelete",
                audit_subject(trial),
                None,
                Some(audit_state(trial)),
            );
        }
        Ok(trial)
    }

    /// Returns the trial of an id.
    pub async fn get(&self, id: &str) -> Result<Trial> {
        let trial = self.0.database().fetch_optional(GET, args![id: id]).await?;
        trial.ok_or_else(|| StoreError::not_found("trial", id))
    }

    /// Returns the trial of a ship with these samples.
    pub async fn find_by_hash(&self, ship: &str, sha256: &str) -> Result<Trial> {
        let trial =
            self.0.database().fetch_optional(FIND, args![ship: ship, sha256: sha256]).await?;
        trial.ok_or_else(|| StoreError::not_found("trial", format!("{ship}/{sha256}")))
    }

    /// Returns true if there is a trial of this id, deleted or not.
    pub async fn ever_existed(&self, id: &str) -> Result<bool> {
        let found: Option<RowCount> = self.0.database().fetch_optional(WAS, args![id: id]).await?;
        Ok(found.is_some_and(|found| found.rows > 0))
    }

    /// Lists all trials of all ships, deleted or not, in the order of their upload.
    pub async fn list_all(&self, page: &PageRequest) -> Result<ListPage<Trial>> {
        let trials = self
            .0
            .database()
            .fetch_all(ALL, args![after: &page.after, limit: page.fetch_limit()?])
            .await?;
        Ok(page.build_page(trials, |trial: &Trial| trial.id.clone()))
    }

    /// Lists the trials of a ship, in the order of their upload.
    pub async fn list(&self, ship: &str, page: &PageRequest) -> Result<ListPage<Trial>> {
        let values = args![ship: ship, after: &page.after, limit: page.fetch_limit()?];
        let trials = self.0.database().fetch_all(LIST, values).await?;
        Ok(page.build_page(trials, |trial: &Trial| trial.id.clone()))
    }

    /// Deletes a trial; [`undelete`](Self::undelete) reverts it. Its samples stay: versions name
    /// them by their hash.
    pub async fn delete(&self, id: &str) -> Result<Trial> {
        let mut tx = self.0.begin().await?;
        let trial: Option<Trial> =
            tx.fetch_optional(DELETE, args![id: id, deleted_us: self.0.now_us()]).await?;
        if let Some(trial) = &trial {
            tx.record_audit_event(
                self.0.now_us(),
                "trial.delete",
                audit_subject(trial),
                Some(audit_state(trial)),
                None,
            );
            search_index::queue_ship(self.0, &mut tx, &trial.ship).await?;
        }
        tx.commit().await?;
        trial.ok_or_else(|| StoreError::not_found("trial", id))
    }

    /// Restores a deleted trial; one that is not deleted is returned as it is.
    pub async fn undelete(&self, id: &str) -> Result<Trial> {
        let mut tx = self.0.begin().await?;
        let trial = match self.restore_row(&mut tx, id).await? {
            Some(trial) => {
                search_index::queue_ship(self.0, &mut tx, &trial.ship).await?;
                Some(trial)
            }
            None => tx.fetch_optional(GET, args![id: id]).await?,
        };
        tx.commit().await?;
        trial.ok_or_else(|| StoreError::not_found("trial", id))
    }
}

/// Returns the subject of audit entries about a trial.
pub(crate) fn audit_subject(trial: &Trial) -> String {
    format!("trial:{}", trial.id)
}

/// Returns the state of a trial for the audit.
fn audit_state(trial: &Trial) -> Value {
    json!({ "ship": trial.ship, "name": trial.name, "sha256": trial.sha256 })
}
