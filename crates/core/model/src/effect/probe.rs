//! Evaluation of formulas at a few ordinary points; the numbers are arbitrary, but differ from name
//! to name.

use std::cell::RefCell;
use std::collections::HashMap;

use indexmap::IndexMap;

use super::file::Mirror;
use super::form::EffectParameter;
use sistership_formula::{self as formula, Expr};

/// Names that change sign in the mirror.
const ODD_NAMES: [&str; 16] = [
    "v",
    "v_water",
    "r",
    "p",
    "phi",
    "psi",
    "delta",
    "y",
    "wind_from",
    "apparent_wind_from",
    "v_dot",
    "r_dot",
    "p_dot",
    "phi_dot",
    "psi_dot",
    "y_dot",
];

/// Seeds of the points at which formulas are evaluated.
pub const SEEDS: [u32; 3] = [7, 31, 101];

/// Returns true if the quantity changes sign when the ship is mirrored port to starboard.
pub fn is_odd(name: &str) -> bool {
    ODD_NAMES.contains(&name)
}

/// One point, or its mirror image.
pub struct FormulaProbe<'a> {
    pub parameters: &'a IndexMap<String, EffectParameter>,
    pub values: &'a IndexMap<String, Expr>,
    pub seed: u32,
    pub mirrored: bool,
    /// True if every parameter has the value of the effect's absence.
    pub absent: bool,
    /// Values that have been evaluated; each is evaluated once.
    pub known: RefCell<HashMap<String, Option<f64>>>,
}

impl FormulaProbe<'_> {
    /// Value of a formula; `None` if it is not finite.
    pub fn evaluate_formula(&self, expr: &Expr) -> Option<f64> {
        expr.value(&|name| self.name_value(name)).filter(|value| value.is_finite())
    }

    fn name_value(&self, name: &str) -> Option<f64> {
        if let Some(value) = self.values.get(name) {
            if let Some(known) = self.known.borrow().get(name) {
                return *known;
            }
            let found = value.value(&|name| self.name_value(name));
            self.known.borrow_mut().insert(name.to_owned(), found);
            return found;
        }
        if let Some((value, _)) = formula::builtin_constant(name) {
            return Some(value);
        }
        Some(self.parameters.get(name).map_or_else(
            || self.external_value(name),
            |parameter| self.parameter_value(name, parameter),
        ))
    }

    fn parameter_value(&self, name: &str, parameter: &EffectParameter) -> f64 {
        // Between 0.3 and 0.7 of the bounds, away from both ends.
        let [low, high] = parameter.bounds;
        let here = if self.absent {
            parameter.absent
        } else {
            low + (0.3 + 0.4 * self.name_fraction(name)) * (high - low)
        };
        if self.mirrored && parameter.mirror == Mirror::Opposite { -here } else { here }
    }

    fn external_value(&self, name: &str) -> f64 {
        let size = 0.2 + self.name_fraction(name);
        if !is_odd(name) {
            return size;
        }
        // At each point an odd quantity has an arbitrary sign, and in the mirror the opposite one.
        let to_port = (self.name_hash(name) / 997) % 2 == 1;
        if to_port == self.mirrored { size } else { -size }
    }

    /// Fraction from 0 to 1 that belongs to a name.
    fn name_fraction(&self, name: &str) -> f64 {
        f64::from(self.name_hash(name) % 997) / 997.0
    }

    fn name_hash(&self, name: &str) -> u32 {
        name.bytes()
            .fold(self.seed, |hash, byte| hash.wrapping_mul(31).wrapping_add(u32::from(byte)))
    }
}
