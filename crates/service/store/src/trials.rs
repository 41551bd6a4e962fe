//! Trials: what is known of a recorded manoeuvre; its samples are an object, named by their hash.

use std::collections::BTreeSet;

use serde_json::{Value, json};

use crate::arguments::args;
use crate::checks;
use crate::database::Transaction;
use crate::error::{Result, StoreError};
use crate::job::{Job, NewJob};
use crate::jobs;
use crate::objects::Objects;
use crate::page::{List, Page};
use crate::record::{Counted, record};
use crate::search_index;
use crate::ships;
use crate::statements::{same, statements};
use crate::store::Store;

statements! {
    INSERT = same("INSERT INTO trials (id, ship, sha256, name, manifest, conventions, manoeuvre, \
        sample_rows, duration_s, warnings, object_key, created_us) VALUES ($1, $2, $3, $4, $5, $6, \
        $7, $8, $9, $10, $11, $12) ON CONFLICT (ship, sha256) DO NOTHING");
    REVIVE = same("UPDATE trials SET deleted_us = NULL WHERE ship = $1 AND sha256 = $2 RETURNING \
        id, ship, sha256, name, manifest, conventions, manoeuvre, sample_rows, duration_s, \
        warnings, object_key, created_us, deleted_us");
    GET = same("SELECT id, ship, sha256, name, manifest, conventions, manoeuvre, sample_rows, \
        duration_s, warnings, object_key, created_us, deleted_us FROM trials WHERE id = $1 AND \
        deleted_us IS NULL");
    FIND = same("SELECT id, ship, sha256, name, manifest, conventions, manoeuvre, sample_rows, \
        duration_s, warnings, object_key, created_us, deleted_us FROM trials WHERE ship = $1 AND \
        sha256 = $2 AND deleted_us IS NULL");
    LIST = same("SELECT id, ship, sha256, name, manifest, conventions, manoeuvre, sample_rows, \
        duration_s, warnings, object_key, created_us, deleted_us FROM trials \
        WHERE ship = $1 AND id > COALESCE($2, '') AND deleted_us IS NULL ORDER BY id LIMIT $3");
    WAS = same("SELECT COUNT(*) AS rows FROM trials WHERE id = $1");
    ALL = same("SELECT id, ship, sha256, name, manifest, conventions, manoeuvre, sample_rows, \
        duration_s, warnings, object_key, created_us, deleted_us FROM trials WHERE id > \
        COALESCE($1, '') ORDER BY id LIMIT $2");
    DELETE = same("UPDATE trials SET deleted_us = $2 WHERE id = $1 AND deleted_us IS NULL \
        RETURNING id, ship, sha256, name, manifest, conventions, manoeuvre, sample_rows, \
        duration_s, warnings, object_key, created_us, deleted_us");
    UNDELETE = same("UPDATE trials SET deleted_us = NULL WHERE id = $1 RETURNING id, ship, sha256, \
        name, manifest, conventions, manoeuvre, sample_rows, duration_s, warnings, object_key, \
        created_us, deleted_us");
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
        /// What the uploader called it.
        pub name: String,
        /// The manifest, JSON.
        pub manifest: String,
        /// The conventions of the file it came from, JSON.
        pub conventions: String,
        /// The manoeuvre, where it is known.
        pub manoeuvre: Option<String>,
        /// The number of samples.
        pub sample_rows: i64,
        /// How long it lasts.
        pub duration_s: f64,
        /// What the checks had to say, JSON.
        pub warnings: String,
        /// Where the samples are, see [`crate::Objects`].
        pub object_key: String,
        /// When it was uploaded.
        pub created_us: i64,
        /// When it was deleted, if it is.
        pub deleted_us: Option<i64>,
    }
}

