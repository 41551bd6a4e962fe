//! Statistics of trials: read from the store, or computed from the samples and then stored.

use bytes::Bytes;
use sistership_fleet::statistics::{Frame, TrialStatistics};
use sistership_model::version::{RecipeTrial, code_revision, sha256};
use sistership_trials::samples::from_parquet;

use crate::archive::Archive;
use crate::error::DeriveError;

/// Returns the statistics of trials in a frame, in the order of the trials.
pub async fn statistics_of(
    archive: &Archive,
    frame: &Frame,
    trials: &[RecipeTrial],
) -> Result<Vec<TrialStatistics>, DeriveError> {
    // New statistics are stored in one statement after the loop.
    let (mut all, mut fresh) = (Vec::with_capacity(trials.len()), Vec::new());
    for trial in trials {
        let key = key(frame, &trial.sha256, code_revision());
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

/// Key of stored statistics. It includes the revision of the program, because versions must be
/// derived again by the release that made them.
fn key(frame: &Frame, trial_sha256: &str, revision: &str) -> String {
    sha256(format!("{revision}\n{}", frame.key(trial_sha256)).as_bytes())
}

fn read(document: &str) -> Result<TrialStatistics, DeriveError> {
    let statistics: TrialStatistics = serde_json::from_str(document)?;
    statistics.check()?;
    Ok(statistics)
}

/// Computes the statistics of a stored trial.
async fn make(
    archive: &Archive,
    frame: &Frame,
    trial: &RecipeTrial,
) -> Result<TrialStatistics, DeriveError> {
    made(frame, archive.objects.get(&trial.sha256).await?).await
}

/// Computes statistics from samples, on a blocking thread.
pub(super) async fn made(frame: &Frame, samples: Bytes) -> Result<TrialStatistics, DeriveError> {
    let frame = frame.clone();
    let work = move || Ok(TrialStatistics::of(&frame, &from_parquet(samples)?)?);
    tokio::task::spawn_blocking(work).await?
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::Zoo;

    #[test]
    fn statistics_of_another_release_are_not_taken() {
        let zoo = Zoo::embedded().unwrap();
        let model = zoo.model("sr108").unwrap();
        let frame = Frame::new(&model, zoo.law(&model.law).unwrap(), "law", None).unwrap();
        assert_eq!(key(&frame, "trial", "1"), key(&frame, "trial", "1"));
        assert_ne!(key(&frame, "trial", "1"), key(&frame, "trial", "2"));
    }
}
