//! Validation of a version against its ship's trials, by ITTC 7.5-02-06-03.

use std::collections::BTreeSet;

use sistership_assessment::uncertainty::{Sampling, draw_from_posterior};
pub use sistership_assessment::validation::Validation;
use sistership_assessment::validation::{TrialOfShip, validate};
use sistership_model::version::RecipeTrial;
use sistership_model::{Law, Model, Trial, Vessel};
use sistership_simulation::PlantError;
use sistership_store::Version;

use crate::archive::{Archive, parse_vessel, version_document};
use crate::error::DeriveError;
use crate::memory::trial_bytes;
use crate::ship_trials::newest_trials;

/// Largest number of trials, the newest ones: enough for repeats of every standard manoeuvre.
const MOST_TRIALS: usize = 48;
/// Number of models drawn for the uncertainty of the posterior: the relative standard error of a
/// standard deviation of 40 draws is 1/sqrt(2 * 39), 11 %.
const POSTERIOR_DRAWS: usize = 40;

/// Inputs of a validation.
#[derive(Debug)]
pub struct ValidationInputs {
    model: Model,
    law: Law,
    vessel: Vessel,
    trials: Vec<sistership_store::Trial>,
    /// Hashes of the samples that the version, or one that it comes from, was fitted on.
    fitted: BTreeSet<String>,
}

impl ValidationInputs {
    /// Loads a version, its ship at the present revision, and its newest turning circles and
    /// zigzags.
    ///
    /// # Errors
    /// Returns an error if the version, its law or its ship is missing or damaged.
    pub async fn load(archive: &Archive, version: &Version) -> Result<Self, DeriveError> {
        let ship = &version.head.model;
        let own = version_document(version)?;
        let mut model = own.model;
        archive.attach_weights(&mut model).await?;
        let law = archive.law_by_hash(&model.law, own.recipe.law_sha256()).await?;
        let fitted = fitted_hashes(archive, version).await?;
        let vessel = parse_vessel(ship, &archive.store.ships().get(ship).await?.document)?;
        // Manoeuvres are known by name only, so that all rows of the ship are read.
        let trials = newest_trials(&archive.store, ship, MOST_TRIALS, is_judged).await?;
        Ok(Self { model, law, vessel, trials, fitted })
    }

    /// Names and hashes of the samples that it reads.
    pub fn recipe_trials(&self) -> Vec<RecipeTrial> {
        let of = |trial: &sistership_store::Trial| RecipeTrial {
            name: trial.name.clone(),
            sha256: trial.object_key.clone(),
        };
        self.trials.iter().map(of).collect()
    }

    /// Memory that it needs, bytes: the samples, and as much again for their simulations.
    pub fn memory_demand(&self) -> u64 {
        2 * self.trials.iter().map(|trial| trial_bytes(trial.sample_rows)).sum::<u64>()
    }

    /// Validates the version; `samples` are those of its trials, in the same order.
    ///
    /// # Errors
    /// Returns an error if the model cannot be simulated.
    pub fn run_validation(&self, samples: &[Trial]) -> Result<Validation, PlantError> {
        let of_ship = self.trials.iter().zip(samples).map(|(row, trial)| TrialOfShip {
            name: &row.name,
            trial,
            fitted: self.fitted.contains(&row.object_key),
        });
        let of_ship: Vec<TrialOfShip<'_>> = of_ship.collect();
        let sampling = Sampling { samples: POSTERIOR_DRAWS, ..Sampling::default() };
        // A model without posterior is validated without the uncertainty of its parameters.
        let drawn = draw_from_posterior(&self.model, sampling).unwrap_or_default();
        validate(&self.vessel, &self.model, &self.law, &drawn, &of_ship)
    }
}

/// Returns the hashes of the samples that a version and its ancestors were fitted on.
async fn fitted_hashes(
    archive: &Archive,
    version: &Version,
) -> Result<BTreeSet<String>, DeriveError> {
    let mut all = BTreeSet::new();
    let mut next = Some(version.clone());
    while let Some(one) = next {
        all.extend(
            version_document(&one)?.recipe.trials().iter().map(|trial| trial.sha256.clone()),
        );
        // Parents only: the source of a refinement may be another ship, whose trials are others.
        next = match &one.head.parent {
            Some(id) => Some(archive.store.versions().by_id(id).await?),
            None => None,
        };
    }
    Ok(all)
}

fn is_judged(trial: &sistership_store::Trial) -> bool {
    let name = trial.manoeuvre.as_deref().unwrap_or_default().to_lowercase();
    name.starts_with("turn") || name.starts_with("zigzag")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use sistership_store::NewTrial;
    use sistership_store::testing::TestDatabase;

    use super::*;
    use crate::catalogue::ZooCache;
    use crate::seed;
    use crate::test_rows::new_trial;

    #[tokio::test]
    async fn the_newest_manoeuvres_of_a_long_series_are_validated() {
        let database = TestDatabase::new_sqlite();
        let archive = Archive::open(&database.url, database.folder.path()).await.unwrap();
        seed::seed_zoo(&archive.store, &ZooCache::default()).await.unwrap();
        let series: Vec<NewTrial> = (0..300)
            .map(|number: usize| new_trial("mariner", &number.to_string(), Some("zigzag 20/20")))
            .collect();
        archive.store.trials().insert_all(&series).await.unwrap();
        let version = archive.store.versions().get("mariner", 1).await.unwrap();
        let inputs = ValidationInputs::load(&archive, &version).await.unwrap();
        let names: Vec<String> =
            inputs.recipe_trials().into_iter().map(|trial| trial.name).collect();
        let newest: Vec<String> = (252..300).map(|number| number.to_string()).collect();
        assert_eq!(names, newest);
    }
}
