//! Statistics of trials: as they are kept, or made of the samples and kept from then on.

use bytes::Bytes;
use sistership_fleet::statistics::{Frame, TrialStatistics};
use sistership_model::version::{RecipeTrial, code_revision, sha256};
use sistership_trials::samples::from_parquet;

use crate::archive::Archive;
use crate::error::DeriveError;

/// The statistics of trials in a frame, in their order.
pub async fn statistics_of(
    archive: &Archive,
    frame: &Frame,
    trials: &[RecipeTrial],
) -> Result<Vec<TrialStatistics>, DeriveError> {
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

/// What statistics are kept under: another release makes its own, since versions that it makes are
/// to be derived again by it.
fn key(frame: &Frame, trial_sha256: &str, revision: &str) -> String {
    sha256(format!("{revision}\n{}", frame.key(trial_sha256)).as_bytes())
}

fn read(document: &str) -> Result<TrialStatistics, DeriveError> {
    let statistics: TrialStatistics = serde_json::from_str(document)?;
    statistics.check()?;
    Ok(statistics)
}

/// Of a trial's samples, away from the threads that serve.
async fn make(
    archive: &Archive,
    frame: &Frame,
    trial: &RecipeTrial,
) -> Result<TrialStatistics, DeriveError> {
    made(frame, archive.objects.get(&trial.sha256).await?).await
}

/// Of samples themselves.
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
