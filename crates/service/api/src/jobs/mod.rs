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
pub(crate) use worker::Worker;

/// Number of attempts to keep a version while other versions of the same ship come in between. Each
/// failure means that another job has ended, so that only a fleet of workers on one ship gets near
/// this limit.
const TRIES: usize = 100;
