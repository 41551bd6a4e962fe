//! The transaction that ends a refinement: its version, the aliases that move to it, its report,
//! and its job.

use crate::aliases::AliasMove;
use crate::error::Result;
use crate::job::{Job, NewJob};
use crate::jobs;
use crate::objects::ObjectStorage;
use crate::reports::{self, NewReport, ReportHead};
use crate::store::Store;
use crate::version::{NewVersion, VersionHead};
use crate::versions;
use crate::work;

/// Result of a refinement, or of the training of a learned correction, to be stored.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NewRefinement {
    /// The version.
    pub version: NewVersion,
    /// The aliases that move to it.
    pub moves: Vec<AliasMove>,
    /// The report on it; its `version_id` is filled in.
    pub report: Option<NewReport>,
    /// The subsequent job, if there is one.
    pub next: Option<NewJob>,
}

/// Rows of a refinement as they were stored, from which the result of its job is written.
#[derive(Debug, Clone, Copy)]
pub struct RefinementRows<'a> {
    /// The version, with its number.
    pub version: &'a VersionHead,
    /// The report on it.
    pub report: Option<&'a ReportHead>,
    /// The subsequent job.
    pub next: Option<&'a Job>,
}

/// A refinement as it was stored.
#[derive(Debug, Clone, PartialEq)]
pub struct CommittedRefinement {
    /// The version, with its number.
    pub version: VersionHead,
    /// The report on it.
    pub report: Option<ReportHead>,
    /// The completed job.
    pub job: Job,
}

impl Store {
    /// Stores the result of a refinement and completes its job, all or nothing: a worker that has
    /// lost the job to another one (its `fence` is older) changes nothing. `result` writes the
    /// job's result, JSON, from the stored rows. The weights of a learned correction must be in
    /// `objects`; if they are no longer there, because [`Store::remove_unreferred`] has removed
    /// them meanwhile, nothing is stored.
    pub async fn commit_refinement<F>(
        &self,
        objects: Option<&ObjectStorage>,
        (job, fence): (&str, i64),
        refinement: &NewRefinement,
        result: F,
    ) -> Result<CommittedRefinement>
    where
        F: FnOnce(&RefinementRows<'_>) -> String,
    {
        let mut tx = self.begin().await?;
        let version =
            versions::insert_version(self, &mut tx, &refinement.version, &refinement.moves).await?;
        // Checked after the row of the version is written: from then on the removal of unreferenced
        // objects waits for this transaction, or has already removed them.
        if let Some(objects) = objects {
            objects.check_present(refinement.version.weights.iter().cloned()).await?;
        }
        let report = match refinement.report.clone() {
            Some(report) => {
                let report = NewReport { version_id: Some(version.id.clone()), ..report };
                Some(reports::insert_report(self, &mut tx, &report).await?)
            }
            None => None,
        };
        let next = match &refinement.next {
            Some(next) => Some(jobs::insert_job(self, &mut tx, next).await?),
            None => None,
        };
        let kept =
            RefinementRows { version: &version, report: report.as_ref(), next: next.as_ref() };
        let result = result(&kept);
        let job = work::complete_job(&mut tx, job, fence, &result, self.now_us()).await?;
        tx.commit().await?;
        Ok(CommittedRefinement { version, report, job })
    }
}
