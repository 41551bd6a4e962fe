//! The headline and the errors before and after.

use std::collections::BTreeMap;

use serde::Serialize;
use sistership_model::vessel::Status;

use super::numbers::list;
use super::words::{self, CHANNELS, Quantity};
use super::{Input, VersionLabel, provenance};

/// Changes smaller than this share are no change.
const SAME: f64 = 0.005;

/// What the report is of, and what came out.
#[derive(Debug, Serialize)]
pub(super) struct Headline<'a> {
    pub ship: &'a str,
    pub title: &'a str,
    pub source: &'a str,
    pub source_status: Option<Status>,
    pub status: Status,
    pub law: &'a str,
    pub law_title: &'a str,
    pub method: &'a str,
    pub trials: usize,
    pub version: Option<VersionLabel>,
    pub verdict: String,
}

impl<'a> Headline<'a> {
    pub fn of(input: &Input<'a>, errors: &Errors<'_>) -> Self {
        let refinement = input.refinement;
        Self {
            ship: &refinement.ship,
            title: &input.vessel.file.title,
            source: &refinement.source,
            source_status: provenance::source_status(input),
            status: refinement.model.status,
            law: &input.law.name,
            law_title: &input.law.title,
            method: &refinement.method,
            trials: input.trials.len(),
            version: input.version.clone(),
            verdict: verdict(input, errors),
        }
    }
}

/// Errors on manoeuvres left out.
#[derive(Debug, Serialize)]
pub(super) struct Errors<'a> {
    pub how: &'a str,
    /// Whether the errors are of the very trial that was fitted.
    pub on_fitted_trial: bool,
    pub restart_s: Option<f64>,
    pub rows: Vec<ErrorRow>,
}

/// Root mean square error of one channel, in its shown unit.
#[derive(Debug, Clone, Copy, Serialize)]
pub(super) struct ErrorRow {
    #[serde(flatten)]
    pub quantity: Quantity,
    pub source: Option<f64>,
    pub refined: Option<f64>,
    /// Source over refined: above one where the error fell.
    pub factor: Option<f64>,
}

impl<'a> Errors<'a> {
    pub fn of(input: &Input<'a>) -> Self {
        let (held_out, settings) = (&input.refinement.held_out, &input.refinement.settings);
        let rolls = |quantity: &Quantity| input.law.has_roll() || !matches!(quantity.channel, "phi" | "p");
        let rows = CHANNELS.into_iter().filter(rolls).map(|q| ErrorRow::of(q, &held_out.source, &held_out.refined));
        Self {
            how: &held_out.how,
            on_fitted_trial: settings.held_out.is_empty() && input.trials.len() == 1,
            restart_s: settings.restart_s,
            rows: rows.filter(|row| row.source.is_some() || row.refined.is_some()).collect(),
        }
    }

    /// The rows of a headline: speeds, yaw rate, heading and position.
    pub fn headline(&self) -> impl Iterator<Item = &ErrorRow> {
        self.rows.iter().filter(|row| ["u", "v", "r", "psi", "position"].contains(&row.quantity.channel))
    }
}

impl ErrorRow {
    /// The error of a channel in both models.
    pub fn of(quantity: Quantity, source: &BTreeMap<String, f64>, refined: &BTreeMap<String, f64>) -> Self {
        let shown = |errors| error(errors, quantity.channel).map(|value| value * quantity.factor);
        let (source, refined) = (shown(source), shown(refined));
        let factor = source.zip(refined).filter(|(s, r)| *s > 0.0 && *r > 0.0).map(|(s, r)| s / r);
        Self { quantity, source, refined, factor }
    }

    /// `fell`, `rose` or `unchanged`, and by what factor.
    pub fn change(&self) -> (&'static str, f64) {
        match self.factor {
            None => ("unknown", 1.0),
            Some(factor) if (factor - 1.0).abs() < SAME => ("unchanged", 1.0),
            Some(factor) if factor > 1.0 => ("fell", factor),
            Some(factor) => ("rose", 1.0 / factor),
        }
    }

    /// The change in words: `4.2 times smaller`.
    pub fn change_text(&self) -> String {
        match self.change() {
            ("fell", factor) => format!("{} times smaller", times(factor)),
            ("rose", factor) => format!("{} times larger", times(factor)),
            (word, _) => word.into(),
        }
    }
}

/// A factor with two digits that mean something, never rounded down to a bare one.
fn times(factor: f64) -> String {
    let decimals = if factor < 1.95 { 2 } else { usize::from(factor < 9.95) };
    super::numbers::fixed(factor, decimals)
}

/// A recorded error; the distance in the plane is put together from north and east.
fn error(errors: &BTreeMap<String, f64>, channel: &str) -> Option<f64> {
    if channel == "position" {
        return Some(error(errors, "x")?.hypot(error(errors, "y")?));
    }
    errors.get(channel).copied().filter(|value| value.is_finite() && *value < 1e300)
}

fn verdict(input: &Input<'_>, errors: &Errors<'_>) -> String {
    if input.is_source_kept() {
        return "No refinement beat the source on manoeuvres left out: the source model is kept as it is.".into();
    }
    let phrases: Vec<String> = ["fell", "rose", "unchanged"].into_iter().filter_map(|word| phrase(errors, word)).collect();
    let place = if errors.on_fitted_trial {
        "On the trial that was fitted (nothing could be left out)"
    } else {
        "On manoeuvres that the fit had not seen"
    };
    if phrases.is_empty() {
        return format!("{place}, no error is known.");
    }
    format!("{place}, the error {}.", phrases.join("; it "))
}

/// `fell by a factor of 4.2 in surge speed and 1.3 in heading`.
fn phrase(errors: &Errors<'_>, word: &str) -> Option<String> {
    let rows: Vec<&ErrorRow> = errors.headline().filter(|row| row.change().0 == word).collect();
    let named = |row: &&ErrorRow| match row.change() {
        ("unchanged", _) => row.quantity.name.to_owned(),
        (_, factor) => format!("{} in {}", times(factor), row.quantity.name),
    };
    let words = list(&rows.iter().map(named).collect::<Vec<_>>());
    match word {
        _ if rows.is_empty() => None,
        "unchanged" => Some(format!("is unchanged in {words}")),
        _ => Some(format!("{word} by a factor of {words}")),
    }
}

/// The estimator in words.
pub(super) fn method_text(headline: &Headline<'_>) -> String {
    match words::method(headline.method) {
        "" => headline.method.to_owned(),
        text => format!("{}: {text}", headline.method),
    }
}
