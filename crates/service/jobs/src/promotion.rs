//! Comparison of a new version with the champion: it becomes the candidate only if its error on the
//! same held-out trials is smaller. A worse version is kept, but no alias points to it.

use std::sync::Arc;

use sistership_identification::refine::{
    Refinement, RefinementExtent, RefinementSettings, RefinementSpec, ReplayedTrials,
    SourceEnvelopes, TermFamily, evaluate_candidates,
};
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Law, Model, Vessel};
use sistership_simulation::Ship;
use sistership_simulation::error::{SquaredError, standard_deviations, standardised_mse};
use sistership_simulation::recorded::{ReplaySettings, replay_trial};

use crate::aliases::{CHAMPION, find_alias};
use crate::archive::{Archive, version_document};
use crate::derive::RefinementRun;
use crate::error::DeriveError;
use crate::version::VersionDocument;

/// Prior strength that leaves the coefficients of a source unchanged.
const FIXED_STRENGTH: f64 = 1e9;

/// Comparison of a new version with the champion, by the standardised squared error.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct ChampionComparison {
    /// Error of the new version on held-out manoeuvres.
    pub error: f64,
    /// Error of the champion; `None` if its simulation stops early.
    pub champion: Option<f64>,
    /// Number of the trials on which the champion was fitted, where it has an advantage.
    pub seen_by_champion: usize,
    /// Number of fitted trials.
    pub trials: usize,
}

impl ChampionComparison {
    /// Returns true if the new version is no candidate: it is worse and the champion had no
    /// advantage.
    pub fn is_worse(&self) -> bool {
        self.seen_by_champion == 0 && self.champion.is_some_and(|champion| self.error >= champion)
    }

    /// Describes the comparison in one sentence.
    pub fn describe(&self) -> String {
        let Self { error, champion, seen_by_champion, trials } = self;
        let champion = match champion {
            Some(champion) => format!("that of the champion {champion:.4}"),
            None => "the champion does not complete them".to_owned(),
        };
        let seen = match seen_by_champion {
            0 => String::new(),
            seen => format!("; the champion was fitted on {seen} of these {trials} trials"),
        };
        format!("error on held-out manoeuvres {error:.4}, {champion}{seen}")
    }
}

/// Compares the version of a refinement with the ship's champion; `None` without a champion.
/// `hashes` are those of its trials' samples, in their order.
///
/// # Errors
/// Returns an error if the champion cannot be read.
pub async fn compare_with_champion(
    archive: &Archive,
    ship: &str,
    refined: Arc<RefinementRun>,
    hashes: Vec<String>,
) -> Result<Option<ChampionComparison>, DeriveError> {
    let Some(alias) = find_alias(&archive.store, ship, CHAMPION).await? else { return Ok(None) };
    let version = archive.store.versions().get(ship, alias.version_number).await?;
    let mut champion = version_document(&version)?;
    archive.attach_weights(&mut champion.model).await?;
    let law = archive.law_by_hash(&champion.model.law, champion.recipe.law_sha256()).await?;
    let compare = move || {
        let ingredients = &refined.ingredients;
        // Trials are compared by the hash of their samples, because names may repeat.
        let trials: Vec<(&Trial, &str)> =
            ingredients.trials.iter().zip(hashes.iter().map(String::as_str)).collect();
        compare_errors(&ComparisonInputs {
            champion: &champion,
            law: &law,
            target: &ingredients.target,
            trials: &trials,
            refinement: &refined.refinement,
        })
    };
    Ok(tokio::task::spawn_blocking(compare).await?)
}

/// Inputs of the comparison.
#[derive(Debug, Clone, Copy)]
struct ComparisonInputs<'a> {
    /// Document of the champion.
    champion: &'a VersionDocument,
    /// Its law.
    law: &'a Law,
    /// The ship.
    target: &'a Vessel,
    /// Every trial of the new version, with the hash of its samples.
    trials: &'a [(&'a Trial, &'a str)],
    /// The new version's refinement.
    refinement: &'a Refinement,
}

