//! Metrics of a ship's champion: figures of the standard manoeuvres, the greater one of both sides.

use serde_json::Value;
use sistership_model::Zoo;
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{
    ManoeuvreSettings, StandardManoeuvres, simulate_standard_manoeuvres,
};
use sistership_simulation::metrics::{TurningMetrics, ZigzagMetrics};

use crate::version::VersionDocument;

type TurnFigure = fn(&TurningMetrics) -> Option<f64>;
type ZigzagFigure = fn(&ZigzagMetrics) -> Option<f64>;

const TURNS: [(&str, TurnFigure); 4] = [
    ("turn_35.advance_m", |turn| turn.advance_m),
    ("turn_35.transfer_m", |turn| turn.transfer_m),
    ("turn_35.tactical_diameter_m", |turn| turn.tactical_diameter_m),
    ("turn_35.steady_radius_m", |turn| turn.steady_radius_m),
];
const ZIGZAGS: [(&str, f64, ZigzagFigure); 6] = [
    ("zigzag_10.first_overshoot_deg", 10.0, |zigzag| zigzag.first_overshoot_deg),
    ("zigzag_10.second_overshoot_deg", 10.0, |zigzag| zigzag.second_overshoot_deg),
    ("zigzag_10.period_s", 10.0, |zigzag| zigzag.period_s),
    ("zigzag_20.first_overshoot_deg", 20.0, |zigzag| zigzag.first_overshoot_deg),
    ("zigzag_20.second_overshoot_deg", 20.0, |zigzag| zigzag.second_overshoot_deg),
    ("zigzag_20.period_s", 20.0, |zigzag| zigzag.period_s),
];
const INITIAL_TURNING: &str = "initial_turning_m";

/// Returns the names of all metrics.
pub(super) fn metric_names() -> impl Iterator<Item = &'static str> {
    TURNS
        .iter()
        .map(|(name, _)| *name)
        .chain(ZIGZAGS.iter().map(|(name, ..)| *name))
        .chain([INITIAL_TURNING])
}

/// Returns the metrics of a version, from its report if that has them, else by simulation. A figure
/// that a manoeuvre does not reach is left out.
pub(super) fn version_metrics(version: &VersionDocument, laws: &Zoo) -> Vec<(&'static str, f64)> {
    manoeuvres_from_report(&version.report)
        // A published model has no report; its manoeuvres are simulated once, when the index is
        // updated.
        .or_else(|| simulate_manoeuvres(version, laws))
        .map_or_else(Vec::new, |all| extract_metrics(&all))
}

fn manoeuvres_from_report(report: &Value) -> Option<StandardManoeuvres> {
    serde_json::from_value(report.get("manoeuvres")?.get("refined")?.clone()).ok()
}

fn simulate_manoeuvres(version: &VersionDocument, laws: &Zoo) -> Option<StandardManoeuvres> {
    let ship = Ship::new(&version.model, laws.law(&version.model.law)?).ok()?;
    Some(simulate_standard_manoeuvres(&ship, &ManoeuvreSettings::default()))
}

fn extract_metrics(all: &StandardManoeuvres) -> Vec<(&'static str, f64)> {
    let turns = TURNS.iter().map(|(name, of)| (*name, largest_value(all.turns.iter().map(of))));
    let zigzag = |angle: f64, of: ZigzagFigure| {
        // The angle is exact: it is one of the standard set.
        largest_value(all.zigzags.iter().filter(|zigzag| zigzag.switch_deg == angle).map(of))
    };
    let zigzags = ZIGZAGS.iter().map(|(name, angle, of)| (*name, zigzag(*angle, *of)));
    let found = turns.chain(zigzags).chain([(INITIAL_TURNING, all.initial_turning_m)]);
    found
        .filter_map(|(name, value)| Some((name, value.filter(|value| value.is_finite())?)))
        .collect()
}

/// Returns the largest value; `None` if one of them is unknown.
fn largest_value(values: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    let values: Option<Vec<f64>> = values.collect();
    values?.into_iter().reduce(f64::max)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_published_ship_has_every_metric_of_what_it_sails() {
        let zoo = Zoo::load_embedded().unwrap();
        let (vessel, law) = (zoo.vessel("mariner").unwrap(), zoo.law("abkowitz").unwrap());
        let version =
            crate::derive::published_document(vessel, &vessel.file.models[0].name, law, "", "")
                .unwrap();
        let metrics = version_metrics(&version, &zoo);
        assert!(metrics.iter().map(|(name, _)| *name).eq(metric_names()), "{metrics:?}");
        let sailed = simulate_manoeuvres(&version, &zoo).unwrap();
        let diameters = sailed.turns.iter().map(|turn| turn.tactical_diameter_m.unwrap());
        assert_eq!(metrics[2].1, diameters.fold(0.0, f64::max));
        let report = serde_json::json!({ "manoeuvres": { "refined": StandardManoeuvres { turns: Vec::new(), ..sailed } } });
        let reported = super::version_metrics(&VersionDocument { report, ..version }, &zoo);
        assert!(reported.iter().map(|(name, _)| *name).eq(metric_names().skip(4)), "{reported:?}");
    }
}
