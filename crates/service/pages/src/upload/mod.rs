//! Upload of trials: files are chosen, the proposed mapping of their columns is shown with the
//! parsed data, corrected, and only then stored.

mod corrected;
mod exclusions;
mod preview;
mod proposed;
mod stored;
mod templates;
mod trial_fields;

use askama::Template;
use sistership_model::manifest::{MissingValues, RudderSign, VelocityFrame};
use sistership_store::ImportTemplateRow;
use sistership_trials::{ColumnGuess, Exclusion};

pub use corrected::correct_proposal;
pub use exclusions::RangeRequest;
pub use preview::FilePreview;
pub use proposed::UploadProposal;
pub use stored::{StoredUpload, stored_page};
pub use templates::TemplatePlace;

use self::proposed::{DERIVED, TARGETS};
use self::templates::TemplateOffer;
use self::trial_fields::{TrialFields, trial_fields};
use crate::error::Result;
use crate::language::say;
use crate::numbers::format_fixed;
use crate::shell::PageShell;

/// Units offered by the form.
const UNITS: [&str; 17] = [
    "s", "ms", "min", "auto", "hh:mm:ss", "m", "km", "m/s", "kn", "km/h", "rad", "deg", "rad/s",
    "deg/s", "deg/min", "rps", "rpm",
];

#[derive(Template)]
#[template(path = "upload.html")]
struct UploadPage<'a> {
    shell: &'a PageShell,
    ship: &'a str,
}

/// Returns the page on which files are chosen.
///
/// # Errors
/// Returns an error if the page cannot be rendered.
pub fn choose_page(shell: &PageShell, ship: &str) -> Result<String> {
    Ok(UploadPage { shell, ship }.render()?)
}

#[derive(Template)]
#[template(path = "mapping.html")]
struct MappingPage<'a> {
    shell: &'a PageShell,
    of: &'a UploadProposal,
    targets: [&'static str; 28],
    units: [&'static str; 17],
    columns: Vec<ColumnRow<'a>>,
    trials: Vec<TrialFields>,
    previews: &'a [FilePreview],
    accepted: bool,
    port: bool,
    water: bool,
    refuse: bool,
    drop: bool,
    derived: [(&'static str, bool); 3],
    excluded: Vec<ExclusionRow>,
    channels: Vec<&'a str>,
    offers: Vec<TemplateOffer>,
    manifest: String,
}

/// A column of one of the files whose columns are mapped.
struct ColumnRow<'a> {
    key: usize,
    guess: &'a ColumnGuess,
    channel: &'a str,
    unit: &'a str,
    reversed: bool,
    confidence: String,
}

/// Values that are excluded.
struct ExclusionRow {
    file: String,
    summary: String,
    rows: String,
}

/// Returns the page on which the mapping is reviewed, with the templates that are kept.
///
/// # Errors
/// Returns an error if the page cannot be rendered.
pub fn mapping_page(
    shell: &PageShell,
    of: &UploadProposal,
    previews: &[FilePreview],
    templates: &[ImportTemplateRow],
) -> Result<String> {
    let conventions = &of.manifest.manifest.conventions;
    let declared = &of.manifest.declarations;
    let page = MappingPage {
        shell,
        of,
        targets: TARGETS,
        units: UNITS,
        columns: column_rows(of),
        trials: trial_fields(&of.manifest),
        previews,
        // Only an upload without errors may be stored.
        accepted: previews.iter().all(FilePreview::is_accepted),
        port: conventions.rudder_positive == RudderSign::PortTurn,
        water: conventions.velocity == VelocityFrame::Water,
        refuse: conventions.missing == MissingValues::Refuse,
        drop: conventions.missing == MissingValues::Drop,
        derived: DERIVED.map(|(name, one)| (name, declared.derive.contains(&one))),
        excluded: declared.exclude.iter().map(exclusion_row).collect(),
        channels: of.channel_names(),
        offers: TemplateOffer::from_rows(templates, &of.guesses),
        manifest: of.manifest.to_yaml().unwrap_or_default(),
    };
    Ok(page.render()?)
}

impl MappingPage<'_> {
    /// Returns the first template that has the columns of a file, unless one is in use.
    fn matching_offer(&self) -> Option<(&TemplateOffer, &str)> {
        let open = self.offers.iter().filter(|_| self.of.template.is_none());
        open.filter_map(|offer| Some((offer, offer.file.as_deref()?))).next()
    }
}

/// Returns the reason of a reading: that of the form in the language of the page, those of the
/// identification of columns as manifests have them.
pub(crate) fn reading_reason(why: &str) -> String {
    if why == proposed::GIVEN { say("mapping-given").into() } else { why.to_owned() }
}

/// Returns the guesses whose columns the manifest maps. A sentence of NMEA 0183 needs no mapping.
fn column_rows(of: &UploadProposal) -> Vec<ColumnRow<'_>> {
    let files = of.mapped_files();
    let own = of.guesses.iter().enumerate();
    own.filter(|(_, guess)| files.contains(&guess.file.as_str()))
        .map(|(key, guess)| {
            let columns = of.mapped_columns(&guess.file);
            let known = columns.iter().find(|(_, mapped)| mapped.column == guess.column);
            let (channel, unit, reversed) = known.map_or(("", "", false), |(channel, mapped)| {
                (*channel, mapped.unit.as_str(), mapped.reversed)
            });
            let confidence = format_confidence(guess.probability);
            ColumnRow { key, guess, channel, unit, reversed, confidence }
        })
        .collect()
}

/// Formats a posterior probability, which is never certainty.
fn format_confidence(probability: f64) -> String {
    match probability {
        sure if sure >= 0.995 => say("mapping-over-99").into(),
        other => format!("{} %", format_fixed(100.0 * other, 0)),
    }
}

fn exclusion_row(one: &Exclusion) -> ExclusionRow {
    let rows = one.rows.as_ref().map_or_else(String::new, ToString::to_string);
    ExclusionRow { file: one.file.clone(), summary: one.summary_text(), rows }
}
