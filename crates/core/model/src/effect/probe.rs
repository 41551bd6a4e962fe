//! Formulas at a few ordinary points: any numbers will do, as long as different names have
//! different ones.

use std::cell::RefCell;
use std::collections::HashMap;

use indexmap::IndexMap;

use super::file::Mirror;
use super::form::EffectParameter;
use sistership_formula::{self as formula, Expr};

/// What changes its sign in the mirror.
const ODD: [&str; 16] = [
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

/// Points at which formulas are tried.
pub const SEEDS: [u32; 3] = [7, 31, 101];

/// Whether the quantity changes its sign when the ship is mirrored port to starboard.
pub fn is_odd(name: &str) -> bool {
    ODD.contains(&name)
}

/// One point, or its mirror image.
pub struct Probe<'a> {
    pub parameters: &'a IndexMap<String, EffectParameter>,
    pub values: &'a IndexMap<String, Expr>,
    pub seed: u32,
    pub mirrored: bool,
    /// Whether every parameter stands for the absence of the effect.
    pub absent: bool,
    /// Values that were needed so far: each is found once.
    pub known: RefCell<HashMap<String, Option<f64>>>,
}

impl Probe<'_> {
    /// The value of a formula; `None` where it is not finite.
    pub fn of(&self, expr: &Expr) -> Option<f64> {
        expr.value(&|name| self.name(name)).filter(|value| value.is_finite())
    }

    fn name(&self, name: &str) -> Option<f64> {
        if let Some(value) = self.values.get(name) {
            if let Some(known) = self.known.borrow().get(name) {
                return *known;
            }
            let found = value.value(&|name| self.name(name));
            self.known.borrow_mut().insert(name.to_owned(), found);
            return found;
        }
        if let Some((value, _)) = formula::builtin(name) {
            return Some(value);
        }
        Some(
            self.parameters
                .get(name)
                .map_or_else(|| self.outside(name), |parameter| self.parameter(name, parameter)),
        )
    }

    fn parameter(&self, name: &str, parameter: &EffectParameter) -> f64 {
        let [low, high] = parameter.bounds;
        let here = if self.absent {
            parameter.absent
        } else {
            low + (0.3 + 0.4 * self.fraction(name)) * (high - low)
        };
        if self.mirrored && parameter.mirror == Mirror::Opposite { -here } else { here }
    }

    fn outside(&self, name: &str) -> f64 {
        let size = 0.2 + self.fraction(name);
        if !is_odd(name) {
            return size;
        }
        let to_port = (self.hash(name) / 997) % 2 == 1;
        if to_port == self.mirrored { size } else { -size }
    }

    /// From 0 to 1.
    fn fraction(&self, name: &str) -> f64 {
        f64::from(self.hash(name) % 997) / 997.0
    }

    fn hash(&self, name: &str) -> u32 {
        name.bytes()
            .fold(self.seed, |hash, byte| hash.wrapping_mul(31).wrapping_add(u32::from(byte)))
    }
}
