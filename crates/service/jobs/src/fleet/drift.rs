//! Drift: the unexplained force of a ship's champion on each of its trials, in the order of upload.

use std::collections::BTreeMap;

use serde::Serialize;
use sistership_fleet::statistics::{RegressionFrame, TrialStatistics};
use sistership_model::coefficient::Axis;
use sistership_model::version::RecipeTrial;
use sistership_store::{StoreError, Trial};
use utoipa::ToSchema;

use super::stored_statistics::trial_statistics;
use crate::aliases::CHAMPION;
use crate::archive::{Archive, version_document};
use crate::error::DeriveError;
use crate::ship_trials::{all_trials, newest_trials};
use crate::version::VersionDocument;

/// Unexplained force of a champion on its ship's trials over time.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct Drift {
    /// The ship.
    pub ship: String,
    /// The number of its champion.
    pub version: i64,
    /// Unexplained force on new trials divided by that on the trials that the champion was fitted
    /// on, by axis: 1 if it is as good as on those. Empty if there are none of either.
    pub ratio: BTreeMap<String, f64>,
    /// The largest of these ratios.
    pub worst: Option<f64>,
    /// Every trial, oldest first.
    pub trials: Vec<TrialResidual>,
    /// Reason if no drift can be computed.
    pub reason: Option<String>,
}

/// Unexplained force of a champion on a trial.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct TrialResidual {
    /// The trial's id.
    pub trial: String,
    /// Its name for people.
    pub name: String,
    /// Time of its upload, microseconds since 1970.
    pub at_us: i64,
    /// True if the champion was fitted on it.
    pub fitted: bool,
    /// Root mean square of the unexplained force divided by that of the force itself, by axis.
    pub residual: BTreeMap<String, f64>,
}

impl Drift {
    /// Computes the drift of a ship's present champion; `None` if it has none.
    ///
    /// # Errors
    /// Returns an error if the store does not answer, or if a document is damaged.
    pub async fn for_champion(archive: &Archive, ship: &str) -> Result<Option<Self>, DeriveError> {
        let store = &archive.store;
        let number = match store.aliases().get(ship, CHAMPION).await {
            Ok(alias) => alias.version_number,
            Err(StoreError::NotFound { .. }) => return Ok(None),
            Err(error) => return Err(error.into()),
        };
        let mut version = version_document(&store.versions().get(ship, number).await?)?;
        // The correction is part of the champion, so it counts in its residual.
        archive.attach_weights(&mut version.model).await?;
        let law = archive.law_by_hash(&version.model.law, version.recipe.law_sha256()).await?;
        let mut drift = Self {
            ship: ship.to_owned(),
            version: number,
            ratio: BTreeMap::new(),
            worst: None,
            trials: Vec::new(),
            reason: None,
        };
        let frame =
            match RegressionFrame::new(&version.model, &law, version.recipe.law_sha256(), None) {
                Ok(frame) => frame,
                Err(error) => return Ok(Some(Self { reason: Some(error.to_string()), ..drift })),
            };
        // All trials: the ratio needs those that were fitted as well.
        let trials = all_trials(store, ship).await?;
        drift.trials = trial_residuals(archive, &frame, &version, trials).await?;
        drift.compute_ratios();
        Ok(Some(drift))
    }

    fn compute_ratios(&mut self) {
        for axis in Axis::ALL.map(|axis| axis.to_string()) {
            // Ratio of root mean squares over the trials: sqrt(mean(r_new^2) / mean(r_fitted^2)).
            let mean_square = |fitted: bool| {
                let of = |trial: &TrialResidual| {
                    (trial.fitted == fitted)
                        .then(|| trial.residual.get(&axis).map(|r| r * r))
                        .flatten()
                };
                let all: Vec<f64> = self.trials.iter().filter_map(of).collect();
                (!all.is_empty()).then(|| all.iter().sum::<f64>() / all.len() as f64)
            };
            if let (Some(new), Some(old)) =
                (mean_square(false), mean_square(true).filter(|old| *old > 0.0))
            {
                self.ratio.insert(axis, (new / old).sqrt());
            }
        }
        self.worst = self.ratio.values().copied().reduce(f64::max);
    }
}

