//! Ends of a job that does not succeed.

use sistership_identification::refine::RefineError;
use sistership_store::StoreError;

use crate::problem::Problem;
use sistership_jobs::derive::DeriveError;

/// End of a job that does not succeed.
#[derive(Debug)]
pub(super) enum JobError {
    /// The job was asked to stop.
    Stopped,
    /// The job cannot be done; another attempt would fail likewise.
    Failed(String),
    /// The database or the object store failed; a later attempt may succeed.
    Store(StoreError),
}

/// Result of a step of a job.
pub(super) type Result<T> = std::result::Result<T, JobError>;

pub(super) fn permanent_failure(reason: impl std::fmt::Display) -> JobError {
    JobError::Failed(reason.to_string())
}

impl From<StoreError> for JobError {
    fn from(error: StoreError) -> Self {
        match error {
            // Lack of space is temporary, whatever kind of error carries it; so is an object store
            // that does not answer.
            passing if passing.is_out_of_space() || passing.is_transient() => Self::Store(passing),
            StoreError::NotFound { .. } | StoreError::Invalid { .. } | StoreError::Objects(_) => {
                permanent_failure(error)
            }
            other => Self::Store(other),
        }
    }
}

impl From<DeriveError> for JobError {
    fn from(error: DeriveError) -> Self {
        match error {
            DeriveError::Store(error) => error.into(),
            DeriveError::Refine(RefineError::Cancelled) => Self::Stopped,
            other => permanent_failure(other),
        }
    }
}

impl From<Problem> for JobError {
    fn from(problem: Problem) -> Self {
        match problem.status {
            507 => Self::Store(StoreError::out_of_space()),
            // The database or the object store did not answer a step of the job.
            503 => Self::Store(StoreError::unanswered()),
            _ => permanent_failure(problem.detail),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::time::Duration;

    use sistership_store::ObjectsError;

    use super::*;

    #[tokio::test]
    async fn a_job_is_tried_again_if_the_object_store_does_not_answer() {
        let late = tokio::time::timeout(Duration::ZERO, std::future::pending::<()>()).await;
        let late = StoreError::from(ObjectsError::from(late.unwrap_err()));
        assert!(matches!(JobError::from(DeriveError::Store(late)), JobError::Store(_)));
        let problem = Problem::from(StoreError::unanswered());
        assert!(matches!(JobError::from(problem), JobError::Store(_)));
        let damaged = ObjectsError::Damaged { key: "a".into(), actual: "b".into() };
        assert!(matches!(JobError::from(StoreError::from(damaged)), JobError::Failed(_)));
    }
}
