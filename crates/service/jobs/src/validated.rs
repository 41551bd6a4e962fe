//! A version held against what its ship has sailed, by ITTC 7.5-02-06-03.

use std::collections::BTreeSet;

use sistership_assessment::uncertainty::{Sampling, draws};
pub use sistership_assessment::validation::Validation;
use sistership_assessment::validation::{TrialOfShip, validate};
use sistership_model::version::RecipeTrial;
use sistership_model::{Law, Model, Trial, Vessel};
use sistership_simulation::PlantError;
use sistership_store::{Page, Version};

use crate::archive::{Archive, document, vessel};
use crate::error::DeriveError;
use crate::memory::trial_bytes;

/// Trials that are read at most: enough for repeats of every standard manoeuvre.
const MOST_TRIALS: usize = 48;
/// Models drawn for what the posterior leaves open: a standard deviation of 40 draws is known to
/// 1/sqrt(2 * 39), 11 %.
const DRAWS: usize = 40;

/// What a validation is made of.
#[derive(Debug)]
pub struct ToValidate {
    model: Model,
    law: Law,
    vessel: Vessel,
    trials: Vec<sistership_store::Trial>,
    /// Hashes of the samples that the version, or one that it came of, was fitted on.
    fitted: BTreeSet<String>,
}

impl ToValidate {
    /// Gathers a version, its ship as it is now, and its turning circles and zigzags.
    ///
    /// # Errors
    /// The version, its law or its ship is missing or damaged.
    pub async fn gather(archive: &Archive, version: &Version) -> Result<Self, DeriveError> {
        let ship = &version.head.model;
        let own = document(version)?;
        let mut model = own.model;
        archive.attach(&mut model).await?;
        let law = archive.law(&model.law, own.recipe.law_sha256()).await?;
        let fitted = fitted(archive, version).await?;
        let vessel = vessel(ship, &archive.store.ships().get(ship).await?.document)?;
        Ok(Self { model, law, vessel, trials: manoeuvres(archive, ship).await?, fitted })
    }

    /// The samples that it reads.
    pub fn samples(&self) -> Vec<RecipeTrial> {
        let of = |trial: &sistership_store::Trial| RecipeTrial {
            name: trial.name.clone(),
            sha256: trial.object_key.clone(),
        };
        self.trials.iter().map(of).collect()
    }

    /// Bytes that it takes: the samples, and as much again for their simulations.
    pub fn demand(&self) -> u64 {
        2 * self.trials.iter().map(|trial| trial_bytes(trial.sample_rows)).sum::<u64>()
    }

    /// Validates; `samples` are those of [`ToValidate::samples`].
    ///
    /// # Errors
    /// The model cannot be sailed.
    pub fn validation(&self, samples: &[Trial]) -> Result<Validation, PlantError> {
        let of_ship = self.trials.iter().zip(samples).map(|(row, trial)| TrialOfShip {
            name: &row.name,
            trial,
            fitted: self.fitted.contains(&row.object_key),
        });
        let of_ship: Vec<TrialOfShip<'_>> = of_ship.collect();
        let sampling = Sampling { samples: DRAWS, ..Sampling::default() };
        let drawn = draws(&self.model, sampling).unwrap_or_default();
        validate(&self.vessel, &self.model, &self.law, &drawn, &of_ship)
    }
}

/// The samples that a version and those of its own ship before it were fitted on.
async fn fitted(archive: &Archive, version: &Version) -> Result<BTreeSet<String>, DeriveError> {
    let mut all = BTreeSet::new();
    let mut next = Some(version.clone());
    while let Some(one) = next {
        all.extend(document(&one)?.recipe.trials().iter().map(|trial| trial.sha256.clone()));
        next = match &one.head.parent {
            Some(id) => Some(archive.store.versions().by_id(id).await?),
            None => None,
        };
    }
    Ok(all)
}

/// The turning circles and zigzags of a ship, the newest last.
async fn manoeuvres(
    archive: &Archive,
    ship: &str,
) -> Result<Vec<sistership_store::Trial>, DeriveError> {
    let (mut found, mut page) = (Vec::new(), Page::first(200));
    loop {
        let rows = archive.store.trials().list(ship, &page).await?;
        found.extend(rows.items.into_iter().filter(is_judged));
        match rows.next {
            Some(next) if found.len() < MOST_TRIALS => page = Page::after(next, 200),
            _ => break,
        }
    }
    found.truncate(MOST_TRIALS);
    Ok(found)
}

fn is_judged(trial: &sistership_store::Trial) -> bool {
    let name = trial.manoeuvre.as_deref().unwrap_or_default().to_lowercase();
    name.starts_with("turn") || name.starts_with("zigzag")
}