/// Returns the unexplained force of a version on the newest trials of its ship, at most `count`,
/// oldest first: for each trial the largest over the axes. Empty if its law gives no such residual.
///
/// # Errors
/// Returns an error if the store does not answer, or if samples are missing.
pub async fn residuals_of_newest(
    archive: &Archive,
    version: &VersionDocument,
    count: usize,
) -> Result<Vec<f64>, DeriveError> {
    let law_sha256 = version.recipe.law_sha256();
    let law = archive.law_by_hash(&version.model.law, law_sha256).await?;
    let Ok(frame) = RegressionFrame::new(&version.model, &law, law_sha256, None) else {
        return Ok(Vec::new());
    };
    let newest = newest_trials(&archive.store, &version.ship, count, |_| true).await?;
    let left = trial_residuals(archive, &frame, version, newest).await?;
    Ok(left.iter().map(TrialResidual::largest_residual).collect())
}

impl TrialResidual {
    /// Returns the largest residual over the axes.
    pub fn largest_residual(&self) -> f64 {
        self.residual.values().copied().fold(0.0, f64::max)
    }
}

/// Computes the residual of a version on trials; a trial that lacks a channel is skipped.
async fn trial_residuals(
    archive: &Archive,
    frame: &RegressionFrame,
    version: &VersionDocument,
    trials: Vec<Trial>,
) -> Result<Vec<TrialResidual>, DeriveError> {
    let coefficients = version.model.coefficients.iter();
    let coefficients =
        coefficients.map(|(name, quantity)| (name.clone(), quantity.value)).collect();
    let mut all = Vec::with_capacity(trials.len());
    for trial in trials {
        let named = RecipeTrial { name: trial.name.clone(), sha256: trial.sha256.clone() };
        let residual = match trial_statistics(archive, frame, &[named]).await {
            Ok(statistics) => relative_residual(&statistics[0], &coefficients)?,
            // The trial cannot be evaluated, for example because a channel is missing.
            Err(DeriveError::Refine(_)) => continue,
            Err(error) => return Err(error),
        };
        let fitted = version.recipe.trials().iter().any(|known| known.sha256 == trial.sha256);
        all.push(TrialResidual {
            trial: trial.id,
            name: trial.name,
            at_us: trial.created_us,
            fitted,
            residual,
        });
    }
    Ok(all)
}

fn relative_residual(
    statistics: &TrialStatistics,
    coefficients: &BTreeMap<String, f64>,
) -> Result<BTreeMap<String, f64>, DeriveError> {
    let left = statistics.axis_residuals(coefficients)?;
    let share = |left: &sistership_fleet::statistics::AxisResidual| {
        (left.target > 0.0).then(|| (left.axis.to_string(), (left.residual / left.target).sqrt()))
    };
    Ok(left.iter().filter_map(share).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn new_trials_are_measured_by_the_fitted_ones() {
        let trial = |fitted: bool, n: f64| TrialResidual {
            trial: String::new(),
            name: String::new(),
            at_us: 0,
            fitted,
            residual: BTreeMap::from([("N".to_owned(), n)]),
        };
        let mut drift = Drift {
            ship: "kcs".into(),
            version: 1,
            ratio: BTreeMap::new(),
            worst: None,
            trials: vec![trial(true, 0.1), trial(true, 0.1), trial(false, 0.3)],
            reason: None,
        };
        drift.compute_ratios();
        assert!(drift.worst.is_some_and(|worst| (worst - 3.0).abs() < 1e-12), "{drift:?}");
        drift.trials.retain(|trial| trial.fitted);
        (drift.ratio, drift.worst) = (BTreeMap::new(), None);
        drift.compute_ratios();
        assert_eq!(drift.worst, None, "nothing is new");
    }
}
