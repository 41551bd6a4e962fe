//! What a version says of the standard manoeuvres, with bands where its report has them.

use serde_json::Value;
use sistership_dynamics::manoeuvre::{Figure, StandardManoeuvres};
use sistership_report::numbers::{fixed, known, significant};

/// A band wider than this share of the figure is called wide.
const WIDE: f64 = 0.5;

/// A figure of a manoeuvre.
pub(super) struct FigureRow {
    pub name: String,
    pub unit: String,
    pub value: String,
    pub band: String,
    pub wide: bool,
}

/// A criterion of IMO MSC.137(76).
pub(super) struct CriterionRow {
    pub name: String,
    pub unit: String,
    pub value: String,
    pub limit: String,
    pub verdict: &'static str,
    pub class: &'static str,
    /// The share of models drawn from the posterior that meet it.
    pub share: String,
}

/// Figures and criteria.
pub(super) fn rows(
    sailed: &StandardManoeuvres,
    report: &Value,
) -> (Vec<FigureRow>, Vec<CriterionRow>) {
    let manoeuvres = &report["manoeuvres"];
    let figures = sailed.figures();
    let plain = figures.iter().filter(|figure| figure.pass.is_none());
    let plain = plain.filter(|figure| !figure.name.starts_with("IMO"));
    let criteria = sailed.imo.iter().map(|criterion| {
        let known = rows_of(&manoeuvres["imo"]);
        let mut known = known.filter(|row| row["criterion"] == criterion.criterion.as_str());
        let share = known.next().and_then(|row| row["pass_share"].as_f64());
        let (verdict, class) = match criterion.pass {
            Some(true) => ("met", "good"),
            Some(false) => ("not met", "bad"),
            None => ("unknown", ""),
        };
        CriterionRow {
            name: criterion.criterion.clone(),
            unit: criterion.unit.clone(),
            value: known_value(criterion.value),
            limit: significant(criterion.limit, 3),
            verdict,
            class,
            share: share.map_or_else(String::new, |share| format!("{} %", fixed(100.0 * share, 0))),
        }
    });
    (plain.map(|figure| row(figure, manoeuvres)).collect(), criteria.collect())
}

fn known_value(value: Option<f64>) -> String {
    known(value, |value| significant(value, 4))
}

fn row(figure: &Figure, manoeuvres: &Value) -> FigureRow {
    let band = band(&figure.name, manoeuvres);
    let wide =
        |(low, high): (f64, f64)| figure.value.is_some_and(|value| high - low > WIDE * value.abs());
    FigureRow {
        name: figure.name.clone(),
        unit: figure.unit.clone(),
        value: known_value(figure.value),
        band: band.map_or_else(String::new, |(low, high)| {
            format!("{} to {}", significant(low, 3), significant(high, 3))
        }),
        wide: band.is_some_and(wide),
    }
}

/// The band of a figure, `manoeuvre: figure`.
fn band(name: &str, manoeuvres: &Value) -> Option<(f64, f64)> {
    let (manoeuvre, figure) = name.split_once(": ")?;
    let all = rows_of(&manoeuvres["turns"]).chain(rows_of(&manoeuvres["zigzags"]));
    let mut own = all.filter(|row| row["manoeuvre"] == manoeuvre && row["figure"] == figure);
    let band = &own.next()?["band"];
    Some((band[0].as_f64()?, band[1].as_f64()?))
}

fn rows_of(value: &Value) -> impl Iterator<Item = &Value> {
    value.as_array().into_iter().flatten()
}
