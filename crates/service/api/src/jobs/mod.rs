//! Jobs, and the workers that run them.

mod branch;
mod chunk;
mod commit;
mod commit_branch;
mod commit_diagnosis;
mod demand;
mod diagnosis;
mod family_prior;
mod outcome;
mod prepared;
mod progress;
mod refinement;
mod worker;

pub(crate) use sistership_jobs::request::{
    BRANCH_JOB_KIND, BranchJob, DIAGNOSIS_JOB_KIND, DiagnosisJob, REFINEMENT_JOB_KIND,
    RefinementJob, SourceChoice,
};
pub(crate) use worker::{JobClass, Worker};

/// Number of samples up to which a refinement or diagnosis counts as small: a matter of seconds.
const SMALL_SAMPLES: i64 = 20_000;

/// Returns true if a job on these trials is small.
pub(crate) fn is_small<'a>(trials: impl Iterator<Item = &'a sistership_store::Trial>) -> bool {
    trials.map(|trial| trial.sample_rows).sum::<i64>() <= SMALL_SAMPLES
}

/// Number of attempts to keep a version while other versions of the same ship come in between. Each
/// failure means that another job has ended, so that only a fleet of workers on one ship gets near
/// this limit.
const TRIES: usize = 100;
