//! Unexplained remainder: segments that no effect explains, the level of the discrepancy, and
//! changes of the coefficients.

use sistership_diagnosis::{
    DiscrepancyLevel, OriginKind, RemainderDependence, RemainderOrigin, Settings,
    UnexplainedSegment, VariableDependence,
};
use sistership_model::Model;

use super::sentence::{motion_word, origin_words};
use crate::numbers::{format_fixed, format_known, format_signed, format_significant, join_words};
use crate::tables::{ReportTable, TableCell, TableColumn, TableRow, format_setting};
use crate::words::{acceleration_unit, variable_words};

/// Table of the segments that no effect explains.
pub(crate) fn unexplained_table(stretches: &[UnexplainedSegment]) -> ReportTable {
    let columns = vec![
        TableColumn::text_column("trial", ""),
        TableColumn::text_column("readings", ""),
        TableColumn::number_column("from", "s"),
        TableColumn::number_column("to", "s"),
        TableColumn::number_column("remainder", "÷ noise"),
    ];
    let row = |stretch: &UnexplainedSegment| {
        let times =
            [stretch.from_s, stretch.to_s].map(|time| TableCell::new(format_fixed(time, 0)));
        let names = [TableCell::new(&stretch.trial), TableCell::new(motion_word(&stretch.channel))];
        let remainder = TableCell::new(format_fixed(stretch.rms_over_noise, 1));
        TableRow::from_cells(names.into_iter().chain(times).chain([remainder]).collect())
    };
    ReportTable { columns, rows: stretches.iter().map(row).collect() }
}

/// Origin of the remainder, as a sentence; `None` if nothing indicates it.
pub fn origin_sentence(all: &[RemainderOrigin]) -> Option<String> {
    let (first, others) = all.split_first()?;
    let evidence = |origin: &RemainderOrigin| format_fixed(origin.evidence, 0);
    let other =
        |origin: &RemainderOrigin| format!("{} ({})", origin_words(origin), evidence(origin));
    // Other possible origins follow in brackets with their evidence.
    let beside: Vec<String> = others.iter().map(other).collect();
    let beside =
        if beside.is_empty() { String::new() } else { format!("; {}", join_words(&beside)) };
    let kind = match first.of {
        OriginKind::Acceleration => "a force or moment that the model lacks",
        OriginKind::Readings => "an instrument",
    };
    let (most, trials) = (origin_words(first), first.trials);
    Some(format!(
        "The most probable origin is {most}, {kind} (evidence {}, largest in {} of {trials} \
         trials){beside}.",
        evidence(first),
        first.first_in
    ))
}

/// Dependence of the remainders on recorded variables, one sentence each.
pub(crate) fn dependence_sentences(all: &[RemainderDependence]) -> Vec<String> {
    all.iter().map(dependence_sentence).collect()
}

/// Dependence of the remainder of an acceleration on recorded variables, as a sentence.
pub fn dependence_sentence(of: &RemainderDependence) -> String {
    let percent = |share: f64| format_fixed(100.0 * share.min(1.0), 0);
    let one = |variable: &VariableDependence| {
        let (name, ..) = variable_words(&variable.variable);
        format!("{name} ({} %)", percent(variable.share))
    };
    let names: Vec<String> = of.variables.iter().map(one).collect();
    let equation = motion_word(&of.channel);
    let explained = percent(of.explained);
    match (names.is_empty(), explained == "0") {
        (true, true) => format!("The residual in {equation} depends on no recorded variable."),
        (true, false) => format!(
            "{explained} % of the residual in {equation} depends on recorded variables, but on no \
             single one."
        ),
        (false, _) => format!(
            "{explained} % of the residual in {equation} depends on recorded variables, mainly on \
             {}.",
            join_words(&names)
        ),
    }
}

/// Table of the level of the unexplained accelerations.
pub(crate) fn discrepancy_table(levels: &[DiscrepancyLevel]) -> ReportTable {
    let columns = vec![
        TableColumn::text_column("equation", ""),
        TableColumn::number_column("expected", "std. deviation"),
        TableColumn::number_column("before", "std. deviation"),
        TableColumn::number_column("after", "std. deviation"),
        TableColumn::text_column("unit", ""),
    ];
    let row = |level: &DiscrepancyLevel| {
        let (unit, factor) = acceleration_unit(&level.channel);
        let cell = |value: f64| TableCell::new(format_significant(value * factor, 2));
        let expected = TableCell::new(format_known(level.expected, |value| {
            format_significant(value * factor, 2)
        }));
        TableRow::from_cells(vec![
            TableCell::new(motion_word(&level.channel)),
            expected,
            cell(level.before),
            cell(level.after),
            TableCell::new(unit),
        ])
    };
    ReportTable { columns, rows: levels.iter().map(row).collect() }
}

/// Table of the coefficients that changed with the effects; `None` if none did.
pub(crate) fn coefficient_table(before: &Model, after: &Model) -> Option<ReportTable> {
    let columns = vec![
        TableColumn::text_column("coefficient", ""),
        TableColumn::number_column("before", ""),
        TableColumn::number_column("after", ""),
        TableColumn::number_column("change", "%"),
    ];
    let row = |name: &String| {
        let (before, after) = (before.coefficient(name), after.coefficient(name));
        // A relative change needs a value before.
        let change = (before != 0.0).then(|| 100.0 * (after - before) / before.abs());
        let cells = [
            format_significant(before, 4),
            format_significant(after, 4),
            format_known(change, |change| format_signed(change, 1)),
        ];
        TableRow::from_cells(
            std::iter::once(TableCell::code_cell(name))
                .chain(cells.into_iter().map(TableCell::new))
                .collect(),
        )
    };
    let changed = after
        .coefficients
        .keys()
        .filter(|name| before.coefficient(name) != after.coefficient(name));
    let rows: Vec<TableRow> = changed.map(row).collect();
    (!rows.is_empty()).then_some(ReportTable { columns, rows })
}

/// Meanings of the settings.
const MEANINGS: [(&str, &str); 6] = [
    (
        "restart_s",
        "interval after which held-out simulations restart from the measured state, s; by default \
         ten times L/U",
    ),
    (
        "least_step_s",
        "shortest interval between samples that are used, s; by default a fiftieth of L/U",
    ),
    ("slack", "relative standard deviation of coefficients of a model without a posterior"),
    ("least_evidence", "smallest evidence of a reported effect"),
    ("most_effects", "largest number of effects in a combination"),
    ("prior_odds", "prior odds of effects that replace those of the library"),
];

/// Table of all settings with their meaning.
pub(crate) fn settings_table(settings: &Settings) -> ReportTable {
    let columns = vec![
        TableColumn::text_column("setting", ""),
        TableColumn::prose_column("value"),
        TableColumn::prose_column("meaning"),
    ];
    let written = serde_json::to_value(settings).unwrap_or_default();
    let meaning = |name: &str| {
        MEANINGS.iter().find(|(known, _)| *known == name).map_or("", |(_, meaning)| meaning)
    };
    let fields = written.as_object().into_iter().flatten();
    let rows = fields.map(|(name, value)| {
        TableRow::from_cells(vec![
            TableCell::code_cell(name),
            TableCell::new(format_setting(value)),
            TableCell::new(meaning(name)),
        ])
    });
    ReportTable { columns, rows: rows.collect() }
}
