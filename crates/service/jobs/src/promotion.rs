//! Whether a new version may become the candidate: only where it does better than the champion on
//! the same trials left out. A worse one is kept, as every version is, and replaces nothing.

use std::sync::Arc;

use sistership_identification::refine::{
    Extent, Family, Refinement, ReplayedTrials, Request, Settings, SourceEnvelopes, Thinning, weigh,
};
use sistership_model::trial::{Channel, Trial};
use sistership_model::{Law, Model, Vessel};
use sistership_simulation::Ship;
use sistership_simulation::error::{SquaredError, standard_deviations, standardised_mse};
use sistership_simulation::recorded::{ReplaySettings, replay};

use crate::archive::{Archive, document};
use crate::derive::Refined;
use crate::error::DeriveError;
use crate::line::{CHAMPION, alias};
use crate::version::VersionDocument;

/// Strength of a prior that keeps a source as it is.
const KEPT: f64 = 1e9;

/// How a new version compares with the champion, by the standardised squared error.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Comparison {
    /// The new version's, on manoeuvres left out.
    pub error: f64,
    /// The champion's; none where it does not sail them to their end.
    pub champion: Option<f64>,
    /// How many of the trials the champion was fitted on: there it is favoured.
    pub seen_by_champion: usize,
    /// How many trials were fitted.
    pub trials: usize,
}

impl Comparison {
    /// Whether the new version is no candidate: it is worse where the champion had no advantage.
    pub fn is_worse(&self) -> bool {
        self.seen_by_champion == 0 && self.champion.is_some_and(|champion| self.error >= champion)
    }

    /// The comparison in words.
    pub fn words(&self) -> String {
        let Self { error, champion, seen_by_champion, trials } = self;
        let champion = match champion {
            Some(champion) => format!("the champion's is {champion:.4}"),
            None => "the champion does not sail them to their end".to_owned(),
        };
        let seen = match seen_by_champion {
            0 => String::new(),
            seen => format!("; it was fitted on {seen} of these {trials} trials"),
        };
        format!("error on manoeuvres left out {error:.4}, {champion}{seen}")
    }
}

/// How a version that a refinement gave compares with the ship's champion, where it has one;
/// `hashes` are those of its trials' samples, in their order.
///
/// # Errors
/// The champion does not read.
pub async fn against_champion(
    archive: &Archive,
    ship: &str,
    refined: Arc<Refined>,
    hashes: Vec<String>,
) -> Result<Option<Comparison>, DeriveError> {
    let Some(alias) = alias(&archive.store, ship, CHAMPION).await? else { return Ok(None) };
    let version = archive.store.versions().get(ship, alias.version_number).await?;
    let mut champion = document(&version)?;
    archive.attach(&mut champion.model).await?;
    let law = archive.law(&champion.model.law, champion.recipe.law_sha256()).await?;
    let compare = move || {
        let ingredients = &refined.ingredients;
        let trials: Vec<(&Trial, &str)> =
            ingredients.trials.iter().zip(hashes.iter().map(String::as_str)).collect();
        compared(&Contest {
            champion: &champion,
            law: &law,
            target: &ingredients.target,
            trials: &trials,
            refinement: &refined.refinement,
        })
    };
    Ok(tokio::task::spawn_blocking(compare).await?)
}

/// What is compared.
#[derive(Debug, Clone, Copy)]
struct Contest<'a> {
    /// The champion as it is kept.
    champion: &'a VersionDocument,
    /// Its law.
    law: &'a Law,
    /// The ship.
    target: &'a Vessel,
    /// Every trial of the new version, with the hashes of their samples.
    trials: &'a [(&'a Trial, &'a str)],
    /// The new version's refinement.
    refinement: &'a Refinement,
}

/// Compares; none where the new version has no error, or the champion cannot be simulated there.
fn compared(contest: &Contest<'_>) -> Option<Comparison> {
    let refinement = contest.refinement;
    let error = refinement.options.iter().find(|option| option.chosen)?.error?;
    let fitted: Vec<&(&Trial, &str)> = contest
        .trials
        .iter()
        .filter(|(trial, _)| !refinement.settings.held_out.contains(&trial.name))
        .collect();
    let known = contest.champion.recipe.trials();
    let is_known = |sha256: &str| known.iter().any(|trial| trial.sha256 == sha256);
    Some(Comparison {
        error,
        champion: champion_error(contest)?,
        seen_by_champion: fitted.iter().filter(|(_, sha256)| is_known(sha256)).count(),
        trials: fitted.len(),
    })
}

/// The champion's error as it is; outer none where it cannot be simulated on these trials.
fn champion_error(contest: &Contest<'_>) -> Option<Option<f64>> {
    if contest.champion.model.branch.is_some() {
        return corrected_error(contest);
    }
    let trials: Vec<&Trial> = contest.trials.iter().map(|(trial, _)| *trial).collect();
    let Contest { champion, law, target, refinement, .. } = *contest;
    let settings = Settings {
        held_out: refinement.settings.held_out.clone(),
        restart_s: refinement.settings.restart_s,
        method: refinement.settings.method,
        strengths: vec![KEPT],
        families: vec![Family::Own],
        ..Settings::default()
    };
    let source: &Model = &champion.model;
    let source_law = None;
    let request = Request {
        target,
        source,
        source_law,
        law,
        trials: &trials,
        population: &[],
        settings: &settings,
    };
    let weighed =
        weigh((&request, &SourceEnvelopes::default()), Extent::Source, &|_, _| true).ok()?;
    Some(weighed.first()?.error)
}

/// The error of a champion with a learned correction, which carrying over to another ship would
/// leave out: of its own simulations, by the scales of the refinement.
fn corrected_error(contest: &Contest<'_>) -> Option<Option<f64>> {
    let settings = &contest.refinement.settings;
    let trials = contest.trials.iter().map(|(trial, _)| *trial);
    let fitted: Vec<&Trial> =
        trials.filter(|trial| !settings.held_out.contains(&trial.name)).collect();
    let model = &contest.champion.model;
    let mut ship = Ship::new(model, contest.law).ok()?;
    let speeds = fitted.iter().flat_map(|trial| trial.channel(Channel::U).unwrap_or_default());
    ship.set_envelope_speed(speeds.fold(0.0_f64, |fastest, speed| fastest.max(speed.abs())));
    let replayed =
        ReplayedTrials::new(contest.law, Some(ship.lpp_m()), &fitted, Thinning::from(settings));
    let steps = ReplaySettings {
        restart_s: settings.restart_s,
        step_s: replayed.step_s,
        ..ReplaySettings::default()
    };
    let mut total = SquaredError::default();
    for trial in &replayed.trials {
        let run = replay(&ship, trial, &steps).ok()?;
        if run.stopped.is_some() {
            return Some(None);
        }
        total.add(&SquaredError::of(trial, &run));
    }
    Some(Some(standardised_mse(&total, &standard_deviations(&fitted))))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn comparison(error: f64, champion: Option<f64>, seen_by_champion: usize) -> Comparison {
        Comparison { error, champion, seen_by_champion, trials: 4 }
    }

    #[test]
    fn a_worse_version_is_no_candidate_unless_the_champion_knew_the_trials() {
        assert!(comparison(0.2, Some(0.1), 0).is_worse());
        assert!(!comparison(0.1, Some(0.2), 0).is_worse());
        assert!(!comparison(0.2, None, 0).is_worse());
        let favoured = comparison(0.2, Some(0.1), 3);
        assert!(!favoured.is_worse() && favoured.words().contains("fitted on 3 of these 4 trials"));
    }
}
