//! Figures of the standard manoeuvres of a version, with uncertainty bands if its report has them.

use serde_json::Value;
use sistership_simulation::manoeuvre::{NamedFigure, StandardManoeuvres};

use crate::language::{Message, say, say_word};
use crate::numbers::{format_fixed, format_known, format_significant};
use crate::terms::figure_words;

/// A band wider than this share of the figure is marked as wide.
const WIDE_SHARE: f64 = 0.5;

/// A figure of a manoeuvre.
#[derive(Debug)]
pub(super) struct FigureRow {
    pub name: String,
    pub unit: String,
    pub value: String,
    pub band: String,
    pub wide: bool,
}

/// A criterion of IMO MSC.137(76).
#[derive(Debug)]
pub(super) struct CriterionRow {
    pub name: String,
    /// Name in reports.
    pub key: String,
    pub unit: String,
    pub value: String,
    /// The value as a number, if the manoeuvre reached it.
    pub number: Option<f64>,
    pub pass: Option<bool>,
    pub band: String,
    pub limit: String,
    pub verdict: String,
    pub class: &'static str,
    /// Share of the models drawn from the posterior that meet it.
    pub share: String,
}

/// Returns figures and criteria.
pub(super) fn figure_rows(
    sailed: &StandardManoeuvres,
    report: &Value,
) -> (Vec<FigureRow>, Vec<CriterionRow>) {
    let bands = &report["manoeuvres"]["bands"]["figures"];
    let figures = sailed.list_figures();
    // Figures with a verdict are in the table of criteria.
    let plain = figures.iter().filter(|figure| figure.pass.is_none());
    let plain = plain.filter(|figure| !figure.name.starts_with("IMO"));
    let criteria = sailed.imo.iter().map(|criterion| {
        let name = format!("IMO: {}", criterion.criterion);
        let own = find_band(&name, bands);
        let share = own.and_then(|band| band["pass"].as_f64());
        let (verdict, class) = pass_words(criterion.pass);
        CriterionRow {
            name: say_word("criterion", &criterion.criterion),
            key: criterion.criterion.clone(),
            unit: say_word("unit", &criterion.unit),
            value: format_value(criterion.value),
            number: criterion.value,
            pass: criterion.pass,
            band: own.and_then(band_limits).map_or_else(String::new, format_limits),
            limit: format_significant(criterion.limit, 3),
            verdict: verdict.into(),
            class,
            share: share
                .map_or_else(String::new, |share| format!("{} %", format_fixed(100.0 * share, 0))),
        }
    });
    (plain.map(|figure| figure_row(figure, bands)).collect(), criteria.collect())
}

/// Returns the verdict on a criterion in a word, and its class.
pub(crate) fn pass_words(pass: Option<bool>) -> (Message, &'static str) {
    match pass {
        Some(true) => (say("pass-met"), "good"),
        Some(false) => (say("pass-not-met"), "bad"),
        None => (say("pass-unknown"), ""),
    }
}

fn format_value(value: Option<f64>) -> String {
    format_known(value, |value| format_significant(value, 4))
}

fn figure_row(figure: &NamedFigure, bands: &Value) -> FigureRow {
    let band = find_band(&figure.name, bands).and_then(band_limits);
    // A band is judged by its width relative to the value.
    let wide = |(low, high): (f64, f64)| {
        figure.value.is_some_and(|value| high - low > WIDE_SHARE * value.abs())
    };
    FigureRow {
        name: figure_words(&figure.name),
        unit: say_word("unit", &figure.unit),
        value: format_value(figure.value),
        band: band.map_or_else(String::new, format_limits),
        wide: band.is_some_and(wide),
    }
}

/// Limits of a band.
fn band_limits(band: &Value) -> Option<(f64, f64)> {
    Some((band["low"].as_f64()?, band["high"].as_f64()?))
}

fn format_limits((low, high): (f64, f64)) -> String {
    let text = say("range-text").with("low", format_significant(low, 3));
    text.with("high", format_significant(high, 3)).into()
}

/// Returns the band of a figure, by its name.
fn find_band<'a>(name: &str, bands: &'a Value) -> Option<&'a Value> {
    bands.as_array()?.iter().find(|band| band["figure"] == name)
}
