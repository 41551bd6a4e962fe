//! Headline, and errors before and after.

use serde::Serialize;
use sistership_identification::refine::TRIALS_ALONE;
use sistership_model::vessel::Status;

use super::input::RefinementInput;
use super::provenance;
use crate::error_row::{ErrorRow, format_factor};
use crate::numbers::join_words;
use crate::rendered::VersionLabel;
use crate::words::{self, CHANNELS, DisplayChannel};

/// Subject and result of the report.
#[derive(Debug, Serialize)]
pub(crate) struct ReportHeadline<'a> {
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

impl<'a> ReportHeadline<'a> {
    pub fn from_input(input: &RefinementInput<'a>, errors: &HeldOutErrors<'_>) -> Self {
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
            verdict: verdict_sentence(input, errors),
        }
    }
}

/// Errors on held-out manoeuvres.
#[derive(Debug, Serialize)]
pub(crate) struct HeldOutErrors<'a> {
    pub how: &'a str,
    /// True if the errors are on the fitted trial itself.
    pub on_fitted_trial: bool,
    pub restart_s: Option<f64>,
    /// Time over which the measured motion was smoothed, s; `None` if whole trials were held out,
    /// which are compared as recorded.
    pub smoothing_s: Option<f64>,
    pub rows: Vec<ErrorRow>,
}

impl<'a> HeldOutErrors<'a> {
    pub fn from_input(input: &RefinementInput<'a>) -> Self {
        let (held_out, settings) = (&input.refinement.held_out, &input.refinement.settings);
        // Roll channels only for laws with roll.
        let rolls = |quantity: &DisplayChannel| {
            input.law.has_roll() || !matches!(quantity.channel, "phi" | "p")
        };
        let rows = CHANNELS
            .into_iter()
            .filter(rolls)
            .map(|q| ErrorRow::from_errors(q, &held_out.source, &held_out.refined));
        Self {
            how: &held_out.how,
            on_fitted_trial: settings.held_out.is_empty() && input.trials.len() == 1,
            restart_s: settings.restart_s,
            smoothing_s: settings.compared_smoothing_s(),
            rows: rows.filter(|row| row.source.is_some() || row.refined.is_some()).collect(),
        }
    }

    /// Rows of the headline: speeds, yaw rate, heading and position.
    pub fn headline_rows(&self) -> impl Iterator<Item = &ErrorRow> {
        self.rows
            .iter()
            .filter(|row| ["u", "v", "r", "psi", "position"].contains(&row.quantity.channel))
    }
}

/// Remark on a comparison with a law without coefficients: for such a law the source acts as the
/// prior of the fit only.
fn without_coefficients(input: &RefinementInput<'_>) -> String {
    let source = &input.refinement.source;
    let who = match source == TRIALS_ALONE {
        true => "No ship served as the source".to_owned(),
        false => format!(
            "The accelerations of {source} are the prior, not the basis of the \
                          comparison"
        ),
    };
    format!(
        " {who}: the errors are compared with those of the law without coefficients, which does \
         not respond to the rudder, so these factors do not show the gain over the model of a \
         similar ship."
    )
}

/// Result of the refinement, as a sentence.
fn verdict_sentence(input: &RefinementInput<'_>, errors: &HeldOutErrors<'_>) -> String {
    if input.refinement.is_source_kept() {
        return "No refinement was better than the source on held-out manoeuvres: the source model \
                is kept unchanged.".into();
    }
    let phrases: Vec<String> = ["fell", "rose", "unchanged"]
        .into_iter()
        .filter_map(|word| change_phrase(errors, word))
        .collect();
    let place = if errors.on_fitted_trial {
        "On the fitted trial (no trial could be held out)"
    } else {
        "On held-out manoeuvres"
    };
    if phrases.is_empty() {
        return format!("{place}, the error is unknown.");
    }
    let compared =
        if has_no_coefficients(input) { without_coefficients(input) } else { String::new() };
    format!("{place}, the error {}.{compared}", phrases.join("; it "))
}

/// True if the model before the fit is a law without coefficients.
fn has_no_coefficients(input: &RefinementInput<'_>) -> bool {
    input.refinement.transferred.coefficients.values().all(|coefficient| coefficient.value == 0.0)
}

/// Phrase of the channels with one kind of change: `fell by a factor of 4.2 in surge speed and 1.3
/// in heading`.
fn change_phrase(errors: &HeldOutErrors<'_>, word: &str) -> Option<String> {
    let rows: Vec<&ErrorRow> =
        errors.headline_rows().filter(|row| row.error_change().0 == word).collect();
    let named = |row: &&ErrorRow| match row.error_change() {
        ("unchanged", _) => row.quantity.name.to_owned(),
        (_, factor) => format!("{} in {}", format_factor(factor), row.quantity.name),
    };
    let words = join_words(&rows.iter().map(named).collect::<Vec<_>>());
    match word {
        _ if rows.is_empty() => None,
        "unchanged" => Some(format!("is unchanged in {words}")),
        _ => Some(format!("{word} by a factor of {words}")),
    }
}

/// Estimator in words.
pub(crate) fn method_text(headline: &ReportHeadline<'_>) -> String {
    match words::method_words(headline.method) {
        "" => headline.method.to_owned(),
        text => format!("{}: {text}", headline.method),
    }
}
