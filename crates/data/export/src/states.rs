//! States of a simulation, in the order of its state vector.

/// States with name, unit and meaning, in the order of the state vector.
pub const STATES: [(&str, &str, &str); 9] = [
    ("u", "m/s", "surge velocity over the ground"),
    ("v", "m/s", "sway velocity over the ground, to starboard"),
    ("r", "rad/s", "yaw rate, to starboard"),
    ("p", "rad/s", "roll rate, to starboard"),
    ("phi", "rad", "roll angle, to starboard"),
    ("psi", "rad", "heading, clockwise from north"),
    ("x", "m", "position north"),
    ("y", "m", "position east"),
    ("delta", "rad", "rudder angle, positive turns the ship to starboard"),
];

/// Index of the rudder in the state vector.
pub const DELTA: usize = 8;
