//! A chunk of a bulk refinement: the statistics of its ships are gathered, the ships are refined on
//! all cores, and the versions are kept together with the end of the job.

use rayon::prelude::*;
use serde_json::json;
use sistership_jobs::fleet::{
    BulkChunk, BulkMember, BulkOrder, LoadedOrder, load_member, member_outcome, refine_or_explain,
};
use sistership_jobs::inputs::DerivationInputs;
use sistership_store::{Job, NewOutcome, StoreError};

use super::outcome::{Result, permanent_failure};
use super::progress::{JobProgress, report_progress};
use crate::app::App;

/// Runs the job of one chunk.
pub(super) async fn run_chunk(app: &App, job: &Job, progress: JobProgress) -> Result<()> {
    let chunk: BulkChunk = serde_json::from_str(&job.request).map_err(permanent_failure)?;
    let bulk = app.store().bulks().get(&chunk.bulk).await?;
    let order: BulkOrder = serde_json::from_str(&bulk.request).map_err(permanent_failure)?;
    let loaded =
        std::sync::Arc::new(LoadedOrder::load(&DerivationInputs::new(app.archive()), order).await?);
    // The comparison with the champion holds for the versions that were read: if others have come
    // in between, all of it is repeated.
    for _ in 0..super::TRIES {
        let members = gather_members(app, &loaded, &chunk, &progress).await?;
        report_progress(&progress, 0.5, "refining")?;
        let work = std::sync::Arc::clone(&loaded);
        let done = app
            .run_blocking(move || {
                // Ships are independent: one is refined on each core.
                members
                    .into_par_iter()
                    .map(|member| refine_or_explain(&work, member))
                    .collect::<Vec<_>>()
            })
            .await?;
        report_progress(&progress, 0.9, "storing the versions")?;
        let outcomes = done
            .into_iter()
            .map(|(member, outcome)| member_outcome(&loaded, &bulk.id, member, outcome));
        let outcomes: Vec<NewOutcome> = outcomes.collect::<std::result::Result<_, _>>()?;
        let result = json!({ "bulk_refinement": bulk.id, "ships": outcomes.len() }).to_string();
        match app
            .store()
            .bulks()
            .commit_chunk(&bulk.id, (&job.id, job.fence), &outcomes, &result)
            .await
        {
            // Another version of one of the ships has come in between.
            Err(StoreError::PreconditionFailed { .. }) => {}
            other => return Ok(other.map(drop)?),
        }
    }
    Err(permanent_failure(
        "other versions of the ships were stored at the same time; retry the job",
    ))
}

async fn gather_members(
    app: &App,
    loaded: &LoadedOrder,
    chunk: &BulkChunk,
    progress: &JobProgress,
) -> Result<Vec<BulkMember>> {
    let mut members = Vec::with_capacity(chunk.ships.len());
    for (index, ship) in chunk.ships.iter().enumerate() {
        report_progress(
            progress,
            0.5 * index as f64 / chunk.ships.len() as f64,
            &format!("statistics of {ship}"),
        )?;
        members.push(load_member(app.archive(), loaded, ship).await?);
    }
    Ok(members)
}
