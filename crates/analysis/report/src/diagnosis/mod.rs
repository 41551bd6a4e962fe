//! Report of a diagnosis: one self-contained HTML page to read and print, and the diagnosis as
//! JSON.
//!
//! [`render_diagnosis`] states the result in one sentence (`sentence`), the recommended action and
//! the limits of detection in two more (`summary`), puts the figures into tables (`evidence`,
//! `errors`, `limits`, `remaining`, `changes`, `provenance`) and simulates the trials with the
//! model before and after (`replays`) for the plots. Nothing depends on the clock.

mod changes;
mod distinct;
mod errors;
mod evidence;
mod figures;
mod html;
mod input;
mod limits;
mod parameter;
mod provenance;
mod remaining;
mod replays;
mod sentence;
mod summary;
#[cfg(test)]
mod tests;

pub use changes::change_words;
pub use distinct::distinct_hypotheses;
pub use input::DiagnosisInput;
pub use remaining::{dependence_sentence, origin_sentence};

use serde_json::{Value, json};

use crate::rendered::{RenderedReport, ReportError};

/// Renders the report of a diagnosis; the same input gives the same bytes.
///
/// # Errors
/// Returns an error if a model cannot be simulated under the law, or if the page cannot be written.
pub fn render_diagnosis(input: &DiagnosisInput<'_>) -> Result<RenderedReport, ReportError> {
    let replayed = replays::replay_chosen(input)?;
    Ok(RenderedReport { json: json_document(input)?, html: html::render_page(input, &replayed)? })
}

/// Diagnosis as JSON, with its sentences and versions.
fn json_document(input: &DiagnosisInput<'_>) -> Result<Value, ReportError> {
    let mut document = serde_json::to_value(input.diagnosis)?;
    document["format"] = json!("sistership-diagnosis/1");
    document["sentence"] = json!(sentence::result_sentence(input.diagnosis));
    document["summary"] = json!(summary::summary_sentences(input.diagnosis));
    document["version"] = json!({ "diagnosed": input.of, "made": input.made });
    Ok(document)
}
