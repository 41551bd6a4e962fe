//! Status of a bulk refinement.

use std::collections::BTreeMap;

use serde::Serialize;
use sistership_store::{FamilyRefinement, JobState, Store, StoreError};
use utoipa::ToSchema;

/// Status of a bulk refinement.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
#[schema(as = BulkStanding)]
pub struct BulkProgress {
    /// `queued`, `running`, `succeeded`, `failed` (in part: retry) or `cancelled`.
    pub state: &'static str,
    /// Number of its ships.
    pub ships: i64,
    /// Number of ships that are done.
    pub done: i64,
    /// Share that is done, 0 to 1.
    pub progress: f64,
    /// Number of ships by outcome: `champion`, `candidate`, `unchanged`, `refused`.
    pub outcomes: BTreeMap<String, i64>,
    /// Number of jobs by state.
    pub chunks: BTreeMap<&'static str, i64>,
    /// Mean rate so far, ships per second.
    pub ships_per_s: Option<f64>,
    /// Time left at that rate, s.
    pub left_s: Option<f64>,
}

impl BulkProgress {
    /// Reads the present status of a bulk refinement.
    ///
    /// # Errors
    /// Returns an error if the database does not answer.
    pub async fn read_current(store: &Store, bulk: &FamilyRefinement) -> Result<Self, StoreError> {
        let (chunks, counts) = (
            store.bulks().count_chunks(&bulk.id).await?,
            store.bulks().count_outcomes(&bulk.id).await?,
        );
        let outcomes: BTreeMap<String, i64> =
            counts.into_iter().map(|count| (count.outcome, count.ships)).collect();
        let done: i64 = outcomes.values().sum();
        let in_state = |state: JobState| chunks.iter().any(|count| count.state == state);
        let begun = chunks.iter().filter_map(|count| count.started_us).min();
        let open = in_state(JobState::Queued) || in_state(JobState::Running);
        let ended =
            if open { None } else { chunks.iter().filter_map(|count| count.finished_us).max() };
        let seconds =
            begun.map(|begun| (ended.unwrap_or_else(|| store.now_us()) - begun) as f64 / 1e6);
        let ships_per_s = seconds
            .filter(|seconds| *seconds > 0.0 && done > 0)
            .map(|seconds| done as f64 / seconds);
        // Chunks differ in state; the most urgent one names the whole: work in progress before
        // failures.
        let state = match () {
            () if in_state(JobState::Running) || (in_state(JobState::Queued) && done > 0) => {
                "running"
            }
            () if in_state(JobState::Queued) => "queued",
            () if in_state(JobState::Failed) => "failed",
            () if in_state(JobState::Cancelled) => "cancelled",
            () => "succeeded",
        };
        Ok(Self {
            state,
            ships: bulk.ships,
            done,
            progress: done as f64 / bulk.ships as f64,
            left_s: ships_per_s.filter(|_| open).map(|pace| (bulk.ships - done) as f64 / pace),
            ships_per_s,
            outcomes,
            chunks: chunks.iter().map(|count| (count.state.as_str(), count.jobs)).collect(),
        })
    }
}
