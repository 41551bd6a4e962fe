//! Unexplained remainder: segments that no effect explains, the level of the discrepancy, and
//! changes of the coefficients.

use sistership_diagnosis::{
    DiscrepancyLevel, OriginKind, RemainderDependence, RemainderOrigin, Settings, Unexplained,
    VariableDependence,
};
use sistership_model::Model;

use super::sentence::{motion, of_origin};
use crate::numbers::{fixed, known, list, signed, significant};
use crate::tables::{Cell, Column, Row, Table, setting};
use crate::words::{acceleration, recorded};

/// Table of the segments that no effect explains.
pub(crate) fn unexplained(stretches: &[Unexplained]) -> Table {
    let columns = vec![
        Column::text("trial", ""),
        Column::text("readings", ""),
        Column::number("from", "s"),
        Column::number("to", "s"),
        Column::number("remainder", "÷ noise"),
    ];
    let row = |stretch: &Unexplained| {
        let times = [stretch.from_s, stretch.to_s].map(|time| Cell::new(fixed(time, 0)));
        let names = [Cell::new(&stretch.trial), Cell::new(motion(&stretch.channel))];
        let remainder = Cell::new(fixed(stretch.rms_over_noise, 1));
        Row::of(names.into_iter().chain(times).chain([remainder]).collect())
    };
    Table { columns, rows: stretches.iter().map(row).collect() }
}

/// Origin of the remainder, as a sentence; `None` if nothing indicates it.
pub fn origin(all: &[RemainderOrigin]) -> Option<String> {
    let (first, others) = all.split_first()?;
    let evidence = |origin: &RemainderOrigin| fixed(origin.evidence, 0);
    let other = |origin: &RemainderOrigin| format!("{} ({})", of_origin(origin), evidence(origin));
    // Other possible origins follow in brackets with their evidence.
    let beside: Vec<String> = others.iter().map(other).collect();
    let beside = if beside.is_empty() { String::new() } else { format!("; {}", list(&beside)) };
    let kind = match first.of {
        OriginKind::Acceleration => "a force or moment that the model lacks",
        OriginKind::Readings => "an instrument",
    };
    let (most, trials) = (of_origin(first), first.trials);
    Some(format!(
        "It comes most likely from {most}, {kind} (evidence {}, foremost in {} of {trials} \
         trials){beside}.",
        evidence(first),
        first.first_in
    ))
}

/// Dependence of the remainders on recorded variables, one sentence each.
pub(crate) fn dependences(all: &[RemainderDependence]) -> Vec<String> {
    all.iter().map(dependence).collect()
}

/// Dependence of the remainder of an acceleration on recorded variables, as a sentence.
pub fn dependence(of: &RemainderDependence) -> String {
    let percent = |share: f64| fixed(100.0 * share.min(1.0), 0);
    let one = |variable: &VariableDependence| {
        let (name, ..) = recorded(&variable.variable);
        format!("{name} ({} %)", percent(variable.share))
    };
    let names: Vec<String> = of.variables.iter().map(one).collect();
    let equation = motion(&of.channel);
    let explained = percent(of.explained);
    match (names.is_empty(), explained == "0") {
        (true, true) => format!("What is left in {equation} follows nothing that was recorded."),
        (true, false) => format!(
            "{explained} % of what is left in {equation} follows what was recorded, no one \
             variable by itself."
        ),
        (false, _) => format!(
            "{explained} % of what is left in {equation} follows what was recorded, most of all \
             {}.",
            list(&names)
        ),
    }
}

/// Table of the level of the unexplained accelerations.
pub(crate) fn discrepancies(levels: &[DiscrepancyLevel]) -> Table {
    let columns = vec![
        Column::text("equation", ""),
        Column::number("expected", "std. deviation"),
        Column::number("before", "std. deviation"),
        Column::number("after", "std. deviation"),
        Column::text("unit", ""),
    ];
    let row = |level: &DiscrepancyLevel| {
        let (unit, factor) = acceleration(&level.channel);
        let cell = |value: f64| Cell::new(significant(value * factor, 2));
        let expected = Cell::new(known(level.expected, |value| significant(value * factor, 2)));
        Row::of(vec![
            Cell::new(motion(&level.channel)),
            expected,
            cell(level.before),
            cell(level.after),
            Cell::new(unit),
        ])
    };
    Table { columns, rows: levels.iter().map(row).collect() }
}

/// Table of the coefficients that changed with the effects; `None` if none did.
pub(crate) fn coefficients(before: &Model, after: &Model) -> Option<Table> {
    let columns = vec![
        Column::text("coefficient", ""),
        Column::number("before", ""),
        Column::number("after", ""),
        Column::number("change", "%"),
    ];
    let row = |name: &String| {
        let (before, after) = (before.coefficient(name), after.coefficient(name));
        // A relative change needs a value before.
        let change = (before != 0.0).then(|| 100.0 * (after - before) / before.abs());
        let cells = [
            significant(before, 4),
            significant(after, 4),
            known(change, |change| signed(change, 1)),
        ];
        Row::of(std::iter::once(Cell::code(name)).chain(cells.into_iter().map(Cell::new)).collect())
    };
    let changed = after
        .coefficients
        .keys()
        .filter(|name| before.coefficient(name) != after.coefficient(name));
    let rows: Vec<Row> = changed.map(row).collect();
    (!rows.is_empty()).then_some(Table { columns, rows })
}

/// Meanings of the settings.
const MEANINGS: [(&str, &str); 6] = [
    (
        "restart_s",
        "simulations that judge start anew from the measured state every so often, s; by default \
         ten times L/U",
    ),
    (
        "least_step_s",
        "shortest interval between samples that are used, s; by default a fiftieth of L/U",
    ),
    (
        "slack",
        "how far a published coefficient may be from the truth, as a share of its value, where the \
         model does not say",
    ),
    ("least_evidence", "least evidence for an effect to be named"),
    ("most_effects", "most effects that are named together"),
    ("prior_odds", "odds that trials have an effect, where others than the library's are set"),
];

/// Table of all settings with their meaning.
pub(crate) fn settings(settings: &Settings) -> Table {
    let columns =
        vec![Column::text("setting", ""), Column::prose("value"), Column::prose("meaning")];
    let written = serde_json::to_value(settings).unwrap_or_default();
    let meaning = |name: &str| {
        MEANINGS.iter().find(|(known, _)| *known == name).map_or("", |(_, meaning)| meaning)
    };
    let fields = written.as_object().into_iter().flatten();
    let rows = fields.map(|(name, value)| {
        Row::of(vec![Cell::code(name), Cell::new(setting(value)), Cell::new(meaning(name))])
    });
    Table { columns, rows: rows.collect() }
}
