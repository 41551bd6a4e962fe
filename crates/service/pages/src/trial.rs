//! The page of a trial: track and channels, warnings of the checks, and versions fitted to it.

use askama::Template;
use serde::Deserialize;
use sistership_jobs::Archive;
use sistership_jobs::aliases::{CHAMPION, find_alias};
use sistership_jobs::archive::version_document;
use sistership_model::trial::{Channel, Finding, Trial as Samples};
use sistership_model::version::RecipeTrial;
use sistership_model::{Law, Model};
use sistership_report::plots::{HullOutline, LiveChart};
use sistership_report::variable_words;
use sistership_simulation::Ship;
use sistership_simulation::error::SquaredError;
use sistership_simulation::recorded::{ReplaySettings, replay_trial};
use sistership_store::{PageRequest, Trial};

use crate::conditions::{CONDITIONS, ConditionField, stated_text};
use crate::date::format_date;
use crate::error::Result;
use crate::language::{has_word, say, say_word};
use crate::numbers::format_significant;
use crate::plot::{LINES, PlotTrack, track_chart};
use crate::shell::PageShell;

/// Number of the ship's versions that are searched.
const SEARCHED_VERSIONS: i64 = 30;

/// Inputs of the page.
pub struct TrialPageInputs {
    shell: PageShell,
    trial: Trial,
    samples: Samples,
    champion: Option<ChampionModel>,
    versions: Vec<(i64, String)>,
    /// Conditions as they are stated for it: name and text.
    conditions: Vec<(String, String)>,
}

struct ChampionModel {
    number: i64,
    model: Model,
    law: Law,
}

#[derive(Template)]
#[template(path = "trial.html")]
struct TrialPage<'a> {
    of: &'a TrialPageInputs,
    shell: &'a PageShell,
    created: String,
    findings: Vec<Finding>,
    has_track: bool,
    chart: LiveChart,
    errors: Vec<(String, String)>,
    said: Option<String>,
    manifest: String,
}

/// The part of a version's document that names its trials.
#[derive(Deserialize)]
struct VersionTrials {
    recipe: RecipeTrials,
}

#[derive(Deserialize)]
struct RecipeTrials {
    #[serde(default)]
    trials: Vec<RecipeTrial>,
}

/// Reads the inputs of the page.
///
/// # Errors
/// Returns an error if there is no such trial, or if the archive does not give its samples.
pub async fn gather_inputs(
    archive: &Archive,
    shell: PageShell,
    id: &str,
) -> Result<TrialPageInputs> {
    let trial = archive.store.trials().get(id).await?;
    // The key of the object is the hash by which recipes name the samples.
    let named = RecipeTrial { name: trial.name.clone(), sha256: trial.object_key.clone() };
    let samples = archive.read_trials(&[named]).await?.pop().unwrap_or_default();
    Ok(TrialPageInputs {
        champion: load_champion(archive, &trial.ship).await?,
        versions: fitted_versions(archive, &trial).await?,
        conditions: stated_conditions(archive, &trial.id).await?,
        shell: shell.at_place("/"),
        trial,
        samples,
    })
}

/// Returns the conditions that are stated for a trial.
async fn stated_conditions(archive: &Archive, id: &str) -> Result<Vec<(String, String)>> {
    let stated = archive.store.trials().stated_conditions(id).await?;
    let text = |field: &ConditionField| stated_text(stated.as_ref(), field.name).to_owned();
    let all = CONDITIONS.iter().map(|field| (field.label(), text(field)));
    Ok(all.filter(|(_, text)| !text.is_empty()).collect())
}

async fn load_champion(archive: &Archive, ship: &str) -> Result<Option<ChampionModel>> {
    let Some(alias) = find_alias(&archive.store, ship, CHAMPION).await? else { return Ok(None) };
    let number = alias.version_number;
    let mut version = version_document(&archive.store.versions().get(ship, number).await?)?;
    archive.attach_weights(&mut version.model).await?;
    let law = archive.law_by_hash(&version.model.law, version.recipe.law_sha256()).await?;
    Ok(Some(ChampionModel { number, model: version.model, law }))
}

