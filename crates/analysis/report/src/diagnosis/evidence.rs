//! Evidence for each hypothesis, and parameters of the effects found.

use std::collections::BTreeMap;

use sistership_diagnosis::{Confounded, Diagnosis, Found, Hypothesis, NextTrial, Value};
use sistership_model::effect::ActsOn;

use super::distinct::distinct;
use super::parameter::ShownParameter;
use crate::numbers::{fixed, known, list, signed, significant};
use crate::tables::{Cell, Column, Row, Table};

/// Number of hypotheses that are visible at first; the others are folded.
pub(crate) const SHOWN: usize = 12;
/// One knot, m/s.
const KNOT_M_S: f64 = 1852.0 / 3600.0;
/// Largest number of parameters in a cell.
const CELL: usize = 4;

/// Tables of all evaluated hypotheses: the most probable, and the others.
pub(crate) fn hypotheses(diagnosis: &Diagnosis) -> (Table, Table) {
    let mut rows: Vec<(usize, &Hypothesis)> =
        distinct(&diagnosis.hypotheses).into_iter().enumerate().collect();
    // The selected hypothesis is visible whatever its rank.
    rows.sort_by_key(|(rank, hypothesis)| (*rank >= SHOWN && !hypothesis.taken, *rank));
    let shown = rows.iter().filter(|(rank, hypothesis)| *rank < SHOWN || hypothesis.taken).count();
    let (first, others) = rows.split_at(shown);
    let table = |rows: &[(usize, &Hypothesis)]| Table {
        columns: columns(),
        rows: rows.iter().map(|(_, hypothesis)| self::hypothesis(hypothesis)).collect(),
    };
    (table(first), table(others))
}

fn columns() -> Vec<Column> {
    vec![
        Column::prose("hypothesis"),
        Column::number("evidence", "ln"),
        Column::text("that is", ""),
        Column::number("on trials left out", "ln"),
        Column::prose("parameters ± standard error"),
        Column::text("", ""),
    ]
}

fn hypothesis(hypothesis: &Hypothesis) -> Row {
    let effects: Vec<String> = hypothesis.effects.iter().map(|effect| in_words(effect)).collect();
    let name = if effects.is_empty() { "the model alone".to_owned() } else { effects.join(" + ") };
    let taken =
        if hypothesis.taken { Cell::new("").mark("✓ taken", "chosen") } else { Cell::new("") };
    let cells = vec![
        Cell::new(name),
        Cell::new(signed(hypothesis.evidence, 1)),
        Cell::new(strength(hypothesis.evidence)),
        Cell::new(known(hypothesis.held_out, |value| signed(value, 1))),
        Cell::new(parameter_list(&hypothesis.parameters)),
        taken,
    ];
    Row::of(cells).highlighted(hypothesis.taken)
}

/// Effect and form in words, `lever-arm/gnss` as `lever arm (gnss)`; the form `constant` is
/// omitted.
fn in_words(effect: &str) -> String {
    match effect.split_once('/') {
        Some((name, "constant")) => name.replace('-', " "),
        Some((name, form)) => format!("{} ({form})", name.replace('-', " ")),
        None => effect.to_owned(),
    }
}

/// Strength of evidence on the scale of Kass and Raftery (1995).
fn strength(evidence: f64) -> &'static str {
    match evidence {
        evidence if evidence < 0.0 => "against it",
        evidence if evidence < 1.0 => "worth no more than a mention",
        evidence if evidence < 3.0 => "positive",
        evidence if evidence < 5.0 => "strong",
        _ => "very strong",
    }
}

fn parameter_list(parameters: &BTreeMap<String, Value>) -> String {
    let parameters = ShownParameter::all(parameters);
    let one = |(_, parameter): &(&str, ShownParameter)| {
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
pub(crate) fn parameters(found: &Found) -> Table {
    let mut columns = vec![
        Column::text("parameter", ""),
        Column::text("", ""),
        Column::number("value", ""),
        Column::number("standard error", ""),
        Column::text("unit", ""),
        Column::number("value ÷ error", ""),
    ];
    // The columns of the new version exist only if the parameters were fitted again there.
    if !found.in_model.is_empty() {
        columns.extend([
            Column::number("in the new version", ""),
            Column::number("standard error", ""),
        ]);
    }
    let row = |named: &(&str, ShownParameter)| parameter(named, &found.in_model);
    Table { columns, rows: ShownParameter::all(&found.parameters).iter().map(row).collect() }
}

fn parameter(
    (name, parameter): &(&str, ShownParameter),
    in_model: &BTreeMap<String, Value>,
) -> Row {
    // No ratio without a standard error.
    let ratio = (parameter.se > 0.0).then(|| (parameter.value / parameter.se).abs());
    let mut cells = vec![
        Cell::new(&parameter.words),
        Cell::code(*name),
        Cell::new(parameter.value_text()),
        Cell::new(parameter.se_text()),
        Cell::new(if parameter.unit.is_empty() { "–" } else { parameter.unit }),
        Cell::new(known(ratio, |ratio| significant(ratio, 2))),
    ];
    if !in_model.is_empty() {
        let own = in_model.get(*name).map(|value| ShownParameter::of(name, value));
        let text = |of: &dyn Fn(&ShownParameter) -> String| {
            Cell::new(own.as_ref().map_or_else(|| "–".to_owned(), of))
        };
        cells.extend([text(&ShownParameter::value_text), text(&ShownParameter::se_text)]);
    }
    Row::of(cells)
}

/// Table of the effects that it is confounded with.
pub(crate) fn confounded(found: &Found) -> Table {
    let columns = vec![
        Column::text("effect", ""),
        Column::number("angle", "deg"),
        Column::number("evidence behind", "ln"),
        Column::text("", ""),
    ];
    let row = |other: &Confounded| {
        // Below 3 in the logarithm the evidence does not separate the two.
        let (mark, kind) = if other.behind < 3.0 {
            ("could as well be this", "bad")
        } else {
            ("less likely", "open")
        };
        let cells = vec![
            Cell::code(&other.name),
            Cell::new(fixed(other.angle_deg, 1)),
            Cell::new(fixed(other.behind, 1)),
        ];
        Row::of(cells.into_iter().chain([Cell::new("").mark(mark, kind)]).collect())
    };
    Table { columns, rows: found.confounded_with.iter().map(row).collect() }
}

/// Returns the next trial as an instruction.
pub(crate) fn next_trial(next: &NextTrial) -> String {
    let names: Vec<String> = next.separates.iter().map(|name| name.replace('-', " ")).collect();
    format!(
        "Sail a {} at {} m/s ({} kn) on a heading of {:.0} deg. It is expected to tell {} apart \
         (by {} in the logarithm of the evidence).",
        next.manoeuvre,
        significant(next.speed_m_s, 3),
        fixed(next.speed_m_s / KNOT_M_S, 1),
        next.heading_deg.rem_euclid(360.0),
        list(&names),
        fixed(next.expected, 1)
    )
}

/// Point of action of an effect, in words.
pub(crate) fn acts_on(acts_on: ActsOn) -> &'static str {
    match acts_on {
        ActsOn::Force => "a force on the ship",
        ActsOn::Inflow => "what the hull, propeller or rudder sees",
        ActsOn::Measurement => "what the instruments say",
    }
}
