//! Diagnoses of versions: what was found, and where it is reported. They are made by
//! [`Store::commit_diagnosis`] only.

use crate::arguments::args;
use crate::checks;
use crate::database::Transaction;
use crate::error::Result;
use crate::page::{List, Page};
use crate::record::record;
use crate::statements::{same, statements};
use crate::store::Store;
use crate::version;

statements! {
    INSERT = same("INSERT INTO diagnoses (id, version_id, made_id, report_id, verdict, effects, \
        trials, unexplained, drift, created_us) VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10) \
        RETURNING id, version_id, made_id, report_id, verdict, effects, trials, unexplained, drift, \
        created_us");
    ALL = same("SELECT id, version_id, made_id, report_id, verdict, effects, trials, unexplained, \
        drift, created_us FROM diagnoses WHERE id > COALESCE($1, '') ORDER BY id LIMIT $2");
    BY_VERSION = same("SELECT id, version_id, made_id, report_id, verdict, effects, trials, \
        unexplained, drift, created_us FROM diagnoses WHERE (version_id = $1 OR made_id = $1) AND id < COALESCE($2, \
        '~') ORDER BY id DESC LIMIT $3");
}

record! {
    /// A diagnosis of a version.
    pub struct Diagnosed {
        /// Its id.
        pub id: String,
        /// The id of the version that was diagnosed.
        pub version_id: String,
        /// The id of the version that came of it, if one did.
        pub made_id: Option<String>,
        /// The id of its report.
        pub report_id: String,
        /// `complete`, `effects` or `unexplained`.
        pub verdict: String,
        /// Names of the effects found, a JSON list.
        pub effects: String,
        /// Ids of the trials it was made on, a JSON list.
        pub trials: String,
        /// Ids of those of which it leaves something that no effect explains, a JSON list.
        pub unexplained: String,
        /// How much more the champion left of new trials then than of those it was fitted on, JSON;
        /// none where that could not be told, or another version was diagnosed.
        pub drift: Option<String>,
        /// When it was made.
        pub created_us: i64,
    }
}

/// What a diagnosis is made of; its report and what came of it are known when it is committed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NewDiagnosed {
    /// The id of the version that was diagnosed.
    pub version_id: String,
    /// `complete`, `effects` or `unexplained`.
    pub verdict: String,
    /// Names of the effects found, a JSON list.
    pub effects: String,
    /// Ids of the trials it was made on, a JSON list.
    pub trials: String,
    /// Ids of those of which it leaves something that no effect explains, a JSON list.
    pub unexplained: String,
    /// How much more the champion leaves of new trials than of those it was fitted on, JSON.
    pub drift: Option<String>,
}

/// The diagnoses of a store.
#[derive(Debug, Clone, Copy)]
pub struct Diagnoses<'a>(pub(crate) &'a Store);

impl Store {
    /// Diagnoses of versions.
    pub fn diagnoses(&self) -> Diagnoses<'_> {
        Diagnoses(self)
    }
}

impl Diagnoses<'_> {
    /// Every diagnosis, in the order in which they were made.
    pub async fn all(&self, page: &Page) -> Result<List<Diagnosed>> {
        let diagnoses =
            self.0.database().all(ALL, args![after: &page.after, limit: page.fetch()?]).await?;
        Ok(page.of(diagnoses, |diagnosis: &Diagnosed| diagnosis.id.clone()))
    }

    /// The diagnoses that say something of a version, the latest first: those of it, and the one
    /// that it came of.
    pub async fn by_version(&self, version_id: &str, page: &Page) -> Result<List<Diagnosed>> {
        let values = args![version_id: version_id, after: &page.after, limit: page.fetch()?];
        let diagnoses = self.0.database().all(BY_VERSION, values).await?;
        Ok(page.of(diagnoses, |diagnosis: &Diagnosed| diagnosis.id.clone()))
    }
}

/// Puts a diagnosis in within a transaction.
pub(crate) async fn insert(
    store: &Store,
    tx: &mut Transaction,
    new: &NewDiagnosed,
    made_id: Option<&str>,
    report_id: &str,
) -> Result<Diagnosed> {
    checks::name("verdict", &new.verdict)?;
    checks::json("effects", &new.effects)?;
    checks::json("trials", &new.trials)?;
    checks::json("unexplained", &new.unexplained)?;
    new.drift.as_deref().map_or(Ok(()), |drift| checks::json("drift", drift))?;
    version::check_id(tx, "version_id", &new.version_id).await?;
    let id = store.new_id();
    let values = args![id: &id, version_id: &new.version_id, made_id: made_id,
        report_id: report_id, verdict: &new.verdict,
        effects: &new.effects, trials: &new.trials, unexplained: &new.unexplained,
        drift: &new.drift, created_us: store.now_us()];
    tx.one(INSERT, values).await
}
