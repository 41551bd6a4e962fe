//! Statistics of trials: read from the store, or computed from the samples and then stored.

use bytes::Bytes;
use sistership_fleet::statistics::{RegressionFrame, TrialStatistics};
use sistership_model::version::{RecipeTrial, code_revision, sha256_hex};
use sistership_trials::samples::from_parquet;

use crate::archive::Archive;
use crate::error::DeriveError;

/// Returns the statistics of trials in a frame, in the order of the trials.
pub async fn trial_statistics(
    archive: &Archive,
    frame: &RegressionFrame,
    trials: &[RecipeTrial],
) -> Result<Vec<TrialStatistics>, DeriveError> {
    // New statistics are stored in one statement after the loop.
    let (mut all, mut fresh) = (Vec::with_capacity(trials.len()), Vec::new());
    for trial in trials {
        let key = storage_key(frame, &trial.sha256, code_revision());
        all.push(match archive.store.statistics().get(&key).await? {
            Some(document) => parse_statistics(&document)?,
            None => {
                let made = compute_for_trial(archive, frame, trial).await?;
                fresh.push((key, serde_json::to_string(&made)?));
                made
            }
        });
    }
    if !fresh.is_empty() {
        archive.store.statistics().insert_all(&fresh).await?;
    }
    Ok(all)
}

/// Key of stored statistics. It includes the revision of the program, because versions must be
/// derived again by the release that made them.
fn storage_key(frame: &RegressionFrame, trial_sha256: &str, revision: &str) -> String {
    sha256_hex(format!("{revision}\n{}", frame.statistics_key(trial_sha256)).as_bytes())
}

fn parse_statistics(document: &str) -> Result<TrialStatistics, DeriveError> {
    let statistics: TrialStatistics = serde_json::from_str(document)?;
    statistics.check_consistency()?;
    Ok(statistics)
}

/// Computes the statistics of a stored trial.
async fn compute_for_trial(
    archive: &Archive,
    frame: &RegressionFrame,
    trial: &RecipeTrial,
) -> Result<TrialStatistics, DeriveError> {
    compute_statistics(frame, archive.objects.get(&trial.sha256).await?).await
}

/// Computes statistics from samples, on a blocking thread.
pub(super) async fn compute_statistics(
    frame: &RegressionFrame,
    samples: Bytes,
) -> Result<TrialStatistics, DeriveError> {
    let frame = frame.clone();
    let work = move || Ok(TrialStatistics::from_trial(&frame, &from_parquet(samples)?)?);
    tokio::task::spawn_blocking(work).await?
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sistership_model::Zoo;

    #[test]
    fn statistics_of_another_release_are_not_taken() {
        let zoo = Zoo::load_embedded().unwrap();
        let model = zoo.find_model("sr108").unwrap();
        let frame =
            RegressionFrame::new(&model, zoo.law(&model.law).unwrap(), "law", None).unwrap();
        assert_eq!(storage_key(&frame, "trial", "1"), storage_key(&frame, "trial", "1"));
        assert_ne!(storage_key(&frame, "trial", "1"), storage_key(&frame, "trial", "2"));
    }
}
