//! Errors before and after: by channel, by trial, and of the measured manoeuvres.

use std::collections::BTreeMap;

use sistership_diagnosis::{Diagnosis, ManoeuvreOutcome, TrialErrors};
use sistership_simulation::metrics::ManoeuvreMetrics;

use crate::error_row::ErrorRow;
use crate::metrics::{MetricValue, manoeuvre_figures};
use crate::numbers::{format_fixed, format_known, format_signed, format_significant};
use crate::tables::{ReportTable, TableCell, TableColumn, TableRow};
use crate::words::{CHANNELS, DisplayChannel};

/// Root mean squared errors by channel, SI units.
type ChannelErrors = BTreeMap<String, f64>;

/// Returns the errors of every channel that has one.
pub(crate) fn error_rows(diagnosis: &Diagnosis) -> Vec<ErrorRow> {
    let rows = CHANNELS
        .into_iter()
        .map(|quantity| ErrorRow::from_errors(quantity, &diagnosis.before, &diagnosis.after));
    rows.filter(|row| row.source.is_some() || row.refined.is_some()).collect()
}

/// Table of errors by channel, as they are and divided by the noise.
pub(crate) fn channel_table(diagnosis: &Diagnosis) -> ReportTable {
    let columns = vec![
        TableColumn::text_column("channel", ""),
        TableColumn::text_column("unit", ""),
        TableColumn::number_column("before", "RMS error"),
        TableColumn::number_column("after", "RMS error"),
        TableColumn::number_column("noise", "std. deviation"),
        TableColumn::number_column("before", "÷ noise"),
        TableColumn::number_column("after", "÷ noise"),
        TableColumn::text_column("change", ""),
    ];
    ReportTable {
        columns,
        rows: error_rows(diagnosis).iter().map(|row| channel_row(row, &diagnosis.noise)).collect(),
    }
}

fn channel_row(row: &ErrorRow, noise: &ChannelErrors) -> TableRow {
    let noise = display_noise(noise, &row.quantity);
    // Errors relative to the noise are the measure of what remains to explain.
    let over = |value: Option<f64>| {
        format_known(value.zip(noise).map(|(value, noise)| value / noise), |ratio| {
            format_fixed(ratio, 1)
        })
    };
    let plain = |value: Option<f64>| format_known(value, |value| format_significant(value, 3));
    let kind = match row.error_change().0 {
        "fell" => "good",
        "rose" => "bad",
        _ => "open",
    };
    TableRow::from_cells(vec![
        TableCell::new(row.quantity.name),
        TableCell::new(row.quantity.unit),
        TableCell::new(plain(row.source)),
        TableCell::new(plain(row.refined)),
        TableCell::new(plain(noise)),
        TableCell::new(over(row.source)),
        TableCell::new(over(row.refined)),
        TableCell::new("").with_mark(row.change_text(), kind),
    ])
}

/// Noise in the displayed unit; that of the position is combined from north and east.
fn display_noise(noise: &ChannelErrors, quantity: &DisplayChannel) -> Option<f64> {
    let of = |channel: &str| noise.get(channel).copied().filter(|noise| *noise > 0.0);
    let si = if quantity.channel == "position" {
        Some(of("x")?.hypot(of("y")?))
    } else {
        of(quantity.channel)
    };
    si.map(|noise| noise * quantity.factor)
}

/// Table of errors by trial.
pub(crate) fn trial_table(trials: &[TrialErrors]) -> ReportTable {
    let has = |quantity: &DisplayChannel| {
        trials.iter().any(|trial| trial.before.contains_key(quantity.channel))
    };
    let channels: Vec<DisplayChannel> = CHANNELS.into_iter().filter(has).collect();
    let mut columns = vec![TableColumn::text_column("trial", ""), TableColumn::text_column("", "")];
    columns.extend(
        channels.iter().map(|quantity| TableColumn::number_column(quantity.symbol, quantity.unit)),
    );
    let side = |name: &str, side: &str, errors: &ChannelErrors| {
        let value = |quantity: &DisplayChannel| {
            errors
                .get(quantity.channel)
                .copied()
                .filter(|value| value.is_finite() && *value < 1e300)
        };
        let cell = |quantity: &DisplayChannel| {
            TableCell::new(format_known(value(quantity), |value| {
                format_significant(value * quantity.factor, 3)
            }))
        };
        TableRow::from_cells(
            [TableCell::new(name), TableCell::new(side)]
                .into_iter()
                .chain(channels.iter().map(cell))
                .collect(),
        )
    };
    // Two rows for each trial; the second has no name.
    let both = |trial: &TrialErrors| {
        [side(&trial.trial, "before", &trial.before), side("", "after", &trial.after)]
    };
    ReportTable { columns, rows: trials.iter().flat_map(both).collect() }
}

/// Table of the figures of measured manoeuvres, under a heading for each trial.
pub(crate) fn manoeuvre_table(manoeuvres: &[ManoeuvreOutcome]) -> ReportTable {
    let columns = vec![
        TableColumn::text_column("figure", ""),
        TableColumn::text_column("unit", ""),
        TableColumn::number_column("measured", ""),
        TableColumn::number_column("before", ""),
        TableColumn::number_column("after", ""),
        TableColumn::number_column("error before", "%"),
        TableColumn::number_column("error after", "%"),
    ];
    ReportTable { columns, rows: manoeuvres.iter().flat_map(manoeuvre_rows).collect() }
}

fn manoeuvre_rows(manoeuvre: &ManoeuvreOutcome) -> Vec<TableRow> {
    let of = |metrics: &Option<ManoeuvreMetrics>| {
        metrics.as_ref().map(manoeuvre_figures).unwrap_or_default()
    };
    let (measured, before, after) =
        (manoeuvre_figures(&manoeuvre.measured), of(&manoeuvre.before), of(&manoeuvre.after));
    // With the recorded rudder both models have the period of the record.
    let known = |(_, figure): &(usize, &MetricValue)| figure.2.is_some() && figure.0 != "period";
    let row = |(index, figure): (usize, &MetricValue)| {
        let value = |all: &[MetricValue]| all.get(index).and_then(|figure| figure.2);
        figure_row(figure, value(&before), value(&after))
    };
    let rows = measured.iter().enumerate().filter(known).map(row);
    std::iter::once(TableRow::heading_row(&manoeuvre.trial)).chain(rows).collect()
}

fn figure_row(
    &(name, unit, measured): &MetricValue,
    before: Option<f64>,
    after: Option<f64>,
) -> TableRow {
    let value = |value: Option<f64>| {
        TableCell::new(format_known(value, |value| format_significant(value, 4)))
    };
    let off = |simulated: Option<f64>| {
        let both = simulated.zip(measured).filter(|(_, measured)| *measured != 0.0);
        TableCell::new(format_known(
            both.map(|(simulated, measured)| 100.0 * (simulated / measured - 1.0)),
            |value| format_signed(value, 1),
        ))
    };
    TableRow::from_cells(vec![
        TableCell::new(name),
        TableCell::new(unit),
        value(measured),
        value(before),
        value(after),
        off(before),
        off(after),
    ])
}