/// What a trial is made of. The object must be in the object store before the trial is inserted.
#[derive(Debug, Clone, PartialEq)]
pub struct NewTrial {
    /// The ship.
    pub ship: String,
    /// The SHA-256 of the samples.
    pub sha256: String,
    /// What the uploader calls it.
    pub name: String,
    /// The manifest, JSON.
    pub manifest: String,
    /// The conventions of the file it comes from, JSON.
    pub conventions: String,
    /// The manoeuvre, where it is known.
    pub manoeuvre: Option<String>,
    /// The number of samples.
    pub sample_rows: i64,
    /// How long it lasts.
    pub duration_s: f64,
    /// What the checks have to say, JSON.
    pub warnings: String,
    /// Where the samples are.
    pub object_key: String,
}

impl NewTrial {
    fn check(&self) -> Result<()> {
        checks::sha256("sha256", &self.sha256)?;
        checks::sha256("object_key", &self.object_key)?;
        checks::json("manifest", &self.manifest)?;
        checks::json("conventions", &self.conventions)?;
        checks::json("warnings", &self.warnings)?;
        checks::count("sample_rows", self.sample_rows)?;
        checks::not_negative("duration_s", self.duration_s)
    }
}

/// What an insertion found or made.
#[derive(Debug, Clone, PartialEq)]
pub struct Inserted<T> {
    /// The row that is there now.
    pub row: T,
    /// Whether this call made it.
    pub new: bool,
}

/// The trials of a store.
#[derive(Debug, Clone, Copy)]
pub struct Trials<'a>(pub(crate) &'a Store);

impl Store {
    /// Trials of ships; their samples are [`crate::Objects`].
    pub fn trials(&self) -> Trials<'_> {
        Trials(self)
    }
}

