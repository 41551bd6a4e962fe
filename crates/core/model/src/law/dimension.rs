//! Dimensions of states, forces and accelerations.

use crate::coefficient::Axis;
use sistership_formula::units::Dimension;

/// States that formulas may use, with their dimensions.
pub const STATES: [(&str, Dimension); 6] = [
    ("u", Dimension::SPEED),
    ("v", Dimension::SPEED),
    ("r", Dimension::RATE),
    ("p", Dimension::RATE),
    ("phi", Dimension::NONE),
    ("psi", Dimension::NONE),
];

/// Dimension of the force on an axis: a force for X and Y, a moment for K and N.
pub fn axis_dimension(axis: Axis) -> Dimension {
    match axis {
        Axis::X | Axis::Y => Dimension::FORCE,
        Axis::K | Axis::N => Dimension::MOMENT,
    }
}

/// Dimension of the acceleration on an axis: m/s2 for X and Y, rad/s2 for K and N.
pub fn acceleration_dimension(axis: Axis) -> Dimension {
    let velocity =
        if matches!(axis, Axis::X | Axis::Y) { Dimension::SPEED } else { Dimension::RATE };
    velocity - Dimension::TIME
}
