//! HTML page: sentence, tables and plots for the template.

use std::collections::BTreeMap;

use askama::Template;
use sistership_diagnosis::{MissingEffect, ResidualSeries, UnexplainedSegment};

use super::input::DiagnosisInput;
use super::{changes, errors, evidence, limits, provenance, remaining, sentence, summary};
use crate::numbers::{format_fixed, format_significant, format_stated, join_words};
use crate::plots::{self, LiveChart, SvgPlot};
use crate::rendered::ReportError;
use crate::replayed::ReplayedTrial;
use crate::tables::ReportTable;
use crate::tile::ErrorTile;
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
    tiles: Vec<ErrorTile>,
    hypotheses: ReportTable,
    limits: ReportTable,
    odds: ReportTable,
    further: ReportTable,
    effects: Vec<EffectSection<'a>>,
    next_trial: Option<String>,
    errors: ReportTable,
    by_trial: ReportTable,
    manoeuvres: ReportTable,
    trials: Vec<DiagnosisTrialPlots<'a>>,
    scatters: Vec<SvgPlot>,
    unexplained: ReportTable,
    changes: Vec<String>,
    origin: Option<String>,
    dependences: Vec<String>,
    curves: Vec<SvgPlot>,
    discrepancies: ReportTable,
    coefficients: Option<ReportTable>,
    provenance: Vec<(&'static str, String)>,
    given: ReportTable,
    settings: ReportTable,
}

/// Effect that was found.
struct EffectSection<'a> {
    found: &'a MissingEffect,
    sentence: String,
    acts_on: &'static str,
    evidence: String,
    parameters: ReportTable,
    confounded: ReportTable,
}

/// Plots of one trial.
struct DiagnosisTrialPlots<'a> {
    replayed: &'a ReplayedTrial<'a>,
    caption: String,
    chart: LiveChart,
    residual: Option<LiveChart>,
}

/// Renders the page.
pub(crate) fn render_page(
    input: &DiagnosisInput<'_>,
    replayed: &[ReplayedTrial<'_>],
) -> Result<String, ReportError> {
    let diagnosis = input.diagnosis;
    let (hypotheses, further) = evidence::hypothesis_tables(diagnosis);
    let [sentence, advice, open] = summary::summary_sentences(diagnosis);
    let page = DiagnosisPage {
        input,
        sentence,
        advice: [advice, open],
        limits: limits::limit_table(diagnosis),
        odds: limits::odds_table(diagnosis),
        tiles: headline_tiles(input),
        hypotheses,
        further,
        effects: diagnosis.effects.iter().map(EffectSection::from_found).collect(),
        next_trial: diagnosis.next_trial.as_ref().map(evidence::next_trial_instruction),
        errors: errors::channel_table(diagnosis),
        by_trial: errors::trial_table(&diagnosis.trials),
        manoeuvres: errors::manoeuvre_table(&diagnosis.manoeuvres),
        trials: replayed
            .iter()
            .map(|replayed| DiagnosisTrialPlots::from_replay(input, replayed))
            .collect(),
        scatters: plots::scatter_plots(&diagnosis.residuals),
        unexplained: remaining::unexplained_table(&diagnosis.unexplained),
        changes: changes::change_sentences(&diagnosis.changes),
        origin: remaining::origin_sentence(&diagnosis.origins),
        dependences: remaining::dependence_sentences(&diagnosis.depends_on),
        curves: plots::dependence_plots(&diagnosis.depends_on),
        discrepancies: remaining::discrepancy_table(&diagnosis.discrepancies),
        coefficients: diagnosis
            .model
            .as_ref()
            .and_then(|after| remaining::coefficient_table(input.model, after)),
        provenance: provenance::model_facts(input.model),
        given: provenance::trial_table(input.trials),
        settings: remaining::settings_table(&diagnosis.settings),
    };
    Ok(page.render()?)
}

/// Headline figures; none if no effect was found.
fn headline_tiles(input: &DiagnosisInput<'_>) -> Vec<ErrorTile> {
    if input.diagnosis.effects.is_empty() {
        return Vec::new();
    }
    let rows = errors::error_rows(input.diagnosis);
    rows.iter()
        .filter(|row| ["u", "v", "r", "psi", "position"].contains(&row.quantity.channel))
        .map(ErrorTile::from_row)
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
        format_stated(*value, 3)
    }
}

impl<'a> EffectSection<'a> {
    fn from_found(found: &'a MissingEffect) -> Self {
        Self {
            sentence: sentence::effect_text(found),
            acts_on: evidence::point_of_action(found.acts_on),
            evidence: format_fixed(found.evidence, 1),
            parameters: evidence::parameter_table(found),
            confounded: evidence::confounded_table(found),
            found,
        }
    }
}

impl<'a> DiagnosisTrialPlots<'a> {
    fn from_replay(input: &DiagnosisInput<'_>, replayed: &'a ReplayedTrial<'a>) -> Self {
        let name = &replayed.trial.name;
        // Only the residuals and segments of this trial.
        let own: Vec<&ResidualSeries> =
            input.diagnosis.residuals.iter().filter(|series| series.trial == *name).collect();
        let stretches: Vec<&UnexplainedSegment> =
            input.diagnosis.unexplained.iter().filter(|stretch| stretch.trial == *name).collect();
        Self {
            caption: plot_caption(replayed),
            chart: plots::replay_chart(replayed, ["measured", "model before", "model after"]),
            residual: (!own.is_empty()).then(|| plots::residual_chart(name, &own, &stretches)),
            replayed,
        }
    }
}

/// Caption of the plots of a trial, with the errors of both models.
fn plot_caption(replayed: &ReplayedTrial<'_>) -> String {
    let shown = &replayed.shown;
    let error = |quantity: &words::DisplayChannel| {
        let of = |errors: &BTreeMap<String, f64>| {
            Some(format_significant(errors.get(quantity.channel)? * quantity.factor, 3))
        };
        Some(format!(
            "{} {} → {} {}",
            quantity.name,
            of(&shown.source)?,
            of(&shown.refined)?,
            quantity.unit
        ))
    };
    let wanted = |quantity: &&words::DisplayChannel| {
        ["u", "v", "r", "psi", "x", "y"].contains(&quantity.channel)
    };
    let errors: Vec<String> = words::CHANNELS.iter().filter(wanted).filter_map(error).collect();
    let dots = format_stated(plots::mark_interval_s(shown.duration_s), 3);
    format!(
        "Outlines of the ship (dots where they would be too small to see) every {dots} s. RMS \
         error over the whole simulation, before → after: {}.",
        join_words(&errors)
    )
}
