//! Page of a contributed ship, in Markdown.

use std::fmt::Write as _;

use sistership_assessment::validation::{CatalogueEntry, ModelAppraisal, Severity, ShipReview};
use sistership_model::Vessel;

use crate::numbers::format_hundredths;

/// Returns the particulars, models, published trials, findings and sources of a ship as Markdown.
pub fn contributed_ship_page(vessel: &Vessel, review: &ShipReview) -> String {
    [
        format!("# {}\n\n{}\n\n", review.ship, review.title),
        findings_section(review),
        particulars_section(vessel),
        models_section(review),
        trials_section(review),
        sources_section(vessel),
    ]
    .concat()
}

/// Markdown table under a heading; empty without rows.
fn markdown_table(head: &str, columns: &[&str], rows: Vec<Vec<String>>) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let line = |cells: &[String]| {
        // A bar inside a cell would start a new cell.
        let cells: Vec<String> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
        format!("| {} |\n", cells.join(" | "))
    };
    let names: Vec<String> = columns.iter().map(|name| (*name).to_owned()).collect();
    let rules = vec!["---".to_owned(); columns.len()];
    let rows: String = rows.iter().map(|row| line(row)).collect();
    format!("## {head}\n\n{}{}{rows}\n", line(&names), line(&rules))
}

/// Findings of the review, the refusals first.
fn findings_section(review: &ShipReview) -> String {
    let verdict = if review.is_acceptable() { "It can be added." } else { "It is refused." };
    let mut text = format!("{verdict}\n\n");
    for (severity, head) in [(Severity::Refused, "Refused"), (Severity::Look, "To be reviewed")] {
        // Findings are grouped by severity, in the order of the review.
        let of = review.findings.iter().filter(|finding| finding.severity == severity);
        let lines: String =
            of.map(|finding| format!("- `{}`: {}\n", finding.about, finding.message)).collect();
        if !lines.is_empty() {
            let _ = write!(text, "## {head}\n\n{lines}\n");
        }
    }
    text
}

fn particulars_section(vessel: &Vessel) -> String {
    let row = |(name, quantity): (&String, &sistership_model::quantity::Quantity)| {
        let note = quantity.note.clone().unwrap_or_default();
        vec![name.clone(), format!("{}", quantity.value), quantity.source.clone(), note]
    };
    let rows = vessel.particulars.iter().map(row).collect();
    markdown_table("Particulars", &["particular", "value", "source", "note"], rows)
}

fn models_section(review: &ShipReview) -> String {
    let columns =
        ["model", "law", "status", "advance, L", "tactical, L", "10/10, deg", "20/20, deg"];
    markdown_table("Models", &columns, review.models.iter().map(model_cells).collect())
}

fn model_cells(model: &ModelAppraisal) -> Vec<String> {
    // The ship's name is in the title, so the model's own name is enough.
    let name = model.model.split_once('/').map_or(model.model.as_str(), |(_, name)| name);
    vec![
        format!("`{name}`"),
        format!("`{}`", model.law),
        model.standing.as_word().to_owned(),
        format_hundredths(model.turn_lengths(|turn| turn.advance_m)),
        format_hundredths(model.turn_lengths(|turn| turn.tactical_diameter_m)),
        format_hundredths(model.first_overshoot_deg(10.0)),
        format_hundredths(model.first_overshoot_deg(20.0)),
    ]
}

fn trials_section(review: &ShipReview) -> String {
    let columns = ["model", "figure", "published", "sailed", "allowed", "met", "source"];
    let each = review.models.iter().flat_map(|model| {
        model.comparisons.iter().map(|one| {
            vec![
                format!("`{}`", model.model),
                one.figure.clone(),
                format!("{:.2} ± {:.2} {}", one.published, one.uncertainty, one.unit),
                format_hundredths(one.sailed),
                format!("{:.2}", one.limit),
                if one.is_within() { "yes" } else { "no" }.to_owned(),
                one.source.clone(),
            ]
        })
    });
    markdown_table("Published trials", &columns, each.collect())
}

fn sources_section(vessel: &Vessel) -> String {
    let rows = CatalogueEntry::from_vessel(vessel).sources.into_iter().map(|work| {
        let terms = work.license.as_deref().or(work.usage).unwrap_or("unknown").to_owned();
        vec![work.alternate_name, work.name, work.url.unwrap_or_default(), terms]
    });
    markdown_table("Sources", &["key", "citation", "where", "licence"], rows.collect())
}
