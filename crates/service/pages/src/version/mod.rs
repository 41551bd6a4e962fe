//! The page of a version: its coefficients, standard manoeuvres, range of validity, and lineage.

pub mod acceptance;
mod coefficients;
pub(crate) mod figures;
mod lineage;
mod manoeuvres;
pub mod turn;

use std::sync::Arc;

use askama::Template;
use sistership_jobs::Archive;
use sistership_jobs::aliases::CHAMPION;
use sistership_jobs::archive::version_document;
use sistership_jobs::version::VersionDocument;
use sistership_model::Law;
use sistership_report::variable_words;
use sistership_store::{PageRequest, Version};

use self::coefficients::AxisCoefficients;
use self::lineage::VersionLineage;
use self::manoeuvres::ManoeuvreResults;
use crate::date::format_date;
use crate::error::Result;
use crate::language::{has_word, say_word};
use crate::numbers::{format_fixed, format_stated};
use crate::picture::render_svg;
use crate::shell::PageShell;
use crate::terms::imo_words;

pub use self::manoeuvres::ManoeuvreCache;

/// Inputs of the page.
pub struct VersionPageInputs {
    shell: PageShell,
    version: Version,
    document: VersionDocument,
    law: Law,
    aliases: Vec<String>,
    /// Revision of the alias `champion`, if there is one.
    champion: Option<i64>,
    report: Option<String>,
    lineage: VersionLineage,
    recipe: String,
}

#[derive(Template)]
#[template(path = "version.html")]
struct VersionPage<'a> {
    of: &'a VersionPageInputs,
    shell: &'a PageShell,
    created: String,
    coefficients: Vec<AxisCoefficients>,
    speed: Option<String>,
    effects: Vec<EffectRow>,
    sailed: Arc<ManoeuvreResults>,
    /// Verdict on the standards of IMO in a sentence, and its class.
    verdict: (String, &'static str),
    validity: Vec<(String, String, String)>,
    lineage: String,
    promotable: bool,
}

struct EffectRow {
    name: String,
    meaning: String,
    parameters: Vec<(String, String, String)>,
}

/// Reads the inputs of the page.
///
/// # Errors
/// Returns an error if there is no such version or the store fails.
pub async fn gather_inputs(
    archive: &Archive,
    shell: PageShell,
    ship: &str,
    number: i64,
) -> Result<VersionPageInputs> {
    let store = &archive.store;
    let version = store.versions().get(ship, number).await?;
    let mut parsed = version_document(&version)?;
    // The weights of a learned correction are an object of their own.
    archive.attach_weights(&mut parsed.model).await?;
    // The law is that of the hash in the recipe.
    let law = archive.law_by_hash(&parsed.model.law, parsed.recipe.law_sha256()).await?;
    let aliases = store.aliases().list(ship, &PageRequest::first_page(50)).await?.items;
    let reports = store.reports().by_version(&version.head.id, &PageRequest::first_page(1)).await?;
    let champion = aliases.iter().find(|alias| alias.alias == CHAMPION);
    Ok(VersionPageInputs {
        champion: champion.map(|alias| alias.revision),
        aliases: aliases
            .into_iter()
            .filter(|alias| alias.version_number == number)
            .map(|alias| alias.alias)
            .collect(),
        report: reports.items.into_iter().next().map(|report| report.id),
        lineage: VersionLineage::load(archive, &version.head, &parsed).await?,
        recipe: serde_json::to_string_pretty(&parsed.recipe)?,
        shell: shell.at_place("/"),
        document: parsed,
        version,
        law,
    })
}

impl VersionPageInputs {
    /// Returns the page; the standard manoeuvres are simulated for it unless they are in the cache.
    ///
    /// # Errors
    /// Returns an error if the page cannot be rendered.
    pub fn render_html(&self, known: &ManoeuvreCache) -> Result<String> {
        let model = &self.document.model;
        let sailed = known.get_or_simulate(&self.version.head.id, &self.document, &self.law)?;
        let page = VersionPage {
            of: self,
            shell: &self.shell,
            created: format_date(self.version.head.created_us),
            coefficients: coefficients::coefficients_by_axis(model, &self.law),
            speed: model.speed_m_s.map(speed_words),
            effects: effect_rows(model),
            verdict: imo_words(&sailed.verdicts()),
            sailed,
            validity: validity_rows(model),
            lineage: render_svg(&self.lineage.draw())?,
            promotable: !self.aliases.iter().any(|alias| alias == CHAMPION),
        };
        Ok(page.render()?)
    }
}

fn effect_rows(model: &sistership_model::Model) -> Vec<EffectRow> {
    let row = |effect: &sistership_model::effect::AppliedEffect| EffectRow {
        name: effect.name.clone(),
        meaning: effect.form.meaning.clone(),
        parameters: effect
            .parameters
            .iter()
            .map(|(name, of)| {
                let unit = effect.form.parameters.get(name).map(|one| one.unit.clone());
                (name.clone(), format_stated(of.value, 4), unit.unwrap_or_default())
            })
            .collect(),
    };
    model.effects.iter().map(row).collect()
}

/// Returns a speed in metres per second and knots.
fn speed_words(speed_m_s: f64) -> String {
    let knots = format_fixed(speed_m_s * 3600.0 / 1852.0, 1);
    format!("{} m/s ({knots} kn)", format_fixed(speed_m_s, 2))
}

/// Returns name, minimum and maximum of the ranges that the trials covered, in words and units of
/// readers.
fn validity_rows(model: &sistership_model::Model) -> Vec<(String, String, String)> {
    let ranges = model.validity.iter().flat_map(|region| &region.ranges);
    let row = |(name, [low, high]): (&String, &[f64; 2])| {
        let (words, unit, shown) = variable_words(name);
        let words = match has_word("variable", name) {
            true => say_word("variable", name),
            false => words.to_owned(),
        };
        let name =
            if unit == "SI" { words } else { format!("{words} [{}]", say_word("unit", unit)) };
        (name, format_stated(shown(*low), 4), format_stated(shown(*high), 4))
    };
    ranges.map(row).collect()
}
