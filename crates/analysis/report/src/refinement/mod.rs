//! Report of a refinement: one self-contained HTML page to read and print, and the same content as
//! JSON.
//!
//! [`render_refinement`] collects the content once (coefficients, tuning options, manoeuvres,
//! measured figures, similarity, provenance, replays); JSON is that content, the page shows it with
//! tables and plots. Nothing depends on the clock.

mod acceptance;
mod coefficient_shifts;
mod coefficients;
mod content;
mod further;
mod html;
mod input;
mod manoeuvres;
mod measured_figures;
mod options;
mod provenance;
mod replays;
mod selection_table;
mod similarity;
mod summary;
mod tables;
#[cfg(test)]
mod tests;

pub use acceptance::imo_verdict;
pub use input::RefinementInput;

use crate::rendered::{RenderedReport, ReportError};
use content::RefinementContent;

/// Renders the report of a refinement; the same input gives the same bytes.
///
/// # Errors
/// Returns an error if a model cannot be simulated under the law, or if the page cannot be written.
pub fn render_refinement(input: &RefinementInput<'_>) -> Result<RenderedReport, ReportError> {
    let replayed = replays::replay_chosen(input)?;
    let further = further::simulate_further(input)?;
    let content = RefinementContent::from_input(input, &replayed, further);
    let html = html::render_page(input, &content, &replayed)?;
    Ok(RenderedReport { json: serde_json::to_value(&content)?, html })
}
