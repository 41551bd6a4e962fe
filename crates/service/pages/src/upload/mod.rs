//! Upload of trials: files are chosen, the proposed mapping of their columns is shown with the
//! parsed data, corrected, and only then stored.

mod corrected;
mod preview;
mod proposed;

use askama::Template;
use sistership_model::manifest::{MissingValues, RudderSign, VelocityFrame};
use sistership_trials::ColumnGuess;

pub use corrected::correct_manifest;
pub use preview::FilePreview;
pub use proposed::UploadProposal;

use self::proposed::{DERIVED, TARGETS, mapped_columns};
use crate::error::Result;
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
    previews: &'a [FilePreview],
    accepted: bool,
    port: bool,
    water: bool,
    refuse: bool,
    drop: bool,
    derived: [(&'static str, bool); 3],
    manifest: String,
}

/// A column of one of the files whose columns are mapped.
struct ColumnRow<'a> {
    key: usize,
    guess: &'a ColumnGuess,
    channel: &'a str,
    unit: &'a str,
}

/// Returns the page on which the mapping is reviewed.
///
/// # Errors
/// Returns an error if the page cannot be rendered.
pub fn mapping_page(
    shell: &PageShell,
    of: &UploadProposal,
    previews: &[FilePreview],
) -> Result<String> {
    let conventions = &of.manifest.manifest.conventions;
    let derive = &of.manifest.declarations.derive;
    let page = MappingPage {
        shell,
        of,
        targets: TARGETS,
        units: UNITS,
        columns: column_rows(of),
        previews,
        // Only an upload without errors may be stored.
        accepted: previews.iter().all(FilePreview::is_accepted),
        port: conventions.rudder_positive == RudderSign::PortTurn,
        water: conventions.velocity == VelocityFrame::Water,
        refuse: conventions.missing == MissingValues::Refuse,
        drop: conventions.missing == MissingValues::Drop,
        derived: DERIVED.map(|(name, one)| (name, derive.contains(&one))),
        manifest: of.manifest.to_yaml().unwrap_or_default(),
    };
    Ok(page.render()?)
}

/// Returns the guesses whose columns the manifest maps: those of the first file, which the other
/// trials share, and those of further sensors. A sentence of NMEA 0183 needs no mapping.
fn column_rows(of: &UploadProposal) -> Vec<ColumnRow<'_>> {
    let own = of.guesses.iter().enumerate().filter(|(_, guess)| of.is_mapped(&guess.file));
    own.map(|(key, guess)| {
        let columns = mapped_columns(&of.manifest, &guess.file);
        let known = columns.iter().find(|(_, mapped)| mapped.column == guess.column);
        let (channel, unit) =
            known.map_or(("", ""), |(channel, mapped)| (channel.as_str(), mapped.unit.as_str()));
        ColumnRow { key, guess, channel, unit }
    })
    .collect()
}
