//! Errors before and after: by channel, by trial, and of the measured manoeuvres.

use std::collections::BTreeMap;

use sistership_diagnosis::{Diagnosis, SailedManoeuvre, TrialErrors};
use sistership_simulation::metrics::ManoeuvreMetrics;

use crate::error_row::ErrorRow;
use crate::metrics::{MetricValue, read};
use crate::numbers::{fixed, known, signed, significant};
use crate::tables::{Cell, Column, Row, Table};
use crate::words::{CHANNELS, ShownChannel};

/// Root mean squared errors by channel, SI units.
type ChannelErrors = BTreeMap<String, f64>;

/// Returns the errors of every channel that has one.
pub(crate) fn rows(diagnosis: &Diagnosis) -> Vec<ErrorRow> {
    let rows = CHANNELS
        .into_iter()
        .map(|quantity| ErrorRow::of(quantity, &diagnosis.before, &diagnosis.after));
    rows.filter(|row| row.source.is_some() || row.refined.is_some()).collect()
}

/// Table of errors by channel, as they are and divided by the noise.
pub(crate) fn by_channel(diagnosis: &Diagnosis) -> Table {
    let columns = vec![
        Column::text("channel", ""),
        Column::text("unit", ""),
        Column::number("before", "RMS error"),
        Column::number("after", "RMS error"),
        Column::number("noise", "std. deviation"),
        Column::number("before", "÷ noise"),
        Column::number("after", "÷ noise"),
        Column::text("change", ""),
    ];
    Table {
        columns,
        rows: rows(diagnosis).iter().map(|row| channel(row, &diagnosis.noise)).collect(),
    }
}

fn channel(row: &ErrorRow, noise: &ChannelErrors) -> Row {
    let noise = noise_of(noise, &row.quantity);
    // Errors relative to the noise are the measure of what remains to explain.
    let over = |value: Option<f64>| {
        known(value.zip(noise).map(|(value, noise)| value / noise), |ratio| fixed(ratio, 1))
    };
    let plain = |value: Option<f64>| known(value, |value| significant(value, 3));
    let kind = match row.change().0 {
        "fell" => "good",
        "rose" => "bad",
        _ => "open",
    };
    Row::of(vec![
        Cell::new(row.quantity.name),
        Cell::new(row.quantity.unit),
        Cell::new(plain(row.source)),
        Cell::new(plain(row.refined)),
        Cell::new(plain(noise)),
        Cell::new(over(row.source)),
        Cell::new(over(row.refined)),
        Cell::new("").mark(row.change_text(), kind),
    ])
}

/// Noise in the displayed unit; that of the position is combined from north and east.
fn noise_of(noise: &ChannelErrors, quantity: &ShownChannel) -> Option<f64> {
    let of = |channel: &str| noise.get(channel).copied().filter(|noise| *noise > 0.0);
    let si = if quantity.channel == "position" {
        Some(of("x")?.hypot(of("y")?))
    } else {
        of(quantity.channel)
    };
    si.map(|noise| noise * quantity.factor)
}

/// Table of errors by trial.
pub(crate) fn by_trial(trials: &[TrialErrors]) -> Table {
    let has = |quantity: &ShownChannel| {
        trials.iter().any(|trial| trial.before.contains_key(quantity.channel))
    };
    let channels: Vec<ShownChannel> = CHANNELS.into_iter().filter(has).collect();
    let mut columns = vec![Column::text("trial", ""), Column::text("", "")];
    columns.extend(channels.iter().map(|quantity| Column::number(quantity.symbol, quantity.unit)));
    let side = |name: &str, side: &str, errors: &ChannelErrors| {
        let value = |quantity: &ShownChannel| {
            errors
                .get(quantity.channel)
                .copied()
                .filter(|value| value.is_finite() && *value < 1e300)
        };
        let cell = |quantity: &ShownChannel| {
            Cell::new(known(value(quantity), |value| significant(value * quantity.factor, 3)))
        };
        Row::of(
            [Cell::new(name), Cell::new(side)]
                .into_iter()
                .chain(channels.iter().map(cell))
                .collect(),
        )
    };
    // Two rows for each trial; the second has no name.
    let both = |trial: &TrialErrors| {
        [side(&trial.trial, "before", &trial.before), side("", "after", &trial.after)]
    };
    Table { columns, rows: trials.iter().flat_map(both).collect() }
}

/// Table of the figures of measured manoeuvres, under a heading for each trial.
pub(crate) fn manoeuvres(manoeuvres: &[SailedManoeuvre]) -> Table {
    let columns = vec![
        Column::text("figure", ""),
        Column::text("unit", ""),
        Column::number("measured", ""),
        Column::number("before", ""),
        Column::number("after", ""),
        Column::number("before off by", "%"),
        Column::number("after off by", "%"),
    ];
    Table { columns, rows: manoeuvres.iter().flat_map(manoeuvre).collect() }
}

fn manoeuvre(manoeuvre: &SailedManoeuvre) -> Vec<Row> {
    let of = |metrics: &Option<ManoeuvreMetrics>| metrics.as_ref().map(read).unwrap_or_default();
    let (measured, before, after) =
        (read(&manoeuvre.measured), of(&manoeuvre.before), of(&manoeuvre.after));
    // With the recorded rudder both models have the period of the record.
    let known = |(_, figure): &(usize, &MetricValue)| figure.2.is_some() && figure.0 != "period";
    let row = |(index, figure): (usize, &MetricValue)| {
        let value = |all: &[MetricValue]| all.get(index).and_then(|figure| figure.2);
        figure_row(figure, value(&before), value(&after))
    };
    let rows = measured.iter().enumerate().filter(known).map(row);
    std::iter::once(Row::heading(&manoeuvre.trial)).chain(rows).collect()
}

fn figure_row(
    &(name, unit, measured): &MetricValue,
    before: Option<f64>,
    after: Option<f64>,
) -> Row {
    let value = |value: Option<f64>| Cell::new(known(value, |value| significant(value, 4)));
    let off = |simulated: Option<f64>| {
        let both = simulated.zip(measured).filter(|(_, measured)| *measured != 0.0);
        Cell::new(known(
            both.map(|(simulated, measured)| 100.0 * (simulated / measured - 1.0)),
            |value| signed(value, 1),
        ))
    };
    Row::of(vec![
        Cell::new(name),
        Cell::new(unit),
        value(measured),
        value(before),
        value(after),
        off(before),
        off(after),
    ])
}
