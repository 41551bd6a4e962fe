//! Statistics of trials: as they are kept, or made of the samples and kept from then on.

use sistership_fleet::statistics::{Frame, TrialStatistics};
use sistership_model::version::RecipeTrial;
use sistership_trials::samples::from_parquet;

use crate::archive::Archive;
use crate::derive::DeriveError;

/// The statistics of trials in a frame, in their order.
pub(crate) async fn statistics_of(
    archive: &Archive,
    frame: &Frame,
    trials: &[RecipeTrial],
) -> Result<Vec<TrialStatistics>, DeriveError> {
    let (mut all, mut fresh) = (Vec::with_capacity(trials.len()), Vec::new());
    for trial in trials {
        let key = frame.key(&trial.sha256);
        all.push(match archive.store.statistics().get(&key).await? {
            Some(document) => read(&document)?,
            None => {
                let made = make(archive, frame, trial).await?;
                fresh.push((key, serde_json::to_string(&made)?));
                made
            }
        });
    }
    if !fresh.is_empty() {
        archive.store.statistics().put(&fresh).await?;
    }
    Ok(all)
}

fn read(document: &str) -> Result<TrialStatistics, DeriveError> {
    let statistics: TrialStatistics = serde_json::from_str(document)?;
    statistics.check()?;
    Ok(statistics)
}

/// Of a trial's samples, away from the threads that serve.
pub(crate) async fn make(archive: &Archive, frame: &Frame, trial: &RecipeTrial) -> Result<TrialStatistics, DeriveError> {
    let (samples, frame) = (archive.objects.get(&trial.sha256).await?, frame.clone());
    let work = move || Ok(TrialStatistics::of(&frame, &from_parquet(samples)?)?);
    tokio::task::spawn_blocking(work).await?
}
