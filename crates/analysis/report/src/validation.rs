//! Report of a validation by ITTC 7.5-02-06-03.

use askama::Template;
use sistership_assessment::validation::{ValidatedQuantity, Validation, Verdict};
use sistership_model::version::code_revision;

use crate::numbers::{fixed, known, significant};
use crate::rendered::{Rendered, ReportError};
use crate::tables::{Cell, Column, Row, Table};

/// Page as the template takes it.
#[derive(Template)]
#[template(path = "report_validation.html")]
struct ValidationPage<'a> {
    of: &'a Validation,
    verdict: String,
    quantities: Table,
}

/// Renders a validation as a page and as JSON.
///
/// # Errors
/// Returns an error if it cannot be written.
pub fn render_validation(of: &Validation) -> Result<Rendered, ReportError> {
    let page = ValidationPage { of, verdict: verdict(of), quantities: table(&of.quantities) };
    Ok(Rendered { json: serde_json::to_value(of)?, html: page.render()? })
}

/// Result of the validation, as a sentence.
fn verdict(of: &Validation) -> String {
    let all = of.quantities.len();
    if all == 0 {
        return "There is nothing to validate this model by.".to_owned();
    }
    // Both verdicts leave the question open.
    let open = of.count(Verdict::Undecided) + of.count(Verdict::AboveWhatIsKnown);
    format!(
        "Of {all} quantities {} are validated at the level of their validation uncertainty, {} are \
         not, and {open} cannot be decided.",
        of.count(Verdict::Validated),
        of.count(Verdict::NotValidated),
    )
}

fn table(quantities: &[ValidatedQuantity]) -> Table {
    let columns = vec![
        Column::text("quantity", ""),
        Column::text("unit", ""),
        Column::number("D", "data"),
        Column::number("S", "simulated"),
        Column::number("E", "% D"),
        Column::number("U_V", "% D"),
        Column::number("U_D", ""),
        Column::number("U_SN", ""),
        Column::number("U_input", ""),
        Column::text("", ""),
        Column::prose("data from"),
    ];
    Table { columns, rows: quantities.iter().map(row).collect() }
}

fn row(one: &ValidatedQuantity) -> Row {
    let value = |value: Option<f64>| Cell::new(known(value, |value| significant(value, 3)));
    let percent = |value: Option<f64>| Cell::new(known(value, |value| fixed(value, 1)));
    let kind = match one.verdict {
        Verdict::Validated => "good",
        Verdict::NotValidated => "bad",
        Verdict::AboveWhatIsKnown | Verdict::Undecided => "open",
    };
    // Repeated records are reported with their number.
    let from = match one.records {
        Some(records) => format!("{records}: {}", one.data_from),
        None => one.data_from.clone(),
    };
    Row::of(vec![
        Cell::new(&one.quantity),
        Cell::new(&one.unit),
        value(Some(one.data)),
        value(one.simulated),
        percent(one.comparison_error_percent),
        percent(one.validation_uncertainty_percent),
        value(one.data_uncertainty),
        value(one.step_uncertainty),
        value(one.input_uncertainty),
        Cell::new("").mark(one.verdict.words(), kind),
        Cell::new(from),
    ])
}

impl ValidationPage<'_> {
    fn revision(&self) -> &'static str {
        code_revision()
    }
}
