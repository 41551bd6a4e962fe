//! Comparison of versions on trials of an archive.

use std::sync::Arc;

use sistership_model::version::RecipeTrial;
use sistership_model::{Law, Model, Trial};

use super::compare::{Comparison, ComparisonError, compare};
use super::comparison_model::ComparisonModel;
use crate::memory::trial_bytes;

/// Inputs of a comparison.
#[derive(Debug, Default)]
pub struct ComparisonInputs {
    /// Models with their laws, by the names in the request; weights of learned corrections are
    /// attached.
    pub versions: Vec<(String, Model, Arc<Law>)>,
    /// Trials.
    pub trials: Vec<sistership_store::Trial>,
}

impl ComparisonInputs {
    /// Names and hashes of the samples that the comparison reads.
    pub fn recipe_trials(&self) -> Vec<RecipeTrial> {
        let of = |trial: &sistership_store::Trial| RecipeTrial {
            name: trial.name.clone(),
            sha256: trial.object_key.clone(),
        };
        self.trials.iter().map(of).collect()
    }
}

/// Memory that a comparison needs, bytes: the samples, and as much for each simulation of them.
pub fn memory_demand(asked: &ComparisonInputs) -> u64 {
    let samples: u64 = asked.trials.iter().map(|trial| trial_bytes(trial.sample_rows)).sum();
    samples * (1 + asked.versions.len() as u64)
}

/// Compares versions; `samples` are those of the trials, in the same order.
///
/// # Errors
/// Returns an error that names the version that cannot be compared, and the reason.
pub fn compare_stored(
    asked: &ComparisonInputs,
    samples: &[Trial],
) -> Result<Comparison, ComparisonError> {
    let versions = asked.versions.iter();
    let versions: Vec<ComparisonModel<'_>> =
        versions.map(|(name, model, law)| ComparisonModel { name, model, law }).collect();
    // Ids, not names: two ships may have trials with the same name.
    let ids = asked.trials.iter().map(|trial| trial.id.as_str());
    compare(&versions, &ids.zip(samples).collect::<Vec<_>>())
}