impl Trials<'_> {
    /// Puts a trial in. The same samples of the same ship again give the trial that is there,
    /// brought back if it was deleted.
    pub async fn insert(&self, new: &NewTrial) -> Result<Inserted<Trial>> {
        let mut inserted = self.insert_all(std::slice::from_ref(new)).await?;
        inserted.pop().ok_or_else(|| StoreError::missing("trial", &new.name))
    }

    /// Puts several trials in, all of them or none.
    pub async fn insert_all(&self, all: &[NewTrial]) -> Result<Vec<Inserted<Trial>>> {
        self.write(all, None, |_| None).await.map(|(inserted, _)| inserted)
    }

    /// The same with a job that is to follow, if `job` asks for one: whoever sees the trials finds
    /// the job too. Where an object of theirs is no longer in `objects`, because
    /// [`Store::remove_unreferred`] was faster, that object is not found and nothing is put in; put
    /// it there again and come back.
    pub async fn insert_all_and_enqueue<F>(
        &self,
        all: &[NewTrial],
        objects: &Objects,
        job: F,
    ) -> Result<(Vec<Inserted<Trial>>, Option<Job>)>
    where
        F: FnOnce(&[Inserted<Trial>]) -> Option<NewJob>,
    {
        self.write(all, Some(objects), job).await
    }

    async fn write<F>(
        &self,
        all: &[NewTrial],
        objects: Option<&Objects>,
        job: F,
    ) -> Result<(Vec<Inserted<Trial>>, Option<Job>)>
    where
        F: FnOnce(&[Inserted<Trial>]) -> Option<NewJob>,
    {
        all.iter().try_for_each(NewTrial::check)?;
        let mut tx = self.0.begin().await?;
        let mut inserted = Vec::with_capacity(all.len());
        for new in all {
            inserted.push(self.insert_one(&mut tx, new).await?);
        }
        if let Some(objects) = objects {
            objects.must_have(inserted.iter().map(|trial| trial.row.object_key.clone())).await?;
        }
        // In one order, or two who put in trials of the same ships would wait for each other.
        for ship in all.iter().map(|new| &new.ship).collect::<BTreeSet<_>>() {
            search_index::mark(self.0, &mut tx, ship).await?;
        }
        let job = match job(&inserted) {
            Some(new) => Some(jobs::insert(self.0, &mut tx, &new).await?),
            None => None,
        };
        tx.commit().await?;
        Ok((inserted, job))
    }

    async fn insert_one(&self, tx: &mut Transaction, new: &NewTrial) -> Result<Inserted<Trial>> {
        let id = self.0.new_id();
        ships::find(tx, &new.ship).await?;
        let values = args![id: &id, ship: &new.ship, sha256: &new.sha256, name: &new.name,
            manifest: &new.manifest,
            conventions: &new.conventions, manoeuvre: &new.manoeuvre, sample_rows: new.sample_rows,
            duration_s: new.duration_s, warnings: &new.warnings, object_key: &new.object_key,
            created_us: self.0.now_us()];
        let inserted = tx.execute(INSERT, values).await?;
        let row: Trial = tx.one(REVIVE, args![ship: &new.ship, sha256: &new.sha256]).await?;
        if inserted == 1 {
            tx.note(self.0.now_us(), "trial.create", subject(&row), None, Some(state(&row)));
        }
        Ok(Inserted { row, new: inserted == 1 })
    }

    /// The trial of this id.
    pub async fn get(&self, id: &str) -> Result<Trial> {
        let trial = self.0.database().optional(GET, args![id: id]).await?;
        trial.ok_or_else(|| StoreError::missing("trial", id))
    }

    /// The trial of a ship with these samples.
    pub async fn find(&self, ship: &str, sha256: &str) -> Result<Trial> {
        let trial = self.0.database().optional(FIND, args![ship: ship, sha256: sha256]).await?;
        trial.ok_or_else(|| StoreError::missing("trial", format!("{ship}/{sha256}")))
    }

    /// Whether there is a trial of this id, deleted or not.
    pub async fn was(&self, id: &str) -> Result<bool> {
        let found: Option<Counted> = self.0.database().optional(WAS, args![id: id]).await?;
        Ok(found.is_some_and(|found| found.rows > 0))
    }

    /// Every trial of every ship, deleted or not, in the order of their upload.
    pub async fn all(&self, page: &Page) -> Result<List<Trial>> {
        let trials =
            self.0.database().all(ALL, args![after: &page.after, limit: page.fetch()?]).await?;
        Ok(page.of(trials, |trial: &Trial| trial.id.clone()))
    }

    /// The trials of a ship, in the order of their upload.
    pub async fn list(&self, ship: &str, page: &Page) -> Result<List<Trial>> {
        let values = args![ship: ship, after: &page.after, limit: page.fetch()?];
        let trials = self.0.database().all(LIST, values).await?;
        Ok(page.of(trials, |trial: &Trial| trial.id.clone()))
    }

    /// Deletes a trial; [`undelete`](Self::undelete) undoes it. Its samples stay: versions name
    /// them by their hash.
    pub async fn delete(&self, id: &str) -> Result<Trial> {
        let mut tx = self.0.begin().await?;
        let trial: Option<Trial> =
            tx.optional(DELETE, args![id: id, deleted_us: self.0.now_us()]).await?;
        if let Some(trial) = &trial {
            tx.note(self.0.now_us(), "trial.delete", subject(trial), Some(state(trial)), None);
            search_index::mark(self.0, &mut tx, &trial.ship).await?;
        }
        tx.commit().await?;
        trial.ok_or_else(|| StoreError::missing("trial", id))
    }

    /// Brings a deleted trial back.
    pub async fn undelete(&self, id: &str) -> Result<Trial> {
        let mut tx = self.0.begin().await?;
        let trial: Option<Trial> = tx.optional(UNDELETE, args![id: id]).await?;
        if let Some(trial) = &trial {
            tx.note(self.0.now_us(), "trial.undelete", subject(trial), None, Some(state(trial)));
            search_index::mark(self.0, &mut tx, &trial.ship).await?;
        }
        tx.commit().await?;
        trial.ok_or_else(|| StoreError::missing("trial", id))
    }
}

/// What stands for a trial in the audit.
fn subject(trial: &Trial) -> String {
    format!("trial:{}", trial.id)
}

/// A trial as the audit has it.
fn state(trial: &Trial) -> Value {
    json!({ "ship": trial.ship, "name": trial.name, "sha256": trial.sha256 })
}
