//! The report of a diagnosis: one HTML page that a stranger can read and print, and the diagnosis
//! as JSON.
//!
//! [`render_diagnosis`] says in one sentence what was found (`sentence`), in two more what to do
//! and what could not be told (`summary`), puts the figures into tables (`evidence`, `errors`,
//! `limits`, `remaining`, `changes`, `provenance`) and simulates the trials with the model
//! before and after (`replays`) for the plots. Nothing depends on the clock.

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
/// A model does not simulate under the law, or the page cannot be written.
pub fn render_diagnosis(input: &DiagnosisInput<'_>) -> Result<Rendered, ReportError> {
    let replayed = replays::replay_chosen(input)?;
    Ok(Rendered { json: document(input)?, html: html::page(input, &replayed)? })
}

/// The diagnosis with its place.
fn document(input: &DiagnosisInput<'_>) -> Result<Value, ReportError> {
    let mut document = serde_json::to_value(input.diagnosis)?;
    document["format"] = json!("sistership-diagnosis/1");
    document["sentence"] = json!(sentence::sentence(input.diagnosis));
    document["summary"] = json!(summary::summary(input.diagnosis));
    document["version"] = json!({ "diagnosed": input.of, "made": input.made });
    Ok(document)
}
