//! Comparison of two to five versions: coefficients, standard manoeuvres, criteria, tracks.

mod simulations;
mod tables;

use askama::Template;
use sistership_jobs::Archive;
use sistership_report::plots::{HullOutline, LiveChart};

use self::simulations::VersionManoeuvres;
use self::tables::{ValueRow, coefficient_rows, criterion_rows, figure_rows};
use crate::error::{PageError, Result};
use crate::form::FormFields;
use crate::language::say;
use crate::named::NamedVersion;
use crate::numbers::format_fixed;
use crate::pickers;
use crate::plot::{PlotTrack, track_chart};
use crate::shell::PageShell;

/// Largest number of versions in a comparison.
const MOST_VERSIONS: usize = 5;

/// Inputs of the page.
pub struct ComparisonInputs {
    shell: PageShell,
    versions: Vec<NamedVersion>,
    wrong: Option<String>,
    asked: Vec<String>,
    known: Vec<String>,
}

#[derive(Template)]
#[template(path = "compare.html")]
struct ComparePage<'a> {
    shell: &'a PageShell,
    asked: Vec<&'a str>,
    known: &'a [String],
    wrong: Option<&'a str>,
    versions: Vec<ComparisonColumn<'a>>,
    turns: Option<LiveChart>,
    zigzags: Option<LiveChart>,
    figures: Vec<ValueRow>,
    criteria: Vec<ValueRow>,
    coefficients: Vec<ValueRow>,
    notes: Vec<String>,
}

struct ComparisonColumn<'a> {
    label: String,
    at: String,
    law: &'a str,
    method: &'a str,
    speed: String,
}

/// Reads the versions that the query names.
///
/// # Errors
/// Returns an error if the store fails. An unknown name is reported on the page.
pub async fn gather_inputs(
    archive: &Archive,
    shell: PageShell,
    query: &FormFields,
) -> Result<ComparisonInputs> {
    let asked: Vec<String> = query.get_texts("v").map(str::to_owned).collect();
    let (mut versions, mut wrong) = (Vec::new(), None);
    // Only the first unknown name is reported.
    for name in asked.iter().take(MOST_VERSIONS) {
        match NamedVersion::find(archive, "v", name).await {
            Ok(version) => versions.push(version),
            Err(PageError::Invalid { message, .. }) => wrong = wrong.or(Some(message)),
            Err(other) => return Err(other),
        }
    }
    let many = asked.len() > MOST_VERSIONS;
    // Names beyond the limit are dropped with a message.
    let wrong =
        wrong.or_else(|| many.then(|| say("compare-too-many").with("most", MOST_VERSIONS).into()));
    let known = pickers::model_names(archive).await?;
    Ok(ComparisonInputs { shell: shell.at_place("/compare"), versions, wrong, asked, known })
}

impl ComparisonInputs {
    /// Returns the page; the standard manoeuvres of each version are simulated for it.
    ///
    /// # Errors
    /// Returns an error if the page cannot be rendered.
    pub fn render_html(&self) -> Result<String> {
        let mut sailed: Vec<VersionManoeuvres> = Vec::new();
        for (place, version) in self.versions.iter().enumerate() {
            sailed.push(VersionManoeuvres::simulate_version(version, place));
        }
        let turns: Vec<_> = sailed.iter().filter_map(|one| one.turn.clone()).collect();
        let zigzags: Vec<_> = sailed.iter().filter_map(|one| one.zigzag.clone()).collect();
        // The longest hull, so that the outlines of all versions fit into the chart.
        let longest = self
            .versions
            .iter()
            .filter_map(|one| HullOutline::from_particulars(&one.document.model.particulars));
        let hull =
            longest.max_by(|a, b| a.lpp_m.total_cmp(&b.lpp_m)).filter(|_| self.is_single_ship());
        let chart = |tracks: &[PlotTrack], label: &'static str| {
            (!tracks.is_empty()).then(|| track_chart(tracks, hull, &say(label).to_string()))
        };
        let page = ComparePage {
            shell: &self.shell,
            asked: self.form_names(),
            known: &self.known,
            wrong: self.wrong.as_deref(),
            versions: self.versions.iter().map(ComparisonColumn::from_version).collect(),
            turns: chart(&turns, "compare-turns-label"),
            zigzags: chart(&zigzags, "compare-zigzags-label"),
            figures: figure_rows(&sailed),
            criteria: criterion_rows(&sailed),
            coefficients: coefficient_rows(&self.versions),
            notes: sailed.iter().flat_map(|one| one.notes.clone()).collect(),
        };
        Ok(page.render()?)
    }

    /// Returns true if all versions are of one ship, whose outline is then drawn.
    fn is_single_ship(&self) -> bool {
        self.versions.windows(2).all(|pair| pair[0].head.model == pair[1].head.model)
    }

    /// Names of the query, filled up with empty fields of the form.
    fn form_names(&self) -> Vec<&str> {
        let asked = self.asked.iter().map(String::as_str);
        asked.chain(std::iter::repeat("")).take(MOST_VERSIONS).collect()
    }
}

impl<'a> ComparisonColumn<'a> {
    fn from_version(version: &'a NamedVersion) -> Self {
        let speed = version.document.model.speed_m_s;
        Self {
            label: version.label(),
            at: format!("/ships/{}/versions/{}", version.head.model, version.head.number),
            law: &version.head.law,
            method: &version.head.method,
            speed: speed.map_or_else(String::new, |speed| format_fixed(speed, 2)),
        }
    }
}
