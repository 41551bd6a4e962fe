//! Diagnoses of versions: findings, and the reports on them. They are created by
//! [`Store::commit_diagnosis`] only.

use crate::arguments::args;
use crate::checks;
use crate::database::AuditedTransaction;
use crate::error::Result;
use crate::page::{ListPage, PageRequest};
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
    // Ids are in the order of time, and '~' sorts after every one: without a cursor a list starts at
    // the latest.
    NEWEST = same("SELECT id, version_id, made_id, report_id, verdict, effects, trials, \
        unexplained, drift, created_us FROM diagnoses WHERE id < '~' ORDER BY id DESC LIMIT $1");
    BY_VERSION = same("SELECT id, version_id, made_id, report_id, verdict, effects, trials, \
        unexplained, drift, created_us FROM diagnoses WHERE (version_id = $1 OR made_id = $1) AND id < COALESCE($2, \
        '~') ORDER BY id DESC LIMIT $3");
}

record! {
    /// A diagnosis of a version.
    pub struct DiagnosisRow {
        /// Its id.
        pub id: String,
        /// The id of the version that was diagnosed.
        pub version_id: String,
        /// Id of the resulting version, if there is one.
        pub made_id: Option<String>,
        /// The id of its report.
        pub report_id: String,
        /// `complete`, `effects` or `unexplained`.
        pub verdict: String,
        /// Names of the effects found, a JSON list.
        pub effects: String,
        /// Ids of the diagnosed trials, a JSON list.
        pub trials: String,
        /// Ids of the trials with a residual that no effect explains, a JSON list.
        pub unexplained: String,
        /// Ratio of the residual of the champion on new trials to that on the trials of its fit,
        /// JSON; none if it could not be determined or another version was diagnosed.
        pub drift: Option<String>,
        /// When it was made.
        pub created_us: i64,
    }
}

/// Findings of a diagnosis, to be stored; its report and the resulting version are known at the
/// commit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NewDiagnosisRow {
    /// The id of the version that was diagnosed.
    pub version_id: String,
    /// `complete`, `effects` or `unexplained`.
    pub verdict: String,
    /// Names of the effects found, a JSON list.
    pub effects: String,
    /// Ids of the diagnosed trials, a JSON list.
    pub trials: String,
    /// Ids of the trials with a residual that no effect explains, a JSON list.
    pub unexplained: String,
    /// Ratio of the residual of the champion on new trials to that on the trials of its fit, JSON.
    pub drift: Option<String>,
}

/// Repository of diagnoses.
#[derive(Debug, Clone, Copy)]
pub struct DiagnosisRepository<'a>(pub(crate) &'a Store);

impl Store {
    /// Returns the repository of diagnoses.
    pub fn diagnoses(&self) -> DiagnosisRepository<'_> {
        DiagnosisRepository(self)
    }
}

impl DiagnosisRepository<'_> {
    /// Lists all diagnoses in the order of their creation.
    pub async fn list_all(&self, page: &PageRequest) -> Result<ListPage<DiagnosisRow>> {
        let diagnoses = self
            .0
            .database()
            .fetch_all(ALL, args![after: &page.after, limit: page.fetch_limit()?])
            .await?;
        Ok(page.build_page(diagnoses, |diagnosis: &DiagnosisRow| diagnosis.id.clone()))
    }

    /// Lists the newest diagnoses of all ships, the latest first.
    pub async fn list_newest(&self, limit: i64) -> Result<Vec<DiagnosisRow>> {
        self.0.database().fetch_all(NEWEST, args![limit: limit]).await
    }

    /// Lists the diagnoses that concern a version, the latest first: those of the version, and the
    /// one from which it resulted.
    pub async fn by_version(
        &self,
        version_id: &str,
        page: &PageRequest,
    ) -> Result<ListPage<DiagnosisRow>> {
        let values = args![version_id: version_id, after: &page.after, limit: page.fetch_limit()?];
        let diagnoses = self.0.database().fetch_all(BY_VERSION, values).await?;
        Ok(page.build_page(diagnoses, |diagnosis: &DiagnosisRow| diagnosis.id.clone()))
    }
}

/// Inserts a diagnosis within a transaction.
pub(crate) async fn insert_diagnosis(
    store: &Store,
    tx: &mut AuditedTransaction,
    new: &NewDiagnosisRow,
    made_id: Option<&str>,
    report_id: &str,
) -> Result<DiagnosisRow> {
    checks::check_name("verdict", &new.verdict)?;
    checks::check_json("effects", &new.effects)?;
    checks::check_json("trials", &new.trials)?;
    checks::check_json("unexplained", &new.unexplained)?;
    new.drift.as_deref().map_or(Ok(()), |drift| checks::check_json("drift", drift))?;
    version::check_id(tx, "version_id", &new.version_id).await?;
    let id = store.new_id();
    let values = args![id: &id, version_id: &new.version_id, made_id: made_id,
        report_id: report_id, verdict: &new.verdict,
        effects: &new.effects, trials: &new.trials, unexplained: &new.unexplained,
        drift: &new.drift, created_us: store.now_us()];
    tx.fetch_one(INSERT, values).await
}
