//! The reports of a refinement and of a diagnosis ([`diagnosis`]): one HTML page that a stranger can read and print, and the
//! same content as JSON.
//!
//! [`render`] gathers the content once (`summary`, `coefficients`, `options`, `manoeuvres`, `similarity`, `provenance`,
//! `replays`); JSON is that content, the page shows it with `tables` and `plots`. Nothing depends on the clock.

mod coefficients;
mod diagnosis;
mod html;
mod manoeuvres;
mod numbers;
mod options;
mod plots;
mod provenance;
mod replays;
mod sailed;
mod similarity;
mod summary;
mod tables;
#[cfg(test)]
mod tests;
mod tile;
mod words;

/// The style of reports, which other pages share.
pub const STYLE: &str = include_str!("../templates/report_style.css");

pub use diagnosis::{DiagnosisInput, distinct, render_diagnosis};

use serde::Serialize;
use sistership_dynamics::PlantError;
use sistership_estimate::refine::Refinement;
use sistership_estimate::source::Similarity;
use sistership_model::trial::Trial;
use sistership_model::{Law, Vessel};

/// What a report is made of.
#[derive(Debug, Clone)]
pub struct Input<'a> {
    /// The refinement.
    pub refinement: &'a Refinement,
    /// The law of both models.
    pub law: &'a Law,
    /// The target ship.
    pub vessel: &'a Vessel,
    /// The trials that were given, fitted and held out.
    pub trials: &'a [&'a Trial],
    /// How the source was found, where she was not named.
    pub similarity: Option<&'a Similarity>,
    /// The version under which the model is kept, where it is kept.
    pub version: Option<VersionLabel>,
}

impl Input<'_> {
    /// Whether no option beat the source, so that nothing was fitted.
    fn is_source_kept(&self) -> bool {
        self.refinement.options.iter().any(|option| option.chosen && option.step == "source")
    }
}

/// A version by name and hash.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct VersionLabel {
    /// The ship.
    pub ship: String,
    /// Its number.
    pub number: i64,
    /// The hash of its document, in hexadecimal.
    pub sha256: String,
}

/// A report in both forms.
#[derive(Debug, Clone, PartialEq)]
pub struct Rendered {
    /// The content as data.
    pub json: serde_json::Value,
    /// A page that stands alone.
    pub html: String,
}

/// Why there is no report.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A model does not simulate.
    #[error(transparent)]
    Plant(#[from] PlantError),
    /// The page could not be written.
    #[error("the report could not be written: {0}")]
    Page(#[from] askama::Error),
    /// The data could not be written.
    #[error("the report could not be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
}

/// Everything that a report says.
#[derive(Debug, Serialize)]
struct Content<'a> {
    format: &'static str,
    headline: summary::Headline<'a>,
    errors: summary::Errors<'a>,
    replays: Vec<replays::Shown<'a>>,
    coefficients: coefficients::Coefficients<'a>,
    options: options::Options<'a>,
    manoeuvres: manoeuvres::Comparison<'a>,
    sailed: Vec<sailed::Sailed>,
    similarity: Option<&'a Similarity>,
    provenance: provenance::Provenance<'a>,
}

/// Renders the report of a refinement; the same input gives the same bytes.
///
/// # Errors
/// A model does not simulate under the law, or the page cannot be written.
pub fn render(input: &Input<'_>) -> Result<Rendered, ReportError> {
    let replayed = replays::replay_chosen(input)?;
    let content = Content::of(input, &replayed);
    let html = html::page(&content, &replayed)?;
    Ok(Rendered { json: serde_json::to_value(&content)?, html })
}

impl<'a> Content<'a> {
    fn of(input: &Input<'a>, replayed: &[replays::Replayed<'a>]) -> Self {
        let errors = summary::Errors::of(input);
        Self {
            format: "sistership-report/1",
            headline: summary::Headline::of(input, &errors),
            errors,
            replays: replayed.iter().map(|replayed| replayed.shown.clone()).collect(),
            coefficients: coefficients::Coefficients::of(input),
            options: options::Options::of(input),
            manoeuvres: manoeuvres::Comparison::of(input),
            sailed: sailed::figures(input),
            similarity: input.similarity,
            provenance: provenance::Provenance::of(input),
        }
    }
}
