//! A version: its coefficients, what it says of the standard manoeuvres, where it holds, and how it
//! was made.

mod coefficients;
mod figures;
mod lineage;

use askama::Template;
use sistership_dynamics::manoeuvre::{
    ManoeuvreSettings, StandardManoeuvres, standard, turn, zigzag,
};
use sistership_dynamics::{PlantError, Ship};
use sistership_model::Law;
use sistership_pipeline::Archive;
use sistership_pipeline::archive::document;
use sistership_pipeline::line::CHAMPION;
use sistership_pipeline::version::VersionDocument;
use sistership_report::numbers::stated;
use sistership_report::plots::Hull;
use sistership_store::{Page, Version};

use self::coefficients::CoefficientRow;
use self::figures::{CriterionRow, FigureRow};
use self::lineage::Lineage;
use crate::date::date;
use crate::error::Result;
use crate::picture::svg;
use crate::plot::{LINES, Track, channels, ground, legend};
use crate::shell::Shell;

/// What the page is made of.
pub struct Gathered {
    shell: Shell,
    version: Version,
    document: VersionDocument,
    law: Law,
    aliases: Vec<String>,
    /// The revision of the alias `champion`, if there is one.
    champion: Option<i64>,
    report: Option<String>,
    lineage: Lineage,
    recipe: String,
}

#[derive(Template)]
#[template(path = "version.html")]
struct VersionPage<'a> {
    of: &'a Gathered,
    shell: &'a Shell,
    created: String,
    coefficients: Vec<CoefficientRow>,
    effects: Vec<EffectRow>,
    figures: Vec<FigureRow>,
    criteria: Vec<CriterionRow>,
    banded: bool,
    wide: bool,
    notes: Vec<String>,
    legend: Vec<(&'static str, String)>,
    track: Option<String>,
    series: Option<String>,
    validity: Vec<(String, String, String)>,
    lineage: String,
    promotable: bool,
}

struct EffectRow {
    name: String,
    meaning: String,
    parameters: Vec<(String, String, String)>,
}

/// Reads what the page shows.
///
/// # Errors
/// There is no such version, or the store does not answer.
pub async fn gather(archive: &Archive, shell: Shell, ship: &str, number: i64) -> Result<Gathered> {
    let store = &archive.store;
    let version = store.versions().get(ship, number).await?;
    let parsed = document(&version)?;
    let law = archive.law(&parsed.model.law, parsed.recipe.law_sha256()).await?;
    let aliases = store.aliases().list(ship, &Page::first(50)).await?.items;
    let reports = store.reports().by_version(&version.head.id, &Page::first(1)).await?;
    let champion = aliases.iter().find(|alias| alias.alias == CHAMPION);
    Ok(Gathered {
        champion: champion.map(|alias| alias.revision),
        aliases: aliases
            .into_iter()
            .filter(|alias| alias.version_number == number)
            .map(|alias| alias.alias)
            .collect(),
        report: reports.items.into_iter().next().map(|report| report.id),
        lineage: Lineage::of(archive, &version.head, &parsed).await?,
        recipe: serde_json::to_string_pretty(&parsed.recipe)?,
        shell: shell.at("/"),
        document: parsed,
        version,
        law,
    })
}

/// What was sailed for the page.
struct Sailed {
    figures: StandardManoeuvres,
    tracks: Vec<Track>,
}

impl Gathered {
    /// The page; the standard manoeuvres are sailed for it.
    ///
    /// # Errors
    /// The page cannot be written.
    pub fn html(&self) -> Result<String> {
        let model = &self.document.model;
        let (sailed, notes) = match self.sailed() {
            Ok(sailed) => {
                let failures = sailed.figures.failures.clone();
                (Some(sailed), failures)
            }
            Err(error) => (None, vec![error.to_string()]),
        };
        let (figures, criteria) = sailed.as_ref().map_or_else(Default::default, |sailed| {
            figures::rows(&sailed.figures, &self.document.report)
        });
        let tracks = sailed.map_or_else(Vec::new, |sailed| sailed.tracks);
        let turns = tracks.get(..2.min(tracks.len())).unwrap_or_default();
        let label = format!("Turning circles of {}", model.name);
        let page = VersionPage {
            of: self,
            shell: &self.shell,
            created: date(self.version.head.created_us),
            coefficients: coefficients::rows(model, &self.law),
            effects: effects(model),
            banded: figures.iter().any(|figure| !figure.band.is_empty()),
            wide: figures.iter().any(|figure| figure.wide),
            figures,
            criteria,
            notes,
            legend: legend(&tracks),
            track: ground(turns, Hull::of(&model.particulars), &label)
                .as_ref()
                .map(svg)
                .transpose()?,
            series: match tracks.get(2..).unwrap_or_default() {
                [] => None,
                zigzags => Some(svg(&channels(zigzags, "Zigzag 20/20 over time"))?),
            },
            validity: validity(model),
            lineage: svg(&self.lineage.drawn())?,
            promotable: !self.aliases.iter().any(|alias| alias == CHAMPION),
        };
        Ok(page.render()?)
    }

    /// The figures as they were sailed when the version was made.
    fn reported(&self) -> Option<StandardManoeuvres> {
        let refined = self.document.report.pointer("/manoeuvres/refined")?;
        serde_json::from_value(refined.clone()).ok()
    }

    fn sailed(&self) -> Result<Sailed, PlantError> {
        let mut ship = Ship::new(&self.document.model, &self.law)?;
        let settings = ManoeuvreSettings::default();
        let figures = self.reported().unwrap_or_else(|| standard(&ship, &settings));
        ship.forget_validity();
        let rolls = ship.has_roll();
        let starboard = turn(&ship, 35.0, &settings).ok().map(|turn| turn.track);
        let port = turn(&ship, -35.0, &settings).ok().map(|turn| turn.track);
        let zigzag = zigzag(&ship, 20.0, 20.0, &settings).ok().map(|zigzag| zigzag.track);
        let named = [
            (starboard, "turn, 35 deg to starboard"),
            (port, "turn, 35 deg to port"),
            (zigzag, "zigzag 20/20"),
        ];
        let tracks = named.into_iter().zip(LINES).filter_map(|((track, name), style)| {
            Some(Track::simulated(style, name, &track?, rolls))
        });
        Ok(Sailed { figures, tracks: tracks.collect() })
    }
}

fn effects(model: &sistership_model::Model) -> Vec<EffectRow> {
    let row = |effect: &sistership_model::effect::AppliedEffect| EffectRow {
        name: effect.name.clone(),
        meaning: effect.form.meaning.clone(),
        parameters: effect
            .parameters
            .iter()
            .map(|(name, of)| {
                let unit = effect.form.parameters.get(name).map(|one| one.unit.clone());
                (name.clone(), stated(of.value, 4), unit.unwrap_or_default())
            })
            .collect(),
    };
    model.effects.iter().map(row).collect()
}

/// Name, least and greatest of what the trials covered.
fn validity(model: &sistership_model::Model) -> Vec<(String, String, String)> {
    let ranges = model.validity.iter().flat_map(|region| &region.ranges);
    ranges.map(|(name, [low, high])| (name.clone(), stated(*low, 4), stated(*high, 4))).collect()
}
