//! HTML page: content, tables and plots for the template.

use askama::Template;
use sistership_model::source::Source;
use sistership_model::vessel::Status;
use sistership_model_selection::SelectionReport;

use super::acceptance::AcceptanceSummary;
use super::coefficients::CoefficientReport;
use super::content::RefinementContent;
use super::input::RefinementInput;
use super::summary::method_text;
use super::{coefficient_shifts, further, selection_table, similarity, tables};
use crate::numbers::{format_significant, format_stated, join_words};
use crate::plots::{self, LiveChart, SvgPlot};
use crate::rendered::ReportError;
use crate::replayed::{ReplaySummary, ReplayedTrial};
use crate::tables::ReportTable;
use crate::tile::ErrorTile;
use crate::words;

/// Page as the template takes it.
#[derive(Template)]
#[template(path = "report.html")]
struct RefinementPage<'a> {
    content: &'a RefinementContent<'a>,
    acceptance: AcceptanceSummary,
    method: String,
    tiles: Vec<ErrorTile>,
    errors: ReportTable,
    trials: Vec<RefinementTrialPlots<'a>>,
    moved: Vec<(&'static str, SvgPlot)>,
    coefficients: ReportTable,
    groups: Vec<String>,
    condition: String,
    options: ReportTable,
    turns: ReportTable,
    zigzags: ReportTable,
    imo: ReportTable,
    /// Stopping, pull-outs and spirals, if the ship's length is known.
    further: Option<ReportTable>,
    further_remarks: Vec<String>,
    sailed: ReportTable,
    why: Option<SourceChoice>,
    ladder: Option<ReportTable>,
    /// Error of the most similar ship, refined with the l2 prior.
    reference: Option<String>,
    /// Reason why a learned correction was selected or not.
    branch: Option<&'a str>,
    /// Warning that the trials leave wide uncertainty bands.
    wide: Option<String>,
    particulars: ReportTable,
    parameters: ReportTable,
    settings: ReportTable,
    steering: String,
    sources: Vec<(&'static str, Vec<CitedSource<'a>>)>,
}

/// Plots of one trial.
struct RefinementTrialPlots<'a> {
    shown: &'a ReplaySummary<'a>,
    caption: String,
    chart: LiveChart,
}

/// Reasons for the choice of the source.
struct SourceChoice {
    definition: &'static str,
    vector: String,
    remark: Option<String>,
    table: ReportTable,
}

/// Publication with its key.
struct CitedSource<'a> {
    key: &'a str,
    source: &'a Source,
}

/// Renders the page.
pub(crate) fn render_page(
    input: &RefinementInput<'_>,
    content: &RefinementContent<'_>,
    replayed: &[ReplayedTrial<'_>],
) -> Result<String, ReportError> {
    let provenance = &content.provenance;
    let lpp_m = content.manoeuvres.lpp_m;
    let page = RefinementPage {
        content,
        acceptance: AcceptanceSummary::from_input(input, content),
        method: method_text(&content.headline),
        tiles: content.errors.headline_rows().map(ErrorTile::from_row).collect(),
        errors: tables::error_table(&content.errors),
        trials: content
            .replays
            .iter()
            .zip(replayed)
            .map(|(shown, replayed)| RefinementTrialPlots::from_replay(shown, replayed))
            .collect(),
        moved: coefficient_shifts::shift_plots(&content.coefficients),
        coefficients: tables::coefficient_table(&content.coefficients),
        groups: group_lines(&content.coefficients),
        condition: format_significant(provenance.condition_number, 2),
        options: tables::option_table(&content.options),
        turns: tables::turn_table(&content.manoeuvres),
        zigzags: tables::zigzag_table(&content.manoeuvres),
        imo: tables::criteria_table(&content.manoeuvres),
        further: lpp_m.map(|lpp_m| tables::further_table(&content.further, lpp_m)),
        further_remarks: lpp_m
            .map_or_else(Vec::new, |lpp_m| further::further_remarks(&content.further, lpp_m)),
        sailed: tables::measured_table(&content.sailed),
        why: source_choice(content),
        ladder: content.ladder.map(selection_table::selection_report_table),
        reference: content.ladder.map(SelectionReport::reference_summary),
        branch: content.ladder.and_then(|ladder| Some(ladder.branch.as_ref()?.reason.as_str())),
        wide: content.wide.clone(),
        particulars: tables::particulars_table(&provenance.particulars),
        parameters: tables::parameters_table(&provenance.parameters),
        settings: tables::settings_table(provenance.settings),
        steering: steering_text(content),
        sources: cited_sources(content),
    };
    Ok(page.render()?)
}

impl RefinementPage<'_> {
    fn badge(&self, status: &Status) -> &'static str {
        words::status_word(*status)
    }

    fn meaning(&self, status: &Status) -> &'static str {
        words::status_meaning(*status)
    }

    fn number(&self, value: &f64, digits: usize) -> String {
        format_stated(*value, digits)
    }
}

