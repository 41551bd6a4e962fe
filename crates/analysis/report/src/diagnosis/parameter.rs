//! Parameters of effects for readers: words, value and unit from a name that carries its unit.

use std::collections::BTreeMap;

use sistership_diagnosis::ValueWithError;

use crate::numbers::{format_fixed, format_significant};

/// Endings of names, displayed units, and factors of the value.
const UNITS: [(&str, &str, f64); 10] = [
    ("_rad_s", "deg/s", 180.0 / std::f64::consts::PI),
    ("_deg_s", "deg/s", 1.0),
    ("_m_s", "m/s", 1.0),
    ("_rad", "deg", 180.0 / std::f64::consts::PI),
    ("_deg", "deg", 1.0),
    ("_rps", "1/s", 1.0),
    ("_m", "m", 1.0),
    ("_s", "s", 1.0),
    ("_n", "N", 1.0),
    ("_percent", "%", 1.0),
];

/// Parameter as it is displayed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DisplayParameter {
    /// Name without the unit, in words.
    pub words: String,
    /// Unit; empty if it has none.
    pub unit: &'static str,
    pub value: f64,
    pub se: f64,
}

impl DisplayParameter {
    /// Creates a parameter from its name, which carries its unit.
    pub fn from_value(name: &str, value: &ValueWithError) -> Self {
        let known = UNITS
            .into_iter()
            .find_map(|(ending, unit, factor)| Some((name.strip_suffix(ending)?, unit, factor)));
        let (stem, unit, factor) = known.unwrap_or((name, "", 1.0));
        // A coefficient such as `X_uu` keeps its underscore.
        let is_symbol = stem.starts_with(|first: char| first.is_ascii_uppercase());
        let words = if is_symbol { stem.to_owned() } else { stem.replace('_', " ") };
        Self { words, unit, value: factor * value.value, se: factor * value.se }
    }

    /// Returns all parameters of an effect with their names, except angles in radians that are also
    /// given in degrees.
    pub fn from_values(values: &BTreeMap<String, ValueWithError>) -> Vec<(&str, Self)> {
        let in_degrees = |name: &str| values.contains_key(&name.replace("_rad", "_deg"));
        let shown = values.iter().filter(|(name, _)| !name.contains("_rad") || !in_degrees(name));
        shown.map(|(name, value)| (name.as_str(), Self::from_value(name, value))).collect()
    }

    /// Value with the digits that its standard error allows.
    pub fn value_text(&self) -> String {
        match self.significant_decimals() {
            Some(decimals) => format_fixed(self.value, decimals),
            None => format_significant(self.value, 3),
        }
    }

    /// Standard error with two digits.
    pub fn se_text(&self) -> String {
        if self.se > 0.0 { format_significant(self.se, 2) } else { "–".into() }
    }

    /// Decimals up to the second digit of the standard error; `None` for very small or large
    /// numbers.
    fn significant_decimals(&self) -> Option<usize> {
        let everyday = self.se > 1e-4 && self.se < 1e4 && self.value.abs() < 1e5;
        // The second digit of the standard error is at the decimal 1 - floor(log10 se).
        everyday.then(|| (1.0 - self.se.log10().floor()).clamp(0.0, 5.0) as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_give_words_units_and_digits() {
        let shown = |name: &str, value: f64, se: f64| {
            let parameter = DisplayParameter::from_value(name, &ValueWithError { value, se });
            (parameter.words.clone(), format!("{} {}", parameter.value_text(), parameter.unit))
        };
        assert_eq!(shown("speed_m_s", 0.6012, 0.021), ("speed".into(), "0.601 m/s".into()));
        assert_eq!(shown("offset_rad", 0.026_18, 0.000_9), ("offset".into(), "1.500 deg".into()));
        assert_eq!(shown("towards_deg", 45.3, 12.0), ("towards".into(), "45 deg".into()));
        assert_eq!(shown("N_phi", 1.2e-4, 2e-5), ("N_phi".into(), "0.000120 ".into()));
        assert_eq!(shown("yaw_lever", 0.5, 0.0).0, "yaw lever");
        let twice = ["offset_deg", "offset_rad", "rate_rad_s"]
            .map(|name| (name.to_owned(), ValueWithError { value: 1.0, se: 0.1 }));
        let names: Vec<String> = DisplayParameter::from_values(&twice.into())
            .into_iter()
            .map(|(name, _)| name.to_owned())
            .collect();
        assert_eq!(names, ["offset_deg", "rate_rad_s"]);
    }
}
