//! Physical dimensions and the units that files may use.
//!
//! Angles are dimensionless: a radian is a ratio of lengths, and the prime system treats it as
//! such.

use std::fmt;
use std::ops::{Add, Sub};

/// Exponents of kilogram, metre and second. Halves are permitted, as in the dimension of `sqrt(m)`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Dimension {
    /// Exponent of the kilogram.
    pub mass: f64,
    /// Exponent of the metre.
    pub length: f64,
    /// Exponent of the second.
    pub time: f64,
}

impl Dimension {
    /// A pure number (or an angle).
    pub const NONE: Self = Self::new(0.0, 0.0, 0.0);
    /// Metre.
    pub const LENGTH: Self = Self::new(0.0, 1.0, 0.0);
    /// Second.
    pub const TIME: Self = Self::new(0.0, 0.0, 1.0);
    /// Metre per second.
    pub const SPEED: Self = Self::new(0.0, 1.0, -1.0);
    /// Radian (or revolution) per second.
    pub const RATE: Self = Self::new(0.0, 0.0, -1.0);
    /// Newton.
    pub const FORCE: Self = Self::new(1.0, 1.0, -2.0);
    /// Newton metre.
    pub const MOMENT: Self = Self::new(1.0, 2.0, -2.0);

    /// Creates the dimension `kg^mass m^length s^time`.
    pub const fn new(mass: f64, length: f64, time: f64) -> Self {
        Self { mass, length, time }
    }

    /// Returns the dimension raised to a power.
    pub fn pow(self, exponent: f64) -> Self {
        Self::new(self.mass * exponent, self.length * exponent, self.time * exponent)
    }
}

impl Add for Dimension {
    type Output = Self;
    /// Dimension of a product.
    fn add(self, other: Self) -> Self {
        Self::new(self.mass + other.mass, self.length + other.length, self.time + other.time)
    }
}

impl Sub for Dimension {
    type Output = Self;
    /// Dimension of a quotient.
    fn sub(self, other: Self) -> Self {
        Self::new(self.mass - other.mass, self.length - other.length, self.time - other.time)
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let factors: Vec<String> = [("kg", self.mass), ("m", self.length), ("s", self.time)]
            .into_iter()
            .filter(|(_, exponent)| *exponent != 0.0)
            .map(
                |(unit, exponent)| {
                    if exponent == 1.0 { unit.into() } else { format!("{unit}^{exponent}") }
                },
            )
            .collect();
        if factors.is_empty() { out.write_str("1") } else { out.write_str(&factors.join(" ")) }
    }
}

/// Unit: its dimension and the factor that converts a value to SI units and radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// Dimension of the unit.
    pub dimension: Dimension,
    /// `value in SI = factor * value in this unit`.
    pub to_si: f64,
}

const DEG: f64 = std::f64::consts::PI / 180.0;
const KNOT: f64 = 1852.0 / 3600.0;

/// Every unit that a file may use; a revolution counts as one, as in propeller coefficients.
const UNITS: &[(&str, Dimension, f64)] = &[
    ("1", Dimension::NONE, 1.0),
    ("rad", Dimension::NONE, 1.0),
    ("deg", Dimension::NONE, DEG),
    ("s", Dimension::TIME, 1.0),
    ("ms", Dimension::TIME, 1e-3),
    ("us", Dimension::TIME, 1e-6),
    ("ns", Dimension::TIME, 1e-9),
    ("min", Dimension::TIME, 60.0),
    ("h", Dimension::TIME, 3600.0),
    ("m", Dimension::LENGTH, 1.0),
    ("km", Dimension::LENGTH, 1000.0),
    ("nmi", Dimension::LENGTH, 1852.0),
    ("m/s", Dimension::SPEED, 1.0),
    ("kn", Dimension::SPEED, KNOT),
    ("km/h", Dimension::SPEED, 1.0 / 3.6),
    ("rad/s", Dimension::RATE, 1.0),
    ("deg/s", Dimension::RATE, DEG),
    ("deg/min", Dimension::RATE, DEG / 60.0),
    ("rps", Dimension::RATE, 1.0),
    ("rpm", Dimension::RATE, 1.0 / 60.0),
    ("kg", Dimension::new(1.0, 0.0, 0.0), 1.0),
    ("t", Dimension::new(1.0, 0.0, 0.0), 1000.0),
    ("kg m2", Dimension::new(1.0, 2.0, 0.0), 1.0),
    ("m2", Dimension::new(0.0, 2.0, 0.0), 1.0),
    ("m3", Dimension::new(0.0, 3.0, 0.0), 1.0),
    ("kg/m3", Dimension::new(1.0, -3.0, 0.0), 1.0),
    ("m/s2", Dimension::new(0.0, 1.0, -2.0), 1.0),
    ("N", Dimension::FORCE, 1.0),
    ("N m", Dimension::MOMENT, 1.0),
];

/// Error of an unknown unit.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown unit `{0}`; known units: {known}", known = known_units())]
pub struct UnknownUnit(pub String);

fn known_units() -> String {
    UNITS.iter().map(|(known, _, _)| *known).collect::<Vec<_>>().join(", ")
}

impl Unit {
    /// Returns the unit with a name.
    ///
    /// # Errors
    /// Returns an error that names the unknown unit and lists the known ones.
    pub fn parse(name: &str) -> Result<Self, UnknownUnit> {
        // White space around the name is ignored.
        let found = UNITS.iter().find(|(known, _, _)| *known == name.trim());
        let unit = found.map(|&(_, dimension, to_si)| Self { dimension, to_si });
        unit.ok_or_else(|| UnknownUnit(name.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn knots_and_degrees_convert_to_si() {
        assert!((Unit::parse("kn").unwrap().to_si - 0.514_444_444).abs() < 1e-9);
        assert!((Unit::parse("deg/s").unwrap().to_si * 180.0 - std::f64::consts::PI).abs() < 1e-12);
        assert!(Unit::parse("furlong").unwrap_err().to_string().contains("kn"));
    }

    #[test]
    fn force_is_mass_times_acceleration() {
        let mass = Dimension::new(1.0, 0.0, 0.0);
        assert_eq!(mass + Dimension::SPEED - Dimension::TIME, Dimension::FORCE);
        assert_eq!(Dimension::FORCE.to_string(), "kg m s^-2");
    }
}
