//! Log odds of the set of assigned quantities: which of them occur together.

use crate::hypothesis::Assignment;
use crate::role::Role;

/// Log odds of a quantity without its companion.
const ALONE: [(Role, Role, f64); 16] = [
    (Role::X, Role::Y, -8.0),
    (Role::Y, Role::X, -8.0),
    (Role::Latitude, Role::Longitude, -8.0),
    (Role::Longitude, Role::Latitude, -8.0),
    (Role::VNorth, Role::VEast, -8.0),
    (Role::VEast, Role::VNorth, -8.0),
    (Role::V, Role::U, -2.0),
    (Role::DeltaS, Role::DeltaP, -4.0),
    (Role::DeltaP, Role::DeltaS, -4.0),
    (Role::NS, Role::NP, -3.0),
    (Role::NP, Role::NS, -3.0),
    (Role::WindFrom, Role::WindSpeed, -2.0),
    (Role::ApparentWindFrom, Role::ApparentWindSpeed, -2.0),
    (Role::VWater, Role::UWater, -3.0),
    (Role::Course, Role::Speed, -1.0),
    (Role::P, Role::Phi, -1.0),
];

/// Log odds of two quantities that are seldom in one recording.
const SELDOM_TOGETHER: [(Role, Role, f64); 7] = [
    (Role::X, Role::Latitude, -1.5),
    (Role::Delta, Role::DeltaS, -6.0),
    (Role::Delta, Role::DeltaP, -6.0),
    (Role::N, Role::NS, -6.0),
    (Role::N, Role::NP, -6.0),
    (Role::U, Role::VNorth, -2.0),
    (Role::V, Role::VEast, -2.0),
];

/// Quantities that a recorder usually writes in the same unit, and the log odds of different units.
const ONE_UNIT: [(Role, Role, f64); 13] = [
    (Role::U, Role::V, -3.5),
    (Role::X, Role::Y, -6.0),
    (Role::Latitude, Role::Longitude, -6.0),
    (Role::VNorth, Role::VEast, -6.0),
    (Role::DeltaS, Role::DeltaP, -6.0),
    (Role::NS, Role::NP, -6.0),
    (Role::R, Role::P, -2.0),
    (Role::Psi, Role::Phi, -1.5),
    (Role::Psi, Role::Delta, -1.0),
    (Role::Phi, Role::Delta, -2.0),
    (Role::Phi, Role::DeltaS, -2.0),
    (Role::Psi, Role::R, -1.0),
    (Role::Phi, Role::P, -2.0),
];

/// Log odds of quantities that every recording of manoeuvres has, under any of their names.
const NEEDED: [(&[Role], f64); 4] = [
    (&[Role::Delta, Role::DeltaS, Role::DeltaP], 1.5),
    (&[Role::N, Role::NS, Role::NP], 2.5),
    (&[Role::Psi, Role::R], 3.0),
    (&[Role::U, Role::Speed, Role::X, Role::Latitude, Role::VNorth], 3.0),
];

/// Returns the log odds of the set of assigned quantities.
pub(crate) fn set_odds(of: &Assignment) -> f64 {
    let alone = ALONE.iter().filter(|(one, other, _)| of.has_role(*one) && !of.has_role(*other));
    let together =
        SELDOM_TOGETHER.iter().filter(|(one, other, _)| of.has_role(*one) && of.has_role(*other));
    let needed = NEEDED.iter().filter(|(roles, _)| roles.iter().any(|role| of.has_role(*role)));
    let unit = |role: Role| {
        let what = of.columns.iter().flatten().find(|what| what.role == role);
        // Degrees match degrees per second, radians match radians per second.
        what.map(|what| what.unit.name.split("/s").next().unwrap_or_default())
    };
    let mixed = ONE_UNIT.iter().filter(|(one, other, _)| match (unit(*one), unit(*other)) {
        (Some(one), Some(other)) => one != other && one != "deg/min" && other != "deg/min",
        _ => false,
    });
    let signs =
        [Role::DeltaS, Role::DeltaP].map(|role| of.find(role).map(|(_, factor)| factor < 0.0));
    let opposed = if matches!(signs, [Some(a), Some(b)] if a != b) { -4.0 } else { 0.0 };
    opposed
        + mixed.map(|row| row.2).sum::<f64>()
        + alone.map(|row| row.2).sum::<f64>()
        + together.map(|row| row.2).sum::<f64>()
        + needed.map(|row| row.1).sum::<f64>()
}
