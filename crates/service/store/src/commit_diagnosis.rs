//! The transaction that ends a diagnosis: its report, its findings, the resulting version, and its
//! job.

use serde_json::{Value, json};

use crate::aliases::AliasMove;
use crate::database::AuditedTransaction;
use crate::diagnoses::{self, DiagnosisRow, NewDiagnosisRow};
use crate::error::Result;
use crate::job::Job;
use crate::reports::{self, NewReport, ReportHead};
use crate::search_index;
use crate::store::Store;
use crate::version::{NewVersion, VersionHead};
use crate::versions;
use crate::webhooks;
use crate::work;

/// Result of a diagnosis, to be stored.
#[derive(Debug, Clone, PartialEq)]
pub struct NewDiagnosis {
    /// The version with the effects found and the aliases that move to it; none if no effect was
    /// found.
    pub version: Option<(NewVersion, Vec<AliasMove>)>,
    /// The report; its `version_id` becomes that of the resulting version.
    pub report: NewReport,
    /// The findings.
    pub found: NewDiagnosisRow,
    /// The diagnosis of the new trials alone, if this one includes earlier trials.
    pub of_new: Option<PartDiagnosis>,
    /// Ratio of the residual of the champion on new trials to that on the trials of its fit, if
    /// known.
    pub drift: Option<f64>,
}

/// A diagnosis of a part of the trials, which gives no version.
#[derive(Debug, Clone, PartialEq)]
pub struct PartDiagnosis {
    /// The report.
    pub report: NewReport,
    /// The findings.
    pub found: NewDiagnosisRow,
}

/// The verdict of a diagnosis that finds no missing effect.
const COMPLETE: &str = "complete";

/// A diagnosis as it was stored.
#[derive(Debug, Clone, PartialEq)]
pub struct CommittedDiagnosis {
    /// The resulting version, with its number.
    pub version: Option<VersionHead>,
    /// The report.
    pub report: ReportHead,
    /// The findings.
    pub found: DiagnosisRow,
    /// The completed job.
    pub job: Job,
}

impl Store {
    /// Stores the result of a diagnosis and completes its job, all or nothing: a worker that has
    /// lost the job to another one (its `fence` is older) changes nothing. `result` writes the
    /// job's result, JSON, from the stored rows.
    pub async fn commit_diagnosis<F>(
        &self,
        job: &str,
        fence: i64,
        diagnosis: &NewDiagnosis,
        result: F,
    ) -> Result<CommittedDiagnosis>
    where
        F: FnOnce(Option<&VersionHead>, &ReportHead) -> String,
    {
        let mut tx = self.begin().await?;
        // The part first: the diagnosis of all trials gets the later id, and is listed before it.
        let of_new = match &diagnosis.of_new {
            Some(part) => Some(self.insert_part(&mut tx, part, None).await?),
            None => None,
        };
        let version = match &diagnosis.version {
            Some((version, moves)) => {
                Some(versions::insert_version(self, &mut tx, version, moves).await?)
            }
            None => None,
        };
        let made_id = version.as_ref().map(|version| version.id.clone());
        let report = NewReport { version_id: made_id.clone(), ..diagnosis.report.clone() };
        let all = PartDiagnosis { report, found: diagnosis.found.clone() };
        let (report, found) = self.insert_part(&mut tx, &all, made_id.as_deref()).await?;
        // If all trials together lack nothing, webhooks get the diagnosis of the new trials alone.
        let told = match of_new {
            Some((_, of_new)) if found.verdict == COMPLETE => of_new,
            _ => found.clone(),
        };
        notify_webhooks(self, &mut tx, diagnosis, &told).await?;
        // The state of the ship has changed, and with it the facts by which it is found.
        search_index::queue_ship(self, &mut tx, &diagnosis.report.ship).await?;
        let result = result(version.as_ref(), &report);
        let job = work::complete_job(&mut tx, job, fence, &result, self.now_us()).await?;
        tx.commit().await?;
        Ok(CommittedDiagnosis { version, report, found, job })
    }

    /// Inserts a report and its findings.
    async fn insert_part(
        &self,
        tx: &mut AuditedTransaction,
        part: &PartDiagnosis,
        made_id: Option<&str>,
    ) -> Result<(ReportHead, DiagnosisRow)> {
        let report = reports::insert_report(self, tx, &part.report).await?;
        let found = diagnoses::insert_diagnosis(self, tx, &part.found, made_id, &report.id).await?;
        let after = json!({ "ship": part.report.ship, "verdict": found.verdict });
        let subject = format!("diagnosis:{}", found.id);
        tx.record_audit_event(self.now_us(), "diagnosis.create", subject, None, Some(after));
        Ok((report, found))
    }
}

/// Notifies webhooks of a version that lacks an effect, and of the drift of a champion.
async fn notify_webhooks(
    store: &Store,
    tx: &mut AuditedTransaction,
    diagnosis: &NewDiagnosis,
    found: &DiagnosisRow,
) -> Result<()> {
    let ship = &diagnosis.report.ship;
    if found.verdict != COMPLETE {
        let effects: Value = serde_json::from_str(&found.effects).unwrap_or_default();
        let trials: Value = serde_json::from_str(&found.trials).unwrap_or_default();
        let about = json!({ "diagnosis": found.id, "verdict": found.verdict, "effects": effects,
            "report": found.report_id, "diagnosed": found.version_id, "trials": trials });
        webhooks::notify(store, tx, webhooks::DIAGNOSIS_FAILED, ship, about).await?;
    }
    match diagnosis.drift {
        Some(ratio) => webhooks::notify_drift(store, tx, ratio, ship).await,
        None => Ok(()),
    }
}
