//! Measured manoeuvres, and their simulation by both models with the recorded rudder.

use serde::Serialize;
use sistership_identification::refine::MeasuredManoeuvre;
use sistership_simulation::metrics::ManoeuvreMetrics;

use super::input::RefinementInput;
use crate::metrics::{MetricValue, manoeuvre_figures};

/// One figure of one trial.
#[derive(Debug, Serialize)]
pub(crate) struct MeasuredFigure {
    /// Name of the trial, with the remark fitted or held out.
    pub trial: String,
    pub figure: &'static str,
    pub unit: &'static str,
    pub measured: Option<f64>,
    pub source: Option<f64>,
    pub refined: Option<f64>,
}

/// Returns the figures of every recognised manoeuvre.
pub(crate) fn collect_figures(input: &RefinementInput<'_>) -> Vec<MeasuredFigure> {
    input.refinement.manoeuvres.measured.iter().flat_map(compared_figures).collect()
}

fn compared_figures(manoeuvre: &MeasuredManoeuvre) -> Vec<MeasuredFigure> {
    let seen = if manoeuvre.fitted { "fitted" } else { "held out of the fit" };
    let trial = format!("{}, {seen}", manoeuvre.trial);
    let measured = manoeuvre_figures(&manoeuvre.measured);
    let of = |metrics: &Option<ManoeuvreMetrics>| {
        metrics.as_ref().map(manoeuvre_figures).unwrap_or_default()
    };
    let (source, refined) = (of(&manoeuvre.source), of(&manoeuvre.refined));
    // A model that did not complete the manoeuvre has no figures.
    let value = |all: &[MetricValue], index: usize| all.get(index).and_then(|figure| figure.2);
    let one = |(index, &(figure, unit, measured)): (usize, &MetricValue)| MeasuredFigure {
        trial: trial.clone(),
        figure,
        unit,
        measured,
        source: value(&source, index),
        refined: value(&refined, index),
    };
    // With the recorded rudder both models have the period of the record.
    let known = |sailed: &MeasuredFigure| sailed.measured.is_some() && sailed.figure != "period";
    measured.iter().enumerate().map(one).filter(known).collect()
}
