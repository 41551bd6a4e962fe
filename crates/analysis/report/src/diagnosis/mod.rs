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

pub use changes::change;
pub use distinct::distinct;
pub use input::DiagnosisInput;
pub use remaining::{dependence, origin};

use serde_json::{Value, json};

use crate::rendered::{Rendered, ReportError};

/// Renders the report of a diagnosis; the same input gives the same bytes.
///
/// # Errors
/// Returns an error if a model cannot be simulated under the law, or if the page cannot be written.
pub fn render_diagnosis(input: &DiagnosisInput<'_>) -> Result<Rendered, ReportError> {
    let replayed = replays::replay_chosen(input)?;
    Ok(Rendered { json: document(input)?, html: html::page(input, &replayed)? })
}

/// Diagnosis as JSON, with its sentences and versions.
fn document(input: &DiagnosisInput<'_>) -> Result<Value, ReportError> {
    let mut document = serde_json::to_value(input.diagnosis)?;
    document["format"] = json!("sistership-diagnosis/1");
    document["sentence"] = json!(sentence::sentence(input.diagnosis));
    document["summary"] = json!(summary::summary(input.diagnosis));
    document["version"] = json!({ "diagnosed": input.of, "made": input.made });
    Ok(document)
}