/// Returns number and method of the ship's versions that were fitted to a trial.
async fn fitted_versions(archive: &Archive, trial: &Trial) -> Result<Vec<(i64, String)>> {
    let mut found = Vec::new();
    let versions = archive.store.versions();
    for head in versions.list(&trial.ship, &PageRequest::first_page(SEARCHED_VERSIONS)).await?.items
    {
        let text = versions.get(&trial.ship, head.number).await?.document;
        // Documents that cannot be parsed are skipped: the list is for information only.
        let made: Option<VersionTrials> = serde_json::from_str(&text).ok();
        if made.is_some_and(|made| made.recipe.trials.iter().any(|one| one.sha256 == trial.sha256))
        {
            found.push((head.number, head.method));
        }
    }
    Ok(found)
}

impl TrialPageInputs {
    /// Returns the page, for which the champion is simulated.
    ///
    /// # Errors
    /// Returns an error if the page cannot be rendered.
    pub fn render_html(&self) -> Result<String> {
        let mut tracks = vec![PlotTrack::from_trial(&self.samples)];
        let (mut errors, mut said) = (Vec::new(), None);
        if let Some(champion) = &self.champion {
            // A champion that cannot be simulated leaves the measured track alone, with the reason.
            match champion.simulate_trial(&self.samples) {
                Ok((track, found)) => {
                    tracks.push(track);
                    errors = found;
                }
                Err(reason) => said = Some(reason),
            }
        }
        let hull = self
            .champion
            .as_ref()
            .and_then(|known| HullOutline::from_particulars(&known.model.particulars));
        let page = TrialPage {
            of: self,
            shell: &self.shell,
            created: format_date(self.trial.created_us),
            findings: serde_json::from_str(&self.trial.warnings).unwrap_or_default(),
            has_track: tracks.iter().any(|track| track.positions().is_some()),
            chart: track_chart(&tracks, hull, &self.trial.name),
            errors,
            said,
            manifest: format_json(&self.trial.manifest),
        };
        Ok(page.render()?)
    }
}

fn format_json(json: &str) -> String {
    let value: serde_json::Value = serde_json::from_str(json).unwrap_or_default();
    serde_json::to_string_pretty(&value).unwrap_or_default()
}

/// Returns an error with the name of its channel, in words and the unit of readers.
fn error_words(channel: &str, value: f64) -> (String, String) {
    let (plain, unit, shown) = variable_words(channel);
    let words = match has_word("variable", channel) {
        true => say_word("variable", channel),
        false => plain.to_owned(),
    };
    // Errors of directions do not wrap around.
    let shown = if unit == "deg" { value.to_degrees() } else { shown(value) };
    (words, format!("{} {}", format_significant(shown, 3), say_word("unit", unit)))
}

impl ChampionModel {
    /// Simulates the rudder and revolutions of a trial; returns the track and its errors.
    ///
    /// # Errors
    /// Returns the reason, in words, for which the champion cannot be simulated.
    fn simulate_trial(
        &self,
        trial: &Samples,
    ) -> Result<(PlotTrack, Vec<(String, String)>), String> {
        let mut ship = Ship::new(&self.model, &self.law).map_err(|error| error.to_string())?;
        // The trial may be faster than the approach speed of the model.
        let speeds = trial.channel(Channel::U).into_iter().flatten();
        ship.set_envelope_speed(speeds.fold(0.0, |most: f64, speed| most.max(speed.abs())));
        let run = replay_trial(&ship, trial, &ReplaySettings::default())
            .map_err(|error| error.to_string())?;
        let errors = SquaredError::from_trial(trial, &run).rmse_by_channel();
        let errors = errors.into_iter().map(|(name, value)| error_words(&name, value)).collect();
        let name = say("trial-champion-line").with("number", self.number);
        Ok((PlotTrack::from_simulation(LINES[0], name, &run.track, run.has_roll), errors))
    }
}
