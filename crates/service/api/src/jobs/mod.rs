//! Long work: what is asked for, and the workers that do it.

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
    BRANCH, BranchJob, DIAGNOSIS, DiagnosisJob, REFINEMENT, RefinementJob, SourceChoice,
};
pub(crate) use worker::Worker;

/// How often another version of the same ship may come in between while one is kept. Each time
/// another job has come to its end, so that only a fleet of workers on one ship gets anywhere near.
const TRIES: usize = 100;
