//! Figures of the standard manoeuvres of a version, with uncertainty bands if its report has them.

use serde_json::Value;
use sistership_report::numbers::{format_fixed, format_known, format_significant};
use sistership_simulation::manoeuvre::{NamedFigure, StandardManoeuvres};

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
    pub unit: String,
    pub value: String,
    /// The value as a number, if the manoeuvre reached it.
    pub number: Option<f64>,
    pub pass: Option<bool>,
    pub band: String,
    pub limit: String,
    pub verdict: &'static str,
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
        let (verdict, class) = match criterion.pass {
            Some(true) => ("met", "good"),
            Some(false) => ("not met", "bad"),
            None => ("unknown", ""),
        };
        CriterionRow {
            name: criterion.criterion.clone(),
            unit: criterion.unit.clone(),
            value: format_value(criterion.value),
            number: criterion.value,
            pass: criterion.pass,
            band: own.and_then(band_limits).map_or_else(String::new, format_limits),
            limit: format_significant(criterion.limit, 3),
            verdict,
            class,
            share: share
                .map_or_else(String::new, |share| format!("{} %", format_fixed(100.0 * share, 0))),
        }
    });
    (plain.map(|figure| figure_row(figure, bands)).collect(), criteria.collect())
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
        name: figure.name.clone(),
        unit: figure.unit.clone(),
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
    format!("{} to {}", format_significant(low, 3), format_significant(high, 3))
}

/// Returns the band of a figure, by its name.
fn find_band<'a>(name: &str, bands: &'a Value) -> Option<&'a Value> {
    bands.as_array()?.iter().find(|band| band["figure"] == name)
}
