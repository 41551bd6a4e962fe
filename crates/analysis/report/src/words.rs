//! Names and units as a naval architect says them.

use serde::Serialize;
use sistership_model::vessel::Status;

/// A channel as it is shown: angles in degrees.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct ShownChannel {
    /// Its name in the data.
    pub channel: &'static str,
    /// Its name in words.
    pub name: &'static str,
    /// Its symbol.
    pub symbol: &'static str,
    /// The unit it is shown in.
    pub unit: &'static str,
    /// Shown value over SI value.
    #[serde(skip)]
    pub factor: f64,
}

const DEG: f64 = 180.0 / std::f64::consts::PI;

const fn quantity(
    channel: &'static str,
    name: &'static str,
    symbol: &'static str,
    unit: &'static str,
    factor: f64,
) -> ShownChannel {
    ShownChannel { channel, name, symbol, unit, factor }
}

/// The channels in which errors are given, in their order; `position` is the distance in the plane.
pub(crate) const CHANNELS: [ShownChannel; 9] = [
    quantity("u", "surge speed", "u", "m/s", 1.0),
    quantity("v", "sway speed", "v", "m/s", 1.0),
    quantity("r", "yaw rate", "r", "deg/s", DEG),
    quantity("psi", "heading", "ψ", "deg", DEG),
    quantity("x", "position north", "x", "m", 1.0),
    quantity("y", "position east", "y", "m", 1.0),
    quantity("position", "position", "x, y", "m", 1.0),
    quantity("phi", "roll angle", "φ", "deg", DEG),
    quantity("p", "roll rate", "p", "deg/s", DEG),
];

/// The rudder, which is given and not simulated.
pub(crate) const RUDDER: ShownChannel = quantity("delta", "rudder angle", "δ", "deg", DEG);

/// A channel by its name in the data.
pub(crate) fn channel(name: &str) -> Option<ShownChannel> {
    CHANNELS.into_iter().find(|quantity| quantity.channel == name)
}

/// Endings of names that carry a unit.
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

/// A field such as `rudder_area_m2` in words and its unit.
pub(crate) fn field(name: &str) -> (String, &'static str) {
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

/// A status as it is shown.
pub(crate) fn status(status: Status) -> &'static str {
    match status {
        Status::Published => "published",
        Status::Estimated => "estimated",
        Status::Transferred => "transferred",
        Status::Refined => "refined",
    }
}

/// What a status means.
pub(crate) fn status_meaning(status: Status) -> &'static str {
    match status {
        Status::Published => "figures as published from captive tests, computations or trials",
        Status::Estimated => "figures estimated from particulars by regression formulas: a stopgap",
        Status::Transferred => {
            "a source model carried over by its scaling, not fitted to this ship"
        }
        Status::Refined => "fitted to trials of this ship",
    }
}

/// An estimator in words.
pub(crate) fn method(name: &str) -> &'static str {
    match name {
        "published" => {
            "one-step differences, ridge regression drawn towards the source (Kanazawa 2023)"
        }
        "weak" => "motions integrated over windows, ridge regression drawn towards the source",
        "trajectory" => "simulated segments matched to the measured ones, drawn towards the source",
        "cma-es" => {
            "simulated subsequences matched to the measured ones by a random search (Miyauchi 2024)"
        }
        _ => "",
    }
}

/// An axis in words.
pub(crate) fn axis(axis: &str) -> &'static str {
    match axis {
        "X" => "surge force X",
        "Y" => "sway force Y",
        "K" => "roll moment K",
        "N" => "yaw moment N",
        _ => "other",
    }
}

/// A recorded variable in words, the unit it is shown in, and how.
pub(crate) fn recorded(name: &str) -> (&str, &'static str, fn(f64) -> f64) {
    let plain: fn(f64) -> f64 = |value| value;
    let degrees: fn(f64) -> f64 = |value| value.to_degrees();
    match name {
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
        other => match channel(other) {
            Some(quantity) if quantity.factor == 1.0 => (quantity.name, quantity.unit, plain),
            Some(quantity) => (quantity.name, quantity.unit, degrees),
            None => (other, "SI", plain),
        },
    }
}

/// The unit in which an acceleration is shown, and the factor to it from SI.
pub(crate) fn acceleration(channel: &str) -> (&'static str, f64) {
    match channel {
        "r" | "p" | "psi" | "phi" => ("deg/s²", 180.0 / std::f64::consts::PI),
        _ => ("m/s²", 1.0),
    }
}
