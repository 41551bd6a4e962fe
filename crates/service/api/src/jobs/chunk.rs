//! A chunk of a bulk refinement: the statistics of its ships are gathered, the ships are refined on
//! all cores, and the versions are kept together with the end of the job.

use rayon::prelude::*;
use serde_json::json;
use sistership_jobs::fleet::{Chunk, Loaded, Member, Order, kept, member, refine};
use sistership_jobs::inputs::Inputs;
use sistership_store::{Job, NewOutcome, StoreError};

use super::outcome::{Result, failed};
use super::progress::{Progress, tell};
use crate::app::App;

/// Runs the job of one chunk.
pub(super) async fn run(app: &App, job: &Job, progress: Progress) -> Result<()> {
    let chunk: Chunk = serde_json::from_str(&job.request).map_err(failed)?;
    let bulk = app.store().bulks().get(&chunk.bulk).await?;
    let order: Order = serde_json::from_str(&bulk.request).map_err(failed)?;
    let loaded = std::sync::Arc::new(Loaded::of(&Inputs::new(app.archive()), order).await?);
    // The comparison with the champion holds for the versions that were read: if others have come
    // in between, all of it is repeated.
    for _ in 0..super::TRIES {
        let members = members(app, &loaded, &chunk, &progress).await?;
        tell(&progress, 0.5, "refining")?;
        let work = std::sync::Arc::clone(&loaded);
        let done = app
            .compute(move || {
                // Ships are independent: one is refined on each core.
                members.into_par_iter().map(|member| refine(&work, member)).collect::<Vec<_>>()
            })
            .await?;
        tell(&progress, 0.9, "keeping the versions")?;
        let outcomes =
            done.into_iter().map(|(member, outcome)| kept(&loaded, &bulk.id, member, outcome));
        let outcomes: Vec<NewOutcome> = outcomes.collect::<std::result::Result<_, _>>()?;
        let result = json!({ "bulk_refinement": bulk.id, "ships": outcomes.len() }).to_string();
        match app.store().bulks().commit(&bulk.id, (&job.id, job.fence), &outcomes, &result).await {
            // Another version of one of the ships has come in between.
            Err(StoreError::PreconditionFailed { .. }) => {}
            other => return Ok(other.map(drop)?),
        }
    }
    Err(failed("other versions of the ships kept coming in between; retry the job"))
}

async fn members(
    app: &App,
    loaded: &Loaded,
    chunk: &Chunk,
    progress: &Progress,
) -> Result<Vec<Member>> {
    let mut members = Vec::with_capacity(chunk.ships.len());
    for (index, ship) in chunk.ships.iter().enumerate() {
        tell(
            progress,
            0.5 * index as f64 / chunk.ships.len() as f64,
            &format!("statistics of {ship}"),
        )?;
        members.push(member(app.archive(), loaded, ship).await?);
    }
    Ok(members)
}
