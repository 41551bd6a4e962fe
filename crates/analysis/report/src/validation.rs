//! Report of a validation by ITTC 7.5-02-06-03.

use askama::Template;
use sistership_assessment::validation::{ValidatedQuantity, Validation, Verdict};
use sistership_model::version::code_revision;

use crate::numbers::{format_fixed, format_known, format_significant};
use crate::rendered::{RenderedReport, ReportError};
use crate::tables::{ReportTable, TableCell, TableColumn, TableRow};

/// Page as the template takes it.
#[derive(Template)]
#[template(path = "report_validation.html")]
struct ValidationPage<'a> {
    of: &'a Validation,
    verdict: String,
    quantities: ReportTable,
}

/// Renders a validation as a page and as JSON.
///
/// # Errors
/// Returns an error if it cannot be written.
pub fn render_validation(of: &Validation) -> Result<RenderedReport, ReportError> {
    let page = ValidationPage {
        of,
        verdict: verdict_sentence(of),
        quantities: quantity_table(&of.quantities),
    };
    Ok(RenderedReport { json: serde_json::to_value(of)?, html: page.render()? })
}

/// Result of the validation, as a sentence.
fn verdict_sentence(of: &Validation) -> String {
    let all = of.quantities.len();
    if all == 0 {
        return "There are no data to validate this model.".to_owned();
    }
    // Both verdicts leave the question open.
    let open = of.count_verdicts(Verdict::Undecided) + of.count_verdicts(Verdict::AboveWhatIsKnown);
    format!(
        "Of {all} quantities {} are validated at the level of their validation uncertainty, {} are \
         not, and {open} cannot be decided.",
        of.count_verdicts(Verdict::Validated),
        of.count_verdicts(Verdict::NotValidated),
    )
}

fn quantity_table(quantities: &[ValidatedQuantity]) -> ReportTable {
    let columns = vec![
        TableColumn::text_column("quantity", ""),
        TableColumn::text_column("unit", ""),
        TableColumn::number_column("D", "data"),
        TableColumn::number_column("S", "simulated"),
        TableColumn::number_column("E", "% D"),
        TableColumn::number_column("U_V", "% D"),
        TableColumn::number_column("U_D", ""),
        TableColumn::number_column("U_SN", ""),
        TableColumn::number_column("U_input", ""),
        TableColumn::text_column("", ""),
        TableColumn::prose_column("data from"),
    ];
    ReportTable { columns, rows: quantities.iter().map(quantity_row).collect() }
}

fn quantity_row(one: &ValidatedQuantity) -> TableRow {
    let value = |value: Option<f64>| {
        TableCell::new(format_known(value, |value| format_significant(value, 3)))
    };
    let percent =
        |value: Option<f64>| TableCell::new(format_known(value, |value| format_fixed(value, 1)));
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
    TableRow::from_cells(vec![
        TableCell::new(&one.quantity),
        TableCell::new(&one.unit),
        value(Some(one.data)),
        value(one.simulated),
        percent(one.comparison_error_percent),
        percent(one.validation_uncertainty_percent),
        value(one.data_uncertainty),
        value(one.step_uncertainty),
        value(one.input_uncertainty),
        TableCell::new("").with_mark(one.verdict.as_words(), kind),
        TableCell::new(from),
    ])
}

impl ValidationPage<'_> {
    fn revision(&self) -> &'static str {
        code_revision()
    }
}
