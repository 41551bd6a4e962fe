//! Text output of the zoo and of a contributed ship.

use std::path::Path;

use sistership_assessment::validation::{
    CatalogueEntry, CitedWork, FigureComparison, ModelAppraisal, Severity, ShipReview,
};
use sistership_report::numbers::format_hundredths;

use crate::table::TextTable;

/// Formats models with their status and manoeuvres, and the published trials they are compared
/// with.
pub fn format_models(models: &[ModelAppraisal]) -> String {
    format!("{}{}", model_table(models), trial_table(models))
}

fn model_table(models: &[ModelAppraisal]) -> String {
    let mut table = TextTable::new([
        "model",
        "law",
        "status",
        "advance L",
        "tactical L",
        "10/10 deg",
        "20/20 deg",
    ]);
    for model in models {
        table.add_row([
            model.model.clone(),
            model.law.clone(),
            model.standing.as_word().to_owned(),
            format_hundredths(model.turn_lengths(|turn| turn.advance_m)),
            format_hundredths(model.turn_lengths(|turn| turn.tactical_diameter_m)),
            format_hundredths(model.first_overshoot_deg(10.0)),
            format_hundredths(model.first_overshoot_deg(20.0)),
        ]);
    }
    table.to_string()
}

fn trial_table(models: &[ModelAppraisal]) -> String {
    let mut table = TextTable::new([
        "model",
        "published trial",
        "unit",
        "published",
        "simulated",
        "allowed",
        "",
    ]);
    // The table is omitted without published trials.
    let mut any = false;
    for model in models {
        for one in &model.comparisons {
            any = true;
            table.add_row(trial_cells(model, one));
        }
    }
    if any { format!("\n{table}") } else { String::new() }
}

fn trial_cells(model: &ModelAppraisal, one: &FigureComparison) -> [String; 7] {
    [
        model.model.clone(),
        one.figure.clone(),
        one.unit.to_owned(),
        format_hundredths(Some(one.published)),
        format_hundredths(one.sailed),
        format_hundredths(Some(one.limit)),
        if one.is_within() { "met" } else { "missed" }.to_owned(),
    ]
}

/// Formats the findings on a contributed ship.
pub fn format_review(review: &ShipReview, written: Option<&Path>) -> String {
    let mut text =
        format!("{}: {}\n\n{}", review.ship, review.title, format_models(&review.models));
    for (severity, head) in [(Severity::Refused, "Refused"), (Severity::Look, "To be reviewed")] {
        let of = review.findings.iter().filter(|finding| finding.severity == severity);
        let lines: Vec<String> =
            of.map(|finding| format!("  {}: {}", finding.about, finding.message)).collect();
        if !lines.is_empty() {
            text.push_str(&format!("\n{head}\n{}\n", lines.join("\n")));
        }
    }
    if review.findings.is_empty() {
        text.push_str("\nNothing found.\n");
    }
    if let Some(path) = written {
        text.push_str(&format!("\nwritten to {}\n", path.display()));
    }
    text
}

/// Formats ships with the sources of their data.
pub fn format_citations(graph: &[CatalogueEntry]) -> String {
    let one = |ship: &CatalogueEntry| {
        let works: String = ship.sources.iter().map(format_source).collect();
        format!("{}: {}\n{works}", ship.identifier, ship.name)
    };
    graph.iter().map(one).collect::<Vec<String>>().join("\n")
}

fn format_source(work: &CitedWork) -> String {
    let url = work.url.as_ref().map_or(String::new(), |url| format!("\n    {url}"));
    // A licence, else the terms of use, if one of them is known.
    let terms = work.license.as_deref().or(work.usage).unwrap_or("unknown");
    format!("  {}: {}{url}\n    licence: {terms}\n", work.alternate_name, work.name)
}
