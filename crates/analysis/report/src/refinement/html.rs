//! HTML page: content, tables and plots for the template.

use askama::Template;
use sistership_model::source::Source;
use sistership_model::vessel::Status;
use sistership_model_selection::Ladder;

use super::coefficients::Coefficients;
use super::content::RefinementContent;
use super::summary::method_text;
use super::{further, ladder, moved, similarity, tables};
use crate::numbers::{list, significant, stated};
use crate::plots::{self, Plot};
use crate::rendered::ReportError;
use crate::replayed::{ReplaySummary, ReplayedTrial};
use crate::tables::Table;
use crate::tile::Tile;
use crate::words;

/// Page as the template takes it.
#[derive(Template)]
#[template(path = "report.html")]
struct RefinementPage<'a> {
    content: &'a RefinementContent<'a>,
    method: String,
    tiles: Vec<Tile>,
    errors: Table,
    trials: Vec<RefinementTrialPlots<'a>>,
    moved: Vec<(&'static str, Plot)>,
    coefficients: Table,
    groups: Vec<String>,
    condition: String,
    options: Table,
    turns: Table,
    zigzags: Table,
    imo: Table,
    /// Stopping, pull-outs and spirals, if the ship's length is known.
    further: Option<Table>,
    further_remarks: Vec<String>,
    sailed: Table,
    why: Option<SourceChoice>,
    ladder: Option<Table>,
    /// Error of the most similar ship, refined with the l2 prior.
    reference: Option<String>,
    /// Reason why a learned correction was selected or not.
    branch: Option<&'a str>,
    /// Warning that the trials leave wide uncertainty bands.
    wide: Option<String>,
    particulars: Table,
    parameters: Table,
    settings: Table,
    steering: String,
    sources: Vec<(&'static str, Vec<Citation<'a>>)>,
}

/// Plots of one trial.
struct RefinementTrialPlots<'a> {
    shown: &'a ReplaySummary<'a>,
    caption: String,
    trajectory: Plot,
    series: Plot,
}

/// Reasons for the choice of the source.
struct SourceChoice {
    definition: &'static str,
    vector: String,
    remark: Option<String>,
    table: Table,
}

/// Publication with its key.
struct Citation<'a> {
    key: &'a str,
    source: &'a Source,
}

/// Renders the page.
pub(crate) fn page(
    content: &RefinementContent<'_>,
    replayed: &[ReplayedTrial<'_>],
) -> Result<String, ReportError> {
    let provenance = &content.provenance;
    let lpp_m = content.manoeuvres.lpp_m;
    let page = RefinementPage {
        content,
        method: method_text(&content.headline),
        tiles: content.errors.headline().map(Tile::of).collect(),
        errors: tables::errors(&content.errors),
        trials: content
            .replays
            .iter()
            .zip(replayed)
            .map(|(shown, replayed)| RefinementTrialPlots::of(shown, replayed))
            .collect(),
        moved: moved::moved(&content.coefficients),
        coefficients: tables::coefficients(&content.coefficients),
        groups: groups(&content.coefficients),
        condition: significant(provenance.condition_number, 2),
        options: tables::options(&content.options),
        turns: tables::turns(&content.manoeuvres),
        zigzags: tables::zigzags(&content.manoeuvres),
        imo: tables::imo(&content.manoeuvres),
        further: lpp_m.map(|lpp_m| tables::further(&content.further, lpp_m)),
        further_remarks: lpp_m
            .map_or_else(Vec::new, |lpp_m| further::remarks(&content.further, lpp_m)),
        sailed: tables::sailed(&content.sailed),
        why: why(content),
        ladder: content.ladder.map(ladder::table),
        reference: content.ladder.map(Ladder::reference),
        branch: content.ladder.and_then(|ladder| Some(ladder.branch.as_ref()?.reason.as_str())),
        wide: content.wide.clone(),
        particulars: tables::particulars(&provenance.particulars),
        parameters: tables::parameters(&provenance.parameters),
        settings: tables::settings(provenance.settings),
        steering: steering(content),
        sources: sources(content),
    };
    Ok(page.render()?)
}

impl RefinementPage<'_> {
    fn badge(&self, status: &Status) -> &'static str {
        words::status(*status)
    }

    fn meaning(&self, status: &Status) -> &'static str {
        words::status_meaning(*status)
    }

    fn number(&self, value: &f64, digits: usize) -> String {
        stated(*value, digits)
    }
}

impl<'a> RefinementTrialPlots<'a> {
    fn of(shown: &'a ReplaySummary<'a>, replayed: &ReplayedTrial<'_>) -> Self {
        Self {
            shown,
            caption: caption(shown),
            trajectory: plots::trajectory(replayed),
            series: plots::series(replayed),
        }
    }
}

/// Caption of the plots of a trial, with the errors of both models.
fn caption(shown: &ReplaySummary<'_>) -> String {
    let error = |quantity: &words::ShownChannel| {
        let of = |errors: &std::collections::BTreeMap<String, f64>| {
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
    let wanted =
        |quantity: &&words::ShownChannel| ["r", "psi", "x", "y"].contains(&quantity.channel);
    let errors: Vec<String> = words::CHANNELS.iter().filter(wanted).filter_map(error).collect();
    let dots = stated(plots::mark_interval_s(shown.duration_s), 3);
    let part = if shown.fitted { "was fitted with" } else { "has not seen" };
    format!(
        "Outlines of the ship (dots where they would be too small to see) every {dots} s. The \
         refined model {part} this trial. RMS error over the whole run, source → refined: {}.",
        list(&errors)
    )
}

/// One line for each collinear group.
fn groups(coefficients: &Coefficients<'_>) -> Vec<String> {
    coefficients
        .collinear_groups
        .iter()
        .map(|group| group.join(", ").replace('/', " and "))
        .collect()
}

/// Choice of the source; `None` if the source was named without a ranking.
fn why(content: &RefinementContent<'_>) -> Option<SourceChoice> {
    content.similarity.map(|ranking| SourceChoice {
        definition: similarity::definition(ranking.definition),
        vector: similarity::vector(ranking),
        // The remark on a named source does not apply to a selection among candidates.
        remark: match content.ladder {
            Some(_) => None,
            None => similarity::remark(ranking, content.headline.source),
        },
        table: similarity::table(ranking, content.headline.source),
    })
}

fn steering(content: &RefinementContent<'_>) -> String {
    let gear = content.provenance.steering;
    let source = gear.source.as_deref().unwrap_or("default of SOLAS II-1/29");
    let figures =
        [gear.limit_deg, gear.rate_deg_s, gear.time_constant_s].map(|value| stated(value, 3));
    format!(
        "rudder to {} deg, at most {} deg/s, time constant {} s ({source})",
        figures[0], figures[1], figures[2]
    )
}

fn sources<'a>(content: &'a RefinementContent<'a>) -> Vec<(&'static str, Vec<Citation<'a>>)> {
    let provenance = &content.provenance;
    let lists = [
        ("of the ship", provenance.ship_sources),
        ("of the source model", provenance.model_sources),
        ("of the law", provenance.law_sources),
    ];
    let cited = lists.map(|(of, sources)| {
        (of, sources.iter().map(|(key, source)| Citation { key, source }).collect::<Vec<_>>())
    });
    cited.into_iter().filter(|(_, citations)| !citations.is_empty()).collect()
}
