//! Inputs of the formulas of regressions.

use std::collections::BTreeMap;

use sistership_model::particulars::{self, Particulars};

use crate::estimates::error::EstimateError;

/// Particulars that have no regression here.
const NEEDED: [&str; 4] = ["lpp_m", "beam_m", "draught_m", "block_coefficient"];

/// Values by the names that formulas use.
#[derive(Debug, Clone)]
pub struct FormulaInputs {
    known: BTreeMap<String, f64>,
}

impl FormulaInputs {
    /// Creates the inputs for a ship at a speed.
    ///
    /// # Errors
    /// Returns an error that names the particulars that are missing.
    pub fn new(
        ship: &str,
        particulars: &Particulars,
        speed_m_s: f64,
    ) -> Result<Self, EstimateError> {
        let of = |name: &str| particulars::particular_value(particulars, name);
        let missing: Vec<String> = NEEDED
            .iter()
            .filter(|name| of(name).is_none())
            .map(|name| (*name).to_owned())
            .collect();
        if !missing.is_empty() {
            return Err(EstimateError::Missing { ship: ship.to_owned(), names: missing });
        }
        let known =
            particulars::particular_names().filter_map(|name| Some((name.to_owned(), of(name)?)));
        let mut inputs = Self { known: known.collect() };
        let get = |name: &str| of(name).unwrap_or(0.0);
        let (l, b, t) = (get("lpp_m"), get("beam_m"), get("draught_m"));
        // A stated displacement takes precedence over the block coefficient.
        let volume = of("displacement_m3").unwrap_or(get("block_coefficient") * l * b * t);
        let trim = get("draught_aft_m") - get("draught_fore_m");
        let both = of("draught_aft_m").is_some() && of("draught_fore_m").is_some();
        for (name, value) in [
            ("L", l),
            ("B", b),
            ("T", t),
            ("C_b", get("block_coefficient")),
            ("U", speed_m_s),
            // Mass by 0.5 rho L^2 T.
            ("m", 2.0 * volume / (l * l * t)),
            // Trim by the stern, divided by the draught.
            ("tau", if both { trim / t } else { 0.0 }),
        ] {
            inputs.set(name, value);
        }
        Ok(inputs)
    }

    /// Value of a name.
    pub fn get(&self, name: &str) -> Option<f64> {
        self.known.get(name).copied()
    }

    /// Sets a value.
    pub fn set(&mut self, name: &str, value: f64) {
        self.known.insert(name.to_owned(), value);
    }
}
