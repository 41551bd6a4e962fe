//! Names and units in the terms of naval architecture.

use serde::Serialize;
use sistership_identification::refine::EstimationMethod;
use sistership_model::vessel::Status;

/// Channel as it is displayed: angles in degrees.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct DisplayChannel {
    /// Name in the data.
    pub channel: &'static str,
    /// Name in words.
    pub name: &'static str,
    /// Symbol.
    pub symbol: &'static str,
    /// Displayed unit.
    pub unit: &'static str,
    /// Displayed value divided by the SI value.
    #[serde(skip)]
    pub factor: f64,
}

const DEG: f64 = 180.0 / std::f64::consts::PI;

/// Creates a displayed channel.
const fn display_channel(
    channel: &'static str,
    name: &'static str,
    symbol: &'static str,
    unit: &'static str,
    factor: f64,
) -> DisplayChannel {
    DisplayChannel { channel, name, symbol, unit, factor }
}

/// Channels of errors, in their order; `position` is the horizontal distance.
pub(crate) const CHANNELS: [DisplayChannel; 9] = [
    display_channel("u", "surge speed", "u", "m/s", 1.0),
    display_channel("v", "sway speed", "v", "m/s", 1.0),
    display_channel("r", "yaw rate", "r", "deg/s", DEG),
    display_channel("psi", "heading", "ψ", "deg", DEG),
    display_channel("x", "position north", "x", "m", 1.0),
    display_channel("y", "position east", "y", "m", 1.0),
    display_channel("position", "position", "x, y", "m", 1.0),
    display_channel("phi", "roll angle", "φ", "deg", DEG),
    display_channel("p", "roll rate", "p", "deg/s", DEG),
];

/// Rudder angle, which is an input and not simulated.
pub(crate) const RUDDER: DisplayChannel = display_channel("delta", "rudder angle", "δ", "deg", DEG);

/// Returns a channel by its name in the data.
pub(crate) fn find_channel(name: &str) -> Option<DisplayChannel> {
    CHANNELS.into_iter().find(|quantity| quantity.channel == name)
}

/// Endings of field names, and the units that they mean; longer endings come before shorter ones
/// that they contain.
const UNITS: [(&str, &str); 9] = [
    ("_kg_m3", "kg/m³"),
    ("_m_s", "m/s"),
    ("_deg_s", "deg/s"),
    ("_m2", "m²"),
    ("_m3", "m³"),
    ("_kg", "kg"),
    ("_deg", "deg"),
    ("_m", "m"),
    ("_s", "s"),
];

/// Name in words and unit of a field such as `rudder_area_m2`.
pub fn field_words(name: &str) -> (String, &'static str) {
    let (stem, unit) = UNITS
        .into_iter()
        .find_map(|(ending, unit)| Some((name.strip_suffix(ending)?, unit)))
        .unwrap_or((name, "–"));
    let words = match stem {
        "lpp" => "length between perpendiculars".into(),
        "loa" => "length over all".into(),
        "x_g" => "centre of gravity ahead of midship".into(),
        "gm" | "kg" | "km" | "kb" => stem.to_uppercase(),
        _ => stem.replace('_', " "),
    };
    (words, unit)
}

/// Status in words.
pub(crate) fn status_word(status: Status) -> &'static str {
    match status {
        Status::Published => "published",
        Status::Estimated => "estimated",
        Status::Transferred => "transferred",
        Status::Refined => "refined",
    }
}

/// Meaning of a status.
pub(crate) fn status_meaning(status: Status) -> &'static str {
    match status {
        Status::Published => "figures as published from captive tests, computations or trials",
        Status::Estimated => "estimated from particulars by regression formulas: provisional",
        Status::Transferred => "a source model scaled to this ship, not fitted to it",
        Status::Refined => "fitted to trials of this ship",
    }
}

/// Estimator in words.
pub(crate) fn method_words(name: &str) -> &'static str {
    match EstimationMethod::by_name(name) {
        Some(EstimationMethod::Published) => {
            "one-step differences, ridge regression with the source as prior (Kanazawa 2023)"
        }
        Some(EstimationMethod::Weak) => {
            "equations integrated over windows, ridge regression with the source as prior"
        }
        Some(EstimationMethod::Trajectory) => {
            "least squares on simulated segments with the source as prior"
        }
        Some(EstimationMethod::CmaEs) => {
            "evolutionary search (CMA-ES) on simulated subsequences (Miyauchi 2024)"
        }
        None => "",
    }
}

/// Axis in words.
pub fn axis_words(axis: &str) -> &'static str {
    match axis {
        "X" => "surge force X",
        "Y" => "sway force Y",
        "K" => "roll moment K",
        "N" => "yaw moment N",
        "parameters" => "parameters of the law",
        _ => "other",
    }
}

/// Recorded variable in words, its displayed unit, and the conversion from SI.
pub fn variable_words(name: &str) -> (&str, &'static str, fn(f64) -> f64) {
    let plain: fn(f64) -> f64 = |value| value;
    let degrees: fn(f64) -> f64 = |value| value.to_degrees();
    match name {
        // Directions are shown from 0 to 360 degrees.
        "psi" => ("heading", "deg", |value| (value.to_degrees()).rem_euclid(360.0)),
        "wind_from" => {
            ("direction the wind comes from", "deg", |value| (value.to_degrees()).rem_euclid(360.0))
        }
        "apparent_wind_from" => {
            ("apparent wind from the bow", "deg", |value| (value.to_degrees()).rem_euclid(360.0))
        }
        "delta" => ("rudder angle", "deg", degrees),
        "n" => ("propeller revolutions", "1/s", plain),
        "wind_speed" => ("wind speed", "m/s", plain),
        "apparent_wind_speed" => ("apparent wind speed", "m/s", plain),
        "depth" => ("water depth", "m", plain),
        "t" | "time" => ("time", "s", plain),
        other => match find_channel(other) {
            Some(quantity) if quantity.factor == 1.0 => (quantity.name, quantity.unit, plain),
            Some(quantity) => (quantity.name, quantity.unit, degrees),
            None => (other, "SI", plain),
        },
    }
}

/// Displayed unit of an acceleration, and the factor from SI.
pub(crate) fn acceleration_unit(channel: &str) -> (&'static str, f64) {
    match channel {
        "r" | "p" | "psi" | "phi" => ("deg/s²", 180.0 / std::f64::consts::PI),
        _ => ("m/s²", 1.0),
    }
}
