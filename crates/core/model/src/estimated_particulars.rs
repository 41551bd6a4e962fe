//! Estimated particulars of a model, which its ship does not state, with band and source.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::particulars::{Particulars, plausible_range};

/// Beginning of the source of a particular from a regression, whose name follows.
pub const ESTIMATED: &str = "estimated: ";
/// Beginning of the source of a particular that is scaled from another ship by Froude's law.
pub const SCALED: &str = "scaled from ";

/// Quantile of the normal distribution for 97.5 %.
const NORMAL_QUANTILE: f64 = 1.96;

/// A particular that the ship does not state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EstimatedParticular {
    /// Its name, with the unit.
    pub name: String,
    /// The value in use.
    pub value: f64,
    /// 95 % band; absent if no scatter is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub band: Option<[f64; 2]>,
    /// The regression, or the ship from which it is scaled.
    pub source: String,
}

impl EstimatedParticular {
    /// Description, such as `x_g_m -2.32 (95 % -6.7 to 2.1; estimated: zoo-medians)`.
    pub fn describe(&self) -> String {
        let band = self.band.map(|[low, high]| format!("95 % {low:.4} to {high:.4}; "));
        format!("{} {:.4} ({}{})", self.name, self.value, band.unwrap_or_default(), self.source)
    }
}

/// Returns the estimated particulars of a model, in the order of their names.
pub fn estimated_particulars(particulars: &Particulars) -> Vec<EstimatedParticular> {
    let is_estimated = |source: &str| source.starts_with(ESTIMATED) || source.starts_with(SCALED);
    let estimates = particulars.iter().filter(|(_, quantity)| is_estimated(&quantity.source));
    let one = |(name, quantity): (&String, &crate::quantity::Quantity)| EstimatedParticular {
        name: name.clone(),
        value: quantity.value,
        band: quantity.standard_error.map(|error| estimate_band(name, quantity.value, error)),
        source: quantity.source.clone(),
    };
    estimates.map(one).collect()
}

/// Returns a sentence that names the estimated particulars; `None` if every particular is stated.
pub fn describe_estimates(particulars: &Particulars) -> Option<String> {
    let all = estimated_particulars(particulars);
    let words: Vec<String> = all.iter().map(EstimatedParticular::describe).collect();
    let sentence = format!(
        "missing particulars of the ship are estimated: {}; give those that are known",
        words.join(", ")
    );
    (!words.is_empty()).then_some(sentence)
}

/// Band of an estimate, within the plausible range of the particular.
fn estimate_band(name: &str, value: f64, error: f64) -> [f64; 2] {
    let (low, high) = plausible_range(name).unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
    [(value - NORMAL_QUANTILE * error).max(low), (value + NORMAL_QUANTILE * error).min(high)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::Quantity;

    #[test]
    fn estimates_are_named_with_their_bands() {
        let estimate = |value, source: &str, error| Quantity {
            standard_error: error,
            ..Quantity::new(value, source)
        };
        let particulars: Particulars = [
            ("x_g_m".to_owned(), estimate(-1.0, "estimated: zoo-medians", Some(2.0))),
            ("gm_m".to_owned(), estimate(1.0, "a-paper-1999", Some(0.1))),
            ("rudder_area_m2".to_owned(), estimate(1.0, "scaled from kcs", Some(1.0))),
        ]
        .into();
        let found = estimated_particulars(&particulars);
        let names: Vec<&str> = found.iter().map(|one| one.name.as_str()).collect();
        assert_eq!(names, ["rudder_area_m2", "x_g_m"]);
        assert_eq!(found[0].band, Some([1e-5, 2.96]), "no rudder has a negative area");
        let words = describe_estimates(&particulars).unwrap_or_default();
        assert!(words.contains("x_g_m -1.0000 (95 % -4.9200 to 2.9200; estimated"), "{words}");
    }
}
