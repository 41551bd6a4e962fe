//! Evidence for each hypothesis, and parameters of the effects found.

use std::collections::BTreeMap;

use sistership_diagnosis::{
    ConfoundedEffect, Diagnosis, HypothesisReport, MissingEffect, NextTrial, ValueWithError,
};
use sistership_model::effect::ActsOn;

use super::distinct::distinct_hypotheses;
use super::parameter::DisplayParameter;
use crate::numbers::{format_fixed, format_known, format_signed, format_significant, join_words};
use crate::tables::{ReportTable, TableCell, TableColumn, TableRow};

/// Number of hypotheses that are visible at first; the others are folded.
pub(crate) const SHOWN: usize = 12;
/// One knot, m/s.
const KNOT_M_S: f64 = 1852.0 / 3600.0;
/// Largest number of parameters in a cell.
const CELL: usize = 4;

/// Tables of all evaluated hypotheses: the most probable, and the others.
pub(crate) fn hypothesis_tables(diagnosis: &Diagnosis) -> (ReportTable, ReportTable) {
    let mut rows: Vec<(usize, &HypothesisReport)> =
        distinct_hypotheses(&diagnosis.hypotheses).into_iter().enumerate().collect();
    // The selected hypothesis is visible whatever its rank.
    rows.sort_by_key(|(rank, hypothesis)| (*rank >= SHOWN && !hypothesis.taken, *rank));
    let shown = rows.iter().filter(|(rank, hypothesis)| *rank < SHOWN || hypothesis.taken).count();
    let (first, others) = rows.split_at(shown);
    let table = |rows: &[(usize, &HypothesisReport)]| ReportTable {
        columns: hypothesis_columns(),
        rows: rows.iter().map(|(_, hypothesis)| self::hypothesis_row(hypothesis)).collect(),
    };
    (table(first), table(others))
}

fn hypothesis_columns() -> Vec<TableColumn> {
    vec![
        TableColumn::prose_column("hypothesis"),
        TableColumn::number_column("evidence", "ln"),
        TableColumn::text_column("that is", ""),
        TableColumn::number_column("held-out", "ln"),
        TableColumn::prose_column("parameters ± standard error"),
        TableColumn::prose_column("selected"),
    ]
}

fn hypothesis_row(hypothesis: &HypothesisReport) -> TableRow {
    let effects: Vec<String> =
        hypothesis.effects.iter().map(|effect| effect_words(effect)).collect();
    let name = if effects.is_empty() { "no effect".to_owned() } else { effects.join(" + ") };
    let taken = if hypothesis.taken {
        TableCell::new("").with_mark("✓ taken", "chosen")
    } else {
        TableCell::new(hypothesis.refused.clone().unwrap_or_default())
    };
    let cells = vec![
        TableCell::new(name),
        TableCell::new(format_signed(hypothesis.evidence, 1)),
        TableCell::new(evidence_strength(hypothesis.evidence)),
        TableCell::new(format_known(hypothesis.held_out, |value| format_signed(value, 1))),
        TableCell::new(parameter_list(&hypothesis.parameters)),
        taken,
    ];
    TableRow::from_cells(cells).with_highlight(hypothesis.taken)
}

/// Effect and form in words, `lever-arm/gnss` as `lever arm (gnss)`; the form `constant` is
/// omitted.
fn effect_words(effect: &str) -> String {
    match effect.split_once('/') {
        Some((name, "constant")) => name.replace('-', " "),
        Some((name, form)) => format!("{} ({form})", name.replace('-', " ")),
        None => effect.to_owned(),
    }
}

/// Strength of evidence on the scale of Kass and Raftery (1995).
fn evidence_strength(evidence: f64) -> &'static str {
    match evidence {
        evidence if evidence < 0.0 => "against it",
        evidence if evidence < 1.0 => "not worth more than a bare mention",
        evidence if evidence < 3.0 => "positive",
        evidence if evidence < 5.0 => "strong",
        _ => "very strong",
    }
}

fn parameter_list(parameters: &BTreeMap<String, ValueWithError>) -> String {
    let parameters = DisplayParameter::from_values(parameters);
    let one = |(_, parameter): &(&str, DisplayParameter)| {
        format!(
            "{} {} ± {} {}",
            parameter.words,
            parameter.value_text(),
            parameter.se_text(),
            parameter.unit
        )
        .trim_end()
        .to_owned()
    };
    let mut texts: Vec<String> = parameters.iter().map(one).take(CELL).collect();
    // Long lists are cut, with the number of omitted parameters.
    if parameters.len() > CELL {
        texts.push(format!("and {} more", parameters.len() - CELL));
    }
    texts.join("; ")
}

