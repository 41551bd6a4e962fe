//! Versions and trials of an archive side by side.

use std::sync::Arc;

use sistership_model::version::RecipeTrial;
use sistership_model::{Law, Model, Trial};

use super::compared::Compared;
use super::side_by_side::{Comparison, ComparisonError, compare};
use crate::memory::trial_bytes;

/// What is to be compared.
#[derive(Debug, Default)]
pub struct Asked {
    /// Models of versions, with the weights of learned corrections, by the names under which they
    /// were asked for, with their laws.
    pub versions: Vec<(String, Model, Arc<Law>)>,
    /// Trials.
    pub trials: Vec<sistership_store::Trial>,
}

impl Asked {
    /// The samples that a comparison reads.
    pub fn samples(&self) -> Vec<RecipeTrial> {
        let of = |trial: &sistership_store::Trial| RecipeTrial {
            name: trial.name.clone(),
            sha256: trial.object_key.clone(),
        };
        self.trials.iter().map(of).collect()
    }
}

/// Bytes that a comparison takes: the samples, and as much for each simulation of them.
pub fn demand(asked: &Asked) -> u64 {
    let samples: u64 = asked.trials.iter().map(|trial| trial_bytes(trial.sample_rows)).sum();
    samples * (1 + asked.versions.len() as u64)
}

/// Compares them; `samples` are those of [`Asked::samples`].
///
/// # Errors
/// Says which version cannot be compared, and why.
pub fn compared(asked: &Asked, samples: &[Trial]) -> Result<Comparison, ComparisonError> {
    let versions = asked.versions.iter();
    let versions: Vec<Compared<'_>> =
        versions.map(|(name, model, law)| Compared { name, model, law }).collect();
    let ids = asked.trials.iter().map(|trial| trial.id.as_str());
    compare(&versions, &ids.zip(samples).collect::<Vec<_>>())
}
