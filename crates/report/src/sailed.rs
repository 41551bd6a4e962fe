//! Manoeuvres that were sailed at sea, beside what both models make of the recorded rudder.

use serde::Serialize;
use sistership_dynamics::metrics::ManoeuvreMetrics;
use sistership_estimate::refine::MeasuredManoeuvre;

use super::Input;
use super::manoeuvres::{TURN, ZIGZAG};

/// One figure of one trial.
#[derive(Debug, Serialize)]
pub(super) struct Sailed {
    /// The trial, and whether the fit has seen it.
    pub trial: String,
    pub figure: &'static str,
    pub unit: &'static str,
    pub measured: Option<f64>,
    pub source: Option<f64>,
    pub refined: Option<f64>,
}

/// Every figure of every manoeuvre that was recognised.
pub(super) fn figures(input: &Input<'_>) -> Vec<Sailed> {
    input.refinement.manoeuvres.measured.iter().flat_map(of_manoeuvre).collect()
}

fn of_manoeuvre(manoeuvre: &MeasuredManoeuvre) -> Vec<Sailed> {
    let seen = if manoeuvre.fitted { "fitted" } else { "kept out of the fit" };
    let trial = format!("{}, {seen}", manoeuvre.trial);
    let measured = read(&manoeuvre.measured);
    let of = |metrics: &Option<ManoeuvreMetrics>| metrics.as_ref().map(read).unwrap_or_default();
    let (source, refined) = (of(&manoeuvre.source), of(&manoeuvre.refined));
    let value = |all: &[Figure], index: usize| all.get(index).and_then(|figure| figure.2);
    let one = |(index, &(figure, unit, measured)): (usize, &Figure)| Sailed {
        trial: trial.clone(),
        figure,
        unit,
        measured,
        source: value(&source, index),
        refined: value(&refined, index),
    };
    // With the recorded rudder both models have the period of the record.
    let known = |sailed: &Sailed| sailed.measured.is_some() && sailed.figure != "period";
    measured.iter().enumerate().map(one).filter(known).collect()
}

/// Name, unit, value.
pub(super) type Figure = (&'static str, &'static str, Option<f64>);

/// The figures of a manoeuvre.
pub(super) fn read(metrics: &ManoeuvreMetrics) -> Vec<Figure> {
    match metrics {
        ManoeuvreMetrics::Turn(turn) => TURN.iter().map(|(name, read)| (*name, "m", read(turn))).collect(),
        ManoeuvreMetrics::Zigzag(zigzag) => ZIGZAG.iter().map(|(name, unit, read)| (*name, *unit, read(zigzag))).collect(),
    }
}
