//! The one transaction that ends a diagnosis: its report, what was found, the version that came of
//! it, and its job.

use serde_json::{Value, json};

use crate::aliases::AliasMove;
use crate::database::Transaction;
use crate::diagnoses::{self, Diagnosed, NewDiagnosed};
use crate::error::Result;
use crate::job::Job;
use crate::reports::{self, NewReport, ReportHead};
use crate::search_index;
use crate::store::Store;
use crate::version::{NewVersion, VersionHead};
use crate::versions;
use crate::webhooks;
use crate::work;

/// What a diagnosis brings.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnosis {
    /// The version with the effects and the aliases that move to it, where effects were found.
    pub version: Option<(NewVersion, Vec<AliasMove>)>,
    /// The report; its `version_id` becomes that of the version that came of it.
    pub report: NewReport,
    /// What was found.
    pub found: NewDiagnosed,
    /// The diagnosis of what is new alone, where this one is of earlier trials, too.
    pub of_new: Option<PartDiagnosis>,
    /// How many times as much the champion leaves of new trials as of those that it was fitted on,
    /// where that is known.
    pub drift: Option<f64>,
}

/// A diagnosis of a part of the trials, of which no version comes.
#[derive(Debug, Clone, PartialEq)]
pub struct PartDiagnosis {
    /// The report.
    pub report: NewReport,
    /// What was found.
    pub found: NewDiagnosed,
}

/// The verdict by which nothing is missing.
const COMPLETE: &str = "complete";

/// What has become of a diagnosis.
#[derive(Debug, Clone, PartialEq)]
pub struct CommittedDiagnosis {
    /// The version, now numbered.
    pub version: Option<VersionHead>,
    /// The report.
    pub report: ReportHead,
    /// What was found.
    pub found: Diagnosed,
    /// The job, done.
    pub job: Job,
}

impl Store {
    /// Keeps what a diagnosis brings and ends its job, all or nothing: a worker that has lost the
    /// job to another (an older `fence`) leaves nothing behind. `result` writes the job's result,
    /// JSON, from what was kept.
    pub async fn commit_diagnosis<F>(
        &self,
        job: &str,
        fence: i64,
        diagnosis: &Diagnosis,
        result: F,
    ) -> Result<CommittedDiagnosis>
    where
        F: FnOnce(Option<&VersionHead>, &ReportHead) -> String,
    {
        let mut tx = self.begin().await?;
        let of_new = match &diagnosis.of_new {
            Some(part) => Some(self.put(&mut tx, part, None).await?),
            None => None,
        };
        let version = match &diagnosis.version {
            Some((version, moves)) => Some(versions::insert(self, &mut tx, version, moves).await?),
            None => None,
        };
        let made_id = version.as_ref().map(|version| version.id.clone());
        let report = NewReport { version_id: made_id.clone(), ..diagnosis.report.clone() };
        let all = PartDiagnosis { report, found: diagnosis.found.clone() };
        let (report, found) = self.put(&mut tx, &all, made_id.as_deref()).await?;
        let told = match of_new {
            Some((_, of_new)) if found.verdict == COMPLETE => of_new,
            _ => found.clone(),
        };
        tell(self, &mut tx, diagnosis, &told).await?;
        // How the ship stands has changed.
        search_index::mark(self, &mut tx, &diagnosis.report.ship).await?;
        let result = result(version.as_ref(), &report);
        let job = work::complete(&mut tx, job, fence, &result, self.now_us()).await?;
        tx.commit().await?;
        Ok(CommittedDiagnosis { version, report, found, job })
    }

    /// Puts a report and what was found in.
    async fn put(
        &self,
        tx: &mut Transaction,
        part: &PartDiagnosis,
        made_id: Option<&str>,
    ) -> Result<(ReportHead, Diagnosed)> {
        let report = reports::insert(self, tx, &part.report).await?;
        let found = diagnoses::insert(self, tx, &part.found, made_id, &report.id).await?;
        let after = json!({ "ship": part.report.ship, "verdict": found.verdict });
        let subject = format!("diagnosis:{}", found.id);
        tx.note(self.now_us(), "diagnosis.create", subject, None, Some(after));
        Ok((report, found))
    }
}

/// Tells others of a version that lacks something, and of a champion that no longer holds as it
/// did.
async fn tell(
    store: &Store,
    tx: &mut Transaction,
    diagnosis: &Diagnosis,
    found: &Diagnosed,
) -> Result<()> {
    let ship = &diagnosis.report.ship;
    if found.verdict != COMPLETE {
        let effects: Value = serde_json::from_str(&found.effects).unwrap_or_default();
        let about = json!({ "diagnosis": found.id, "verdict": found.verdict, "effects": effects,
            "report": found.report_id });
        webhooks::tell(store, tx, webhooks::DIAGNOSIS_FAILED, ship, about).await?;
    }
    match diagnosis.drift {
        Some(ratio) => webhooks::tell_drift(store, tx, ratio, ship).await,
        None => Ok(()),
    }
}
