//! Long work: what is asked for, and the workers that do it.

mod commit;
mod commit_diagnosis;
mod diagnosis;
mod outcome;
mod progress;
mod refinement;
mod request;
mod worker;

pub(crate) use request::{DIAGNOSIS, DiagnosisJob, REFINEMENT, RefinementJob, SourceChoice};
pub(crate) use worker::Worker;
