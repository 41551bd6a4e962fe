//! Dimensions of states, of what acts on an axis and of what that causes.

use crate::coefficient::Axis;
use sistership_formula::units::Dimension;

/// The states that formulas may use, with their dimensions.
pub const STATES: [(&str, Dimension); 6] = [
    ("u", Dimension::SPEED),
    ("v", Dimension::SPEED),
    ("r", Dimension::RATE),
    ("p", Dimension::RATE),
    ("phi", Dimension::NONE),
    ("psi", Dimension::NONE),
];

/// Force for X and Y, moment for K and N.
pub fn axis_dimension(axis: Axis) -> Dimension {
    match axis {
        Axis::X | Axis::Y => Dimension::FORCE,
        Axis::K | Axis::N => Dimension::MOMENT,
    }
}

/// The rate of a velocity for X and Y, of a rate for K and N.
pub fn acceleration_dimension(axis: Axis) -> Dimension {
    let velocity =
        if matches!(axis, Axis::X | Axis::Y) { Dimension::SPEED } else { Dimension::RATE };
    velocity - Dimension::TIME
}