/// Compares the errors; `None` if the new version has none, or if the champion cannot be simulated
/// on these trials.
fn compare_errors(contest: &ComparisonInputs<'_>) -> Option<ChampionComparison> {
    let refinement = contest.refinement;
    // The held-out error of the chosen step, which the champion's error is comparable with.
    let error = refinement.options.iter().find(|option| option.chosen)?.error?;
    let fitted: Vec<&(&Trial, &str)> = contest
        .trials
        .iter()
        .filter(|(trial, _)| !refinement.settings.held_out.contains(&trial.name))
        .collect();
    let known = contest.champion.recipe.trials();
    let is_known = |sha256: &str| known.iter().any(|trial| trial.sha256 == sha256);
    Some(ChampionComparison {
        error,
        champion: champion_error(contest)?,
        seen_by_champion: fitted.iter().filter(|(_, sha256)| is_known(sha256)).count(),
        trials: fitted.len(),
    })
}

/// Returns the error of the unchanged champion; the outer `None` if it cannot be simulated on these
/// trials, the inner one if its simulation stops early.
fn champion_error(contest: &ComparisonInputs<'_>) -> Option<Option<f64>> {
    if contest.champion.model.branch.is_some() {
        return corrected_error(contest);
    }
    let trials: Vec<&Trial> = contest.trials.iter().map(|(trial, _)| *trial).collect();
    let ComparisonInputs { champion, law, target, refinement, .. } = *contest;
    // The same cross-validation as for the new version, with a prior so strong that nothing is
    // fitted.
    let settings = RefinementSettings {
        held_out: refinement.settings.held_out.clone(),
        restart_s: refinement.settings.restart_s,
        method: refinement.settings.method,
        strengths: vec![FIXED_STRENGTH],
        families: vec![TermFamily::Own],
        ..RefinementSettings::default()
    };
    let source: &Model = &champion.model;
    let source_law = None;
    let request = RefinementSpec {
        target,
        source,
        source_law,
        law,
        trials: &trials,
        population: &[],
        settings: &settings,
    };
    let weighed = evaluate_candidates(
        (&request, &SourceEnvelopes::default()),
        RefinementExtent::Source,
        &|_, _| true,
    )
    .ok()?;
    Some(weighed.first()?.error)
}

/// Returns the error of a champion with a learned correction, from its own simulations with the
/// scales of the refinement: the transfer to another ship would remove the correction.
fn corrected_error(contest: &ComparisonInputs<'_>) -> Option<Option<f64>> {
    let settings = &contest.refinement.settings;
    let trials = contest.trials.iter().map(|(trial, _)| *trial);
    let fitted: Vec<&Trial> =
        trials.filter(|trial| !settings.held_out.contains(&trial.name)).collect();
    let model = &contest.champion.model;
    let mut ship = Ship::new(model, contest.law).ok()?;
    let speeds = fitted.iter().flat_map(|trial| trial.channel(Channel::U).unwrap_or_default());
    // The physical range must contain the fastest fitted trial, as in the refinement.
    ship.set_envelope_speed(speeds.fold(0.0_f64, |fastest, speed| fastest.max(speed.abs())));
    let replayed =
        ReplayedTrials::new(contest.law, Some(ship.lpp_m()), &fitted, settings.smoothing_s);
    let steps = ReplaySettings {
        restart_s: settings.restart_s,
        step_s: replayed.step_s,
        ..ReplaySettings::default()
    };
    let mut total = SquaredError::default();
    for trial in &replayed.trials {
        let run = replay_trial(&ship, trial, &steps).ok()?;
        if run.stopped.is_some() {
            return Some(None);
        }
        total.add(&SquaredError::from_trial(trial, &run));
    }
    Some(Some(standardised_mse(&total, &standard_deviations(&fitted))))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn comparison(
        error: f64,
        champion: Option<f64>,
        seen_by_champion: usize,
    ) -> ChampionComparison {
        ChampionComparison { error, champion, seen_by_champion, trials: 4 }
    }

    #[test]
    fn a_worse_version_is_no_candidate_unless_the_champion_knew_the_trials() {
        assert!(comparison(0.2, Some(0.1), 0).is_worse());
        assert!(!comparison(0.1, Some(0.2), 0).is_worse());
        assert!(!comparison(0.2, None, 0).is_worse());
        let favoured = comparison(0.2, Some(0.1), 3);
        assert!(
            !favoured.is_worse() && favoured.describe().contains("fitted on 3 of these 4 trials")
        );
    }
}
