//! Standard manoeuvres and IMO criteria before and after.

use serde::Serialize;
use std::collections::BTreeMap;

use sistership_assessment::uncertainty::UncertaintyBands;
use sistership_model::validity::Excursion;
use sistership_simulation::metrics::{ImoCriterion, TurningMetrics, ZigzagMetrics};

use super::input::RefinementInput;
use crate::metrics::{TURN, ZIGZAG};

/// Values of one figure by both models.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub(crate) struct FigurePair {
    pub source: Option<f64>,
    pub refined: Option<f64>,
}

/// One figure of one manoeuvre.
#[derive(Debug, Serialize)]
pub(crate) struct ManoeuvreFigure {
    pub manoeuvre: String,
    pub figure: &'static str,
    pub unit: &'static str,
    #[serde(flatten)]
    pub pair: FigurePair,
    /// Interval of 95 % of the models drawn from the refined one's posterior.
    pub band: Option<[f64; 2]>,
}

/// Comparison of one IMO criterion.
#[derive(Debug, Serialize)]
pub(crate) struct CriterionComparison<'a> {
    pub criterion: &'a str,
    pub limit: f64,
    pub unit: &'a str,
    pub source: Option<f64>,
    pub source_pass: Option<bool>,
    pub refined: Option<f64>,
    pub refined_pass: Option<bool>,
    /// Interval of 95 % of the models drawn from the refined one's posterior.
    pub band: Option<[f64; 2]>,
    /// Share of these models that meet the criterion.
    pub pass_share: Option<f64>,
}

/// Comparison of all manoeuvres and criteria.
#[derive(Debug, Serialize)]
pub(crate) struct ManoeuvreComparison<'a> {
    pub lpp_m: Option<f64>,
    pub speed_m_s: Option<f64>,
    pub turns: Vec<ManoeuvreFigure>,
    pub zigzags: Vec<ManoeuvreFigure>,
    pub imo: Vec<CriterionComparison<'a>>,
    pub source_failures: &'a [String],
    pub refined_failures: &'a [String],
    /// Manoeuvres in which the refined model leaves the range covered by trials.
    pub outside: &'a BTreeMap<String, Excursion>,
    /// Trial that would reduce the uncertainty most.
    pub next_trial: Option<String>,
}

impl<'a> ManoeuvreComparison<'a> {
    pub fn from_input(input: &RefinementInput<'a>) -> Self {
        let both = &input.refinement.manoeuvres;
        let (source, refined, bands) = (&both.source, &both.refined, both.bands.as_ref());
        Self {
            lpp_m: input.vessel.particular("lpp_m"),
            speed_m_s: input.refinement.model.speed_m_s,
            turns: turn_figures(&source.turns, &refined.turns, bands),
            zigzags: zigzag_figures(&source.zigzags, &refined.zigzags, bands),
            imo: compare_criteria(&source.imo, &refined.imo, bands),
            source_failures: &source.failures,
            refined_failures: &refined.failures,
            outside: &refined.outside,
            next_trial: bands.and_then(|bands| Some(bands.next_trial.as_ref()?.as_sentence())),
        }
    }
}

/// Pairs of equal items of both lists, in the order of the first; an item that is only in one list
/// has no partner.
fn match_pairs<'t, T>(
    source: &'t [T],
    refined: &'t [T],
    same: impl Fn(&T, &T) -> bool,
) -> Vec<(Option<&'t T>, Option<&'t T>)> {
    let mut pairs: Vec<_> = source
        .iter()
        .map(|one| (Some(one), refined.iter().find(|other| same(one, other))))
        .collect();
    // Items that only the refined model has come last.
    let alone = refined.iter().filter(|other| !source.iter().any(|one| same(one, other)));
    pairs.extend(alone.map(|other| (None, Some(other))));
    pairs
}

/// Limits of the uncertainty band of a figure.
fn band_limits(bands: Option<&UncertaintyBands>, name: &str) -> Option<[f64; 2]> {
    bands?.figure_band(name).map(|band| [band.low, band.high])
}

/// Figures of the turning circles, paired by rudder angle.
fn turn_figures(
    source: &[TurningMetrics],
    refined: &[TurningMetrics],
    bands: Option<&UncertaintyBands>,
) -> Vec<ManoeuvreFigure> {
    let mut figures = Vec::new();
    for (before, after) in match_pairs(source, refined, |a, b| a.rudder_deg == b.rudder_deg) {
        let rudder = before.or(after).map_or(0.0, |turn| turn.rudder_deg);
        let manoeuvre = format!("turn, {} deg to {}", rudder.abs(), turn_side(rudder));
        for (figure, read) in TURN {
            let pair = FigurePair { source: before.and_then(read), refined: after.and_then(read) };
            // The key is the name under which the bands store a figure.
            let band = band_limits(bands, &format!("turn {rudder} deg: {figure}"));
            figures.push(ManoeuvreFigure {
                manoeuvre: manoeuvre.clone(),
                figure,
                unit: "m",
                pair,
                band,
            });
        }
    }
    figures
}

/// Figures of the zigzags, paired by rudder and switching angle.
fn zigzag_figures(
    source: &[ZigzagMetrics],
    refined: &[ZigzagMetrics],
    bands: Option<&UncertaintyBands>,
) -> Vec<ManoeuvreFigure> {
    let same = |a: &ZigzagMetrics, b: &ZigzagMetrics| {
        a.rudder_deg == b.rudder_deg && a.switch_deg == b.switch_deg
    };
    let mut figures = Vec::new();
    for (before, after) in match_pairs(source, refined, same) {
        let Some(one) = before.or(after) else { continue };
        let manoeuvre = format!(
            "zigzag {}/{}, first to {}",
            one.rudder_deg.abs(),
            one.switch_deg,
            turn_side(one.rudder_deg)
        );
        for (figure, unit, read) in ZIGZAG {
            let pair = FigurePair { source: before.and_then(read), refined: after.and_then(read) };
            let band = band_limits(
                bands,
                &format!("zigzag {}/{}: {figure}", one.rudder_deg, one.switch_deg),
            );
            figures.push(ManoeuvreFigure {
                manoeuvre: manoeuvre.clone(),
                figure,
                unit,
                pair,
                band,
            });
        }
    }
    figures
}

fn compare_criteria<'a>(
    source: &'a [ImoCriterion],
    refined: &'a [ImoCriterion],
    bands: Option<&UncertaintyBands>,
) -> Vec<CriterionComparison<'a>> {
    let pairs = match_pairs(source, refined, |a, b| a.criterion == b.criterion);
    let one = |(before, after): (Option<&'a ImoCriterion>, Option<&'a ImoCriterion>)| {
        // Name and limit are the same on both sides.
        let any = after.or(before)?;
        let drawn = bands.and_then(|bands| bands.figure_band(&format!("IMO: {}", any.criterion)));
        Some(CriterionComparison {
            criterion: &any.criterion,
            limit: any.limit,
            unit: &any.unit,
            source: before.and_then(|criterion| criterion.value),
            source_pass: before.and_then(|criterion| criterion.pass),
            refined: after.and_then(|criterion| criterion.value),
            refined_pass: after.and_then(|criterion| criterion.pass),
            band: drawn.map(|band| [band.low, band.high]),
            pass_share: drawn.and_then(|band| band.pass),
        })
    };
    pairs.into_iter().filter_map(one).collect()
}

fn turn_side(rudder_deg: f64) -> &'static str {
    if rudder_deg < 0.0 { "port" } else { "starboard" }
}
