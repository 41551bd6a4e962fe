//! The one transaction that ends a refinement: its version, the aliases that move to it, its
//! report, and its job.

use crate::aliases::AliasMove;
use crate::error::Result;
use crate::job::{Job, NewJob};
use crate::jobs;
use crate::objects::Objects;
use crate::reports::{self, NewReport, ReportHead};
use crate::store::Store;
use crate::version::{NewVersion, VersionHead};
use crate::versions;
use crate::work;

/// What a refinement, or the training of a learned branch, brings.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refinement {
    /// The version.
    pub version: NewVersion,
    /// The aliases that move to it.
    pub moves: Vec<AliasMove>,
    /// The report on it; its `version_id` is filled in.
    pub report: Option<NewReport>,
    /// The job that goes on from it, if one does.
    pub next: Option<NewJob>,
}

/// What is kept of a refinement, of which the result of its job is written.
#[derive(Debug, Clone, Copy)]
pub struct Kept<'a> {
    /// The version, now numbered.
    pub version: &'a VersionHead,
    /// The report on it.
    pub report: Option<&'a ReportHead>,
    /// The job that goes on from it.
    pub next: Option<&'a Job>,
}

/// What has become of a refinement.
#[derive(Debug, Clone, PartialEq)]
pub struct Committed {
    /// The version, now numbered.
    pub version: VersionHead,
    /// The report on it.
    pub report: Option<ReportHead>,
    /// The job, done.
    pub job: Job,
}

impl Store {
    /// Keeps what a refinement brings and ends its job, all or nothing: a worker that has lost the
    /// job to another (an older `fence`) leaves nothing behind. `result` writes the job's result,
    /// JSON, from what was kept. Where the version has a learned branch its weights are in
    /// `objects`; where they are no longer there, because [`Store::remove_unreferred`] was faster,
    /// nothing is kept.
    pub async fn commit_refinement<F>(
        &self,
        objects: Option<&Objects>,
        (job, fence): (&str, i64),
        refinement: &Refinement,
        result: F,
    ) -> Result<Committed>
    where
        F: FnOnce(&Kept<'_>) -> String,
    {
        let mut tx = self.begin().await?;
        let version =
            versions::insert(self, &mut tx, &refinement.version, &refinement.moves).await?;
        if let Some(objects) = objects {
            objects.must_have(refinement.version.weights.iter().cloned()).await?;
        }
        let report = match refinement.report.clone() {
            Some(report) => {
                let report = NewReport { version_id: Some(version.id.clone()), ..report };
                Some(reports::insert(self, &mut tx, &report).await?)
            }
            None => None,
        };
        let next = match &refinement.next {
            Some(next) => Some(jobs::insert(self, &mut tx, next).await?),
            None => None,
        };
        let kept = Kept { version: &version, report: report.as_ref(), next: next.as_ref() };
        let result = result(&kept);
        let job = work::complete(&mut tx, job, fence, &result, self.now_us()).await?;
        tx.commit().await?;
        Ok(Committed { version, report, job })
    }
}