impl<'a> RefinementTrialPlots<'a> {
    fn from_replay(shown: &'a ReplaySummary<'a>, replayed: &ReplayedTrial<'_>) -> Self {
        Self {
            shown,
            caption: plot_caption(shown),
            chart: plots::replay_chart(replayed, ["measured", "source", "refined"]),
        }
    }
}

/// Caption of the plots of a trial, with the errors of both models.
fn plot_caption(shown: &ReplaySummary<'_>) -> String {
    let error = |quantity: &words::DisplayChannel| {
        let of = |errors: &std::collections::BTreeMap<String, f64>| {
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
    let wanted =
        |quantity: &&words::DisplayChannel| ["r", "psi", "x", "y"].contains(&quantity.channel);
    let errors: Vec<String> = words::CHANNELS.iter().filter(wanted).filter_map(error).collect();
    let dots = format_stated(plots::mark_interval_s(shown.duration_s), 3);
    let part = if shown.fitted { "was fitted to" } else { "was not fitted to" };
    format!(
        "Outlines of the ship (dots where they would be too small to see) every {dots} s. The \
         refined model {part} this trial. RMS error over the whole simulation, source → refined: \
         {}.",
        join_words(&errors)
    )
}

/// One line for each collinear group.
fn group_lines(coefficients: &CoefficientReport<'_>) -> Vec<String> {
    coefficients
        .collinear_groups
        .iter()
        .map(|group| group.join(", ").replace('/', " and "))
        .collect()
}

/// Choice of the source; `None` if the source was named without a ranking.
fn source_choice(content: &RefinementContent<'_>) -> Option<SourceChoice> {
    content.similarity.map(|ranking| SourceChoice {
        definition: similarity::definition_source(ranking.definition),
        vector: similarity::vector_text(ranking),
        // The remark on a named source does not apply to a selection among candidates.
        remark: match content.ladder {
            Some(_) => None,
            None => similarity::source_remark(ranking, content.headline.source),
        },
        table: similarity::ranking_table(ranking, content.headline.source),
    })
}

fn steering_text(content: &RefinementContent<'_>) -> String {
    let gear = content.provenance.steering;
    let source = gear.source.as_deref().unwrap_or("default of SOLAS II-1/29");
    let figures = [gear.limit_deg, gear.rate_deg_s, gear.time_constant_s]
        .map(|value| format_stated(value, 3));
    format!(
        "rudder to {} deg, at most {} deg/s, time constant {} s ({source})",
        figures[0], figures[1], figures[2]
    )
}

fn cited_sources<'a>(
    content: &'a RefinementContent<'a>,
) -> Vec<(&'static str, Vec<CitedSource<'a>>)> {
    let provenance = &content.provenance;
    let lists = [
        ("of the ship", provenance.ship_sources),
        ("of the source model", provenance.model_sources),
        ("of the law", provenance.law_sources),
    ];
    let cited = lists.map(|(of, sources)| {
        (of, sources.iter().map(|(key, source)| CitedSource { key, source }).collect::<Vec<_>>())
    });
    cited.into_iter().filter(|(_, citations)| !citations.is_empty()).collect()
}