/// Table of the parameters of an effect that was found, with their values in the new version if
/// they were fitted again there.
pub(crate) fn parameter_table(found: &MissingEffect) -> ReportTable {
    let mut columns = vec![
        TableColumn::text_column("parameter", ""),
        TableColumn::text_column("", ""),
        TableColumn::number_column("value", ""),
        TableColumn::number_column("standard error", ""),
        TableColumn::text_column("unit", ""),
        TableColumn::number_column("value ÷ error", ""),
    ];
    // The columns of the new version exist only if the parameters were fitted again there.
    if !found.in_model.is_empty() {
        columns.extend([
            TableColumn::number_column("in the new version", ""),
            TableColumn::number_column("standard error", ""),
        ]);
    }
    let row = |named: &(&str, DisplayParameter)| parameter_row(named, &found.in_model);
    ReportTable {
        columns,
        rows: DisplayParameter::from_values(&found.parameters).iter().map(row).collect(),
    }
}

fn parameter_row(
    (name, parameter): &(&str, DisplayParameter),
    in_model: &BTreeMap<String, ValueWithError>,
) -> TableRow {
    // No ratio without a standard error.
    let ratio = (parameter.se > 0.0).then(|| (parameter.value / parameter.se).abs());
    let mut cells = vec![
        TableCell::new(&parameter.words),
        TableCell::code_cell(*name),
        TableCell::new(parameter.value_text()),
        TableCell::new(parameter.se_text()),
        TableCell::new(if parameter.unit.is_empty() { "–" } else { parameter.unit }),
        TableCell::new(format_known(ratio, |ratio| format_significant(ratio, 2))),
    ];
    if !in_model.is_empty() {
        let own = in_model.get(*name).map(|value| DisplayParameter::from_value(name, value));
        let text = |of: &dyn Fn(&DisplayParameter) -> String| {
            TableCell::new(own.as_ref().map_or_else(|| "–".to_owned(), of))
        };
        cells.extend([text(&DisplayParameter::value_text), text(&DisplayParameter::se_text)]);
    }
    TableRow::from_cells(cells)
}

/// Table of the effects that it is confounded with.
pub(crate) fn confounded_table(found: &MissingEffect) -> ReportTable {
    let columns = vec![
        TableColumn::text_column("effect", ""),
        TableColumn::number_column("angle", "deg"),
        TableColumn::number_column("evidence difference", "ln"),
        TableColumn::text_column("", ""),
    ];
    let row = |other: &ConfoundedEffect| {
        // Below 3 in the logarithm the evidence does not separate the two.
        let (mark, kind) =
            if other.behind < 3.0 { ("equally plausible", "bad") } else { ("less likely", "open") };
        let cells = vec![
            TableCell::code_cell(&other.name),
            TableCell::new(format_fixed(other.angle_deg, 1)),
            TableCell::new(format_fixed(other.behind, 1)),
        ];
        TableRow::from_cells(
            cells.into_iter().chain([TableCell::new("").with_mark(mark, kind)]).collect(),
        )
    };
    ReportTable { columns, rows: found.confounded_with.iter().map(row).collect() }
}

/// Returns the next trial as an instruction.
pub(crate) fn next_trial_instruction(next: &NextTrial) -> String {
    let names: Vec<String> = next.separates.iter().map(|name| name.replace('-', " ")).collect();
    format!(
        "Carry out a {} at {} m/s ({} kn) on a heading of {:.0} deg. It is expected to \
         distinguish {} (by {} in the logarithm of the evidence).",
        next.manoeuvre,
        format_significant(next.speed_m_s, 3),
        format_fixed(next.speed_m_s / KNOT_M_S, 1),
        next.heading_deg.rem_euclid(360.0),
        join_words(&names),
        format_fixed(next.expected, 1)
    )
}

/// Point of action of an effect, in words.
pub(crate) fn point_of_action(acts_on: ActsOn) -> &'static str {
    match acts_on {
        ActsOn::Force => "a force on the ship",
        ActsOn::Inflow => "the inflow of hull, propeller or rudder",
        ActsOn::Measurement => "the readings of instruments",
    }
}
