//! The one transaction that ends a refinement: its version, the aliases that move to it, its
//! report, and its job.

use crate::aliases::AliasMove;
use crate::error::Result;
use crate::job::Job;
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
    /// JSON, from what was kept.
    pub async fn commit_refinement<F>(
        &self,
        job: &str,
        fence: i64,
        refinement: &Refinement,
        result: F,
    ) -> Result<Committed>
    where
        F: FnOnce(&VersionHead, Option<&ReportHead>) -> String,
    {
        self.commit_refined(None, (job, fence), refinement, result).await
    }

    /// The same where the version has a learned branch, whose weights are in `objects`. Where they
    /// are no longer there, because [`Store::remove_unreferred`] was faster, nothing is kept.
    pub async fn commit_with_weights<F>(
        &self,
        objects: &Objects,
        job: &str,
        fence: i64,
        refinement: &Refinement,
        result: F,
    ) -> Result<Committed>
    where
        F: FnOnce(&VersionHead, Option<&ReportHead>) -> String,
    {
        self.commit_refined(Some(objects), (job, fence), refinement, result).await
    }

    async fn commit_refined<F>(
        &self,
        objects: Option<&Objects>,
        (job, fence): (&str, i64),
        refinement: &Refinement,
        result: F,
    ) -> Result<Committed>
    where
        F: FnOnce(&VersionHead, Option<&ReportHead>) -> String,
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
        let result = result(&version, report.as_ref());
        let job = work::complete(&mut tx, job, fence, &result, self.now_us()).await?;
        tx.commit().await?;
        Ok(Committed { version, report, job })
    }
}
