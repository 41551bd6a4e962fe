//! Channels of the tables of errors.

/// Channels in the order of the table: name, unit, and factor from SI to that unit.
pub const TABLE_CHANNELS: [(&str, &str, f64); 8] = [
    ("u", "m/s", 1.0),
    ("v", "m/s", 1.0),
    ("r", "deg/s", 180.0 / std::f64::consts::PI),
    ("psi", "deg", 180.0 / std::f64::consts::PI),
    ("x", "m", 1.0),
    ("y", "m", 1.0),
    ("phi", "deg", 180.0 / std::f64::consts::PI),
    ("p", "deg/s", 180.0 / std::f64::consts::PI),
];
