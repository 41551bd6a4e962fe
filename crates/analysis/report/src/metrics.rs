//! Figures of a manoeuvre: names, units and accessors.

use sistership_simulation::metrics::{ManoeuvreMetrics, TurningMetrics, ZigzagMetrics};

/// Accessor of one figure in the metrics of a manoeuvre.
pub(crate) type MetricReader<T> = fn(&T) -> Option<f64>;

/// Figures of a turning circle, in metres.
pub(crate) const TURN: [(&str, MetricReader<TurningMetrics>); 4] = [
    ("advance", |turn| turn.advance_m),
    ("transfer", |turn| turn.transfer_m),
    ("tactical diameter", |turn| turn.tactical_diameter_m),
    ("steady radius", |turn| turn.steady_radius_m),
];

/// Figures of a zigzag, with units.
pub(crate) const ZIGZAG: [(&str, &str, MetricReader<ZigzagMetrics>); 3] = [
    ("first overshoot", "deg", |zigzag| zigzag.first_overshoot_deg),
    ("second overshoot", "deg", |zigzag| zigzag.second_overshoot_deg),
    ("period", "s", |zigzag| zigzag.period_s),
];

/// Name, unit and value of a figure.
pub(crate) type MetricValue = (&'static str, &'static str, Option<f64>);

/// Returns the figures of a manoeuvre.
pub(crate) fn manoeuvre_figures(metrics: &ManoeuvreMetrics) -> Vec<MetricValue> {
    match metrics {
        // All figures of a turn are lengths.
        ManoeuvreMetrics::Turn(turn) => {
            TURN.iter().map(|(name, read)| (*name, "m", read(turn))).collect()
        }
        ManoeuvreMetrics::Zigzag(zigzag) => {
            ZIGZAG.iter().map(|(name, unit, read)| (*name, *unit, read(zigzag))).collect()
        }
    }
}
