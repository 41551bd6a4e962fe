//! HTML page: sentence, tables and plots for the template.

use std::collections::BTreeMap;

use askama::Template;
use sistership_diagnosis::{Found, ResidualSeries, Unexplained};

use super::input::DiagnosisInput;
use super::{changes, errors, evidence, limits, provenance, remaining, sentence, summary};
use crate::numbers::{fixed, list, significant, stated};
use crate::plots::{self, Plot};
use crate::rendered::ReportError;
use crate::replayed::ReplayedTrial;
use crate::tables::Table;
use crate::tile::Tile;
use crate::words;
use sistership_model::version::code_revision;

/// Page as the template takes it.
#[derive(Template)]
#[template(path = "report_diagnosis.html")]
struct DiagnosisPage<'a> {
    input: &'a DiagnosisInput<'a>,
    sentence: String,
    /// Recommended action, and effects that could not be detected.
    advice: [String; 2],
    tiles: Vec<Tile>,
    hypotheses: Table,
    limits: Table,
    odds: Table,
    further: Table,
    effects: Vec<ShownEffect<'a>>,
    next_trial: Option<String>,
    errors: Table,
    by_trial: Table,
    manoeuvres: Table,
    trials: Vec<DiagnosisTrialPlots<'a>>,
    scatters: Vec<Plot>,
    unexplained: Table,
    changes: Vec<String>,
    origin: Option<String>,
    dependences: Vec<String>,
    curves: Vec<Plot>,
    discrepancies: Table,
    coefficients: Option<Table>,
    provenance: Vec<(&'static str, String)>,
    given: Table,
    settings: Table,
}

/// Effect that was found.
struct ShownEffect<'a> {
    found: &'a Found,
    sentence: String,
    acts_on: &'static str,
    evidence: String,
    parameters: Table,
    confounded: Table,
}

/// Plots of one trial.
struct DiagnosisTrialPlots<'a> {
    replayed: &'a ReplayedTrial<'a>,
    caption: String,
    trajectory: Plot,
    series: Plot,
    residual: Option<Plot>,
}

/// Renders the page.
pub(crate) fn page(
    input: &DiagnosisInput<'_>,
    replayed: &[ReplayedTrial<'_>],
) -> Result<String, ReportError> {
    let diagnosis = input.diagnosis;
    let (hypotheses, further) = evidence::hypotheses(diagnosis);
    let [sentence, advice, open] = summary::summary(diagnosis);
    let page = DiagnosisPage {
        input,
        sentence,
        advice: [advice, open],
        limits: limits::limits(diagnosis),
        odds: limits::odds(diagnosis),
        tiles: tiles(input),
        hypotheses,
        further,
        effects: diagnosis.effects.iter().map(ShownEffect::of).collect(),
        next_trial: diagnosis.next_trial.as_ref().map(evidence::next_trial),
        errors: errors::by_channel(diagnosis),
        by_trial: errors::by_trial(&diagnosis.trials),
        manoeuvres: errors::manoeuvres(&diagnosis.manoeuvres),
        trials: replayed.iter().map(|replayed| DiagnosisTrialPlots::of(input, replayed)).collect(),
        scatters: plots::scatters(&diagnosis.residuals),
        unexplained: remaining::unexplained(&diagnosis.unexplained),
        changes: changes::changes(&diagnosis.changes),
        origin: remaining::origin(&diagnosis.origins),
        dependences: remaining::dependences(&diagnosis.depends_on),
        curves: plots::dependences(&diagnosis.depends_on),
        discrepancies: remaining::discrepancies(&diagnosis.discrepancies),
        coefficients: diagnosis
            .model
            .as_ref()
            .and_then(|after| remaining::coefficients(input.model, after)),
        provenance: provenance::model(input.model),
        given: provenance::trials(input.trials),
        settings: remaining::settings(&diagnosis.settings),
    };
    Ok(page.render()?)
}

/// Headline figures; none if no effect was found.
fn tiles(input: &DiagnosisInput<'_>) -> Vec<Tile> {
    if input.diagnosis.effects.is_empty() {
        return Vec::new();
    }
    let rows = errors::rows(input.diagnosis);
    rows.iter()
        .filter(|row| ["u", "v", "r", "psi", "position"].contains(&row.quantity.channel))
        .map(Tile::of)
        .collect()
}

impl DiagnosisPage<'_> {
    fn found(&self) -> bool {
        !self.input.diagnosis.effects.is_empty()
    }

    fn badge(&self) -> (&'static str, &'static str) {
        use sistership_diagnosis::Verdict;
        match self.input.diagnosis.verdict {
            Verdict::Complete => ("published", "the model holds"),
            Verdict::Effects => ("transferred", "effects are missing"),
            Verdict::Unexplained => ("estimated", "something is unexplained"),
        }
    }

    fn revision(&self) -> &'static str {
        code_revision()
    }

    fn number(&self, value: &f64) -> String {
        stated(*value, 3)
    }
}

impl<'a> ShownEffect<'a> {
    fn of(found: &'a Found) -> Self {
        Self {
            sentence: sentence::effect(found),
            acts_on: evidence::acts_on(found.acts_on),
            evidence: fixed(found.evidence, 1),
            parameters: evidence::parameters(found),
            confounded: evidence::confounded(found),
            found,
        }
    }
}

impl<'a> DiagnosisTrialPlots<'a> {
    fn of(input: &DiagnosisInput<'_>, replayed: &'a ReplayedTrial<'a>) -> Self {
        let name = &replayed.trial.name;
        // Only the residuals and segments of this trial.
        let own: Vec<&ResidualSeries> =
            input.diagnosis.residuals.iter().filter(|series| series.trial == *name).collect();
        let stretches: Vec<&Unexplained> =
            input.diagnosis.unexplained.iter().filter(|stretch| stretch.trial == *name).collect();
        Self {
            caption: caption(replayed),
            trajectory: plots::trajectory(replayed),
            series: plots::series(replayed),
            residual: (!own.is_empty()).then(|| plots::residual(name, &own, &stretches)),
            replayed,
        }
    }
}

/// Caption of the plots of a trial, with the errors of both models.
fn caption(replayed: &ReplayedTrial<'_>) -> String {
    let shown = &replayed.shown;
    let error = |quantity: &words::ShownChannel| {
        let of = |errors: &BTreeMap<String, f64>| {
            Some(significant(errors.get(quantity.channel)? * quantity.factor, 3))
        };
        Some(format!(
            "{} {} → {} {}",
            quantity.name,
            of(&shown.source)?,
            of(&shown.refined)?,
            quantity.unit
        ))
    };
    let wanted = |quantity: &&words::ShownChannel| {
        ["u", "v", "r", "psi", "x", "y"].contains(&quantity.channel)
    };
    let errors: Vec<String> = words::CHANNELS.iter().filter(wanted).filter_map(error).collect();
    let dots = stated(plots::mark_interval_s(shown.duration_s), 3);
    format!(
        "Outlines of the ship (dots where they would be too small to see) every {dots} s. RMS \
         error over the whole run, before → after: {}.",
        list(&errors)
    )
}
