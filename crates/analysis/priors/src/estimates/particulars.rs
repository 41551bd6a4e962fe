//! Estimates of particulars that a ship's file does not state, each by the regression with the
//! least scatter.

use std::sync::OnceLock;

use sistership_model::estimated_particulars::ESTIMATED;
use sistership_model::particulars::{self, Particulars};
use sistership_model::quantity::Quantity;

use crate::estimates::library::RegressionLibrary;
use crate::estimates::regression::RegressionValue;

/// Acceleration of gravity, m/s2.
const GRAVITY: f64 = 9.81;

/// Letters in formulas, with the particular of each.
const LETTERS: [(&str, &str); 4] =
    [("L", "lpp_m"), ("B", "beam_m"), ("T", "draught_m"), ("C_b", "block_coefficient")];

/// Particulars from which another one follows if it is not stated.
const PARTS: [(&str, &[&str]); 3] = [
    ("displacement_m3", &["block_coefficient", "water_density_kg_m3"]),
    ("mass_kg", &["block_coefficient", "water_density_kg_m3"]),
    ("rudder_aspect_ratio", &["rudder_area_m2", "rudder_height_m"]),
];

/// Largest depth of nested regressions: the trim of a hull by its fullness by its speed.
const DEEPEST: usize = 3;

/// Adds particulars that are needed, are not stated, and can be estimated; the estimates have their
/// regression as source, and their standard error.
pub fn complete_particulars<'a>(
    particulars: &mut Particulars,
    needed: impl IntoIterator<Item = &'a str>,
) {
    for name in needed {
        if particulars.contains_key(name) {
            continue;
        }
        let parts = PARTS.iter().find(|(whole, _)| *whole == name).map(|(_, parts)| *parts);
        // A value that follows from others is not estimated itself; they are.
        for part in parts.unwrap_or(&[name]) {
            let is_known = particulars::stated_value(particulars, part).is_some();
            let estimate = (!is_known).then(|| estimate_particular(particulars, part)).flatten();
            if let Some(estimate) = estimate {
                particulars.insert((*part).to_owned(), estimate);
            }
        }
    }
}

/// Estimates a particular by the regression with the least scatter among those whose inputs are
/// known; none where there is no such regression.
pub fn estimate_particular(particulars: &Particulars, name: &str) -> Option<Quantity> {
    let estimator = ParticularEstimator { library: embedded_library()?, ship: particulars };
    let given = estimator.estimate_value(name, &[])?;
    let mut quantity = Quantity::new(given.value, format!("{ESTIMATED}{}", given.regression));
    quantity.standard_error = Some(given.scatter);
    Some(quantity)
}

/// Embedded regressions, parsed once.
fn embedded_library() -> Option<&'static RegressionLibrary> {
    static LIBRARY: OnceLock<Option<RegressionLibrary>> = OnceLock::new();
    LIBRARY.get_or_init(|| RegressionLibrary::parse_embedded().ok()).as_ref()
}

/// Estimator of the particulars of a ship by nested regressions.
struct ParticularEstimator<'a> {
    library: &'a RegressionLibrary,
    ship: &'a Particulars,
}

impl ParticularEstimator<'_> {
    /// Estimates a particular as an input of the estimates in `path`, outermost first.
    fn estimate_value(&self, name: &str, path: &[&str]) -> Option<RegressionValue> {
        // Regressions that need each other give nothing.
        if path.len() > DEEPEST || path.contains(&name) {
            return None;
        }
        let inner = [path, &[name]].concat();
        let known = |input: &str| self.formula_input(input, &inner);
        let all = self.library.regression_values(name, &known).into_iter();
        all.min_by(|a, b| a.scatter.total_cmp(&b.scatter))
    }

    /// Input of a formula: stated, or estimated itself.
    fn formula_input(&self, name: &str, path: &[&str]) -> Option<f64> {
        let letter = LETTERS.iter().find(|(letter, _)| *letter == name);
        let name = letter.map_or(name, |(_, name)| name);
        let stated = |name: &str| particulars::particular_value(self.ship, name);
        if name == "Fn" {
            // Froude number at the service speed.
            return Some(stated("service_speed_m_s")? / (GRAVITY * stated("lpp_m")?).sqrt());
        }
        stated(name).or_else(|| Some(self.estimate_value(name, path)?.value))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::estimates::regression::Regression;

    fn ship(values: &[(&str, f64)]) -> Particulars {
        values.iter().map(|&(name, value)| (name.into(), Quantity::new(value, "test"))).collect()
    }

    const HULL: [(&str, f64); 3] = [("lpp_m", 140.0), ("beam_m", 22.0), ("draught_m", 6.0)];

    #[test]
    fn fullness_follows_from_speed_and_mass_from_fullness() {
        let mut fast = ship(&HULL);
        fast.insert("service_speed_m_s".into(), Quantity::new(10.3, "test"));
        complete_particulars(&mut fast, ["mass_kg", "x_g_m"]);
        let c_b = &fast["block_coefficient"];
        // Watson's line at Fn 0.278.
        assert!((c_b.value - 0.59).abs() < 0.01 && c_b.source == "estimated: watson-1998");
        assert_eq!(c_b.standard_error, Some(0.079));
        let mass = particulars::particular_value(&fast, "mass_kg").unwrap();
        assert!((mass / (1025.0 * 140.0 * 22.0 * 6.0 * c_b.value) - 1.0).abs() < 1e-12);
        assert!((fast["x_g_m"].value + 2.3).abs() < 0.3, "{:?}", fast["x_g_m"]);
    }

    /// Library of regressions that give one value each by a formula.
    fn library(formulas: &[(&str, &str)]) -> RegressionLibrary {
        let one = |&(name, formula): &(&str, &str)| {
            let text = format!(
                "kind: regression\nname: by-{name}\ntitle: t\nsource: {{ citation: c }}\n\
                 note: n\ngives:\n  {name}: {{ formula: \"{formula}\", scatter: 0.1 }}\n"
            );
            Regression::parse("test.yaml", &text).unwrap()
        };
        let embedded = RegressionLibrary::parse_embedded().unwrap();
        RegressionLibrary { regressions: formulas.iter().map(one).collect(), ..embedded }
    }

    #[test]
    fn regressions_that_need_each_other_give_nothing() {
        let ship = ship(&HULL);
        let circle = library(&[
            ("rudder_area_m2", "rudder_height_m^2"),
            ("rudder_height_m", "sqrt(rudder_area_m2)"),
        ]);
        let estimator = ParticularEstimator { library: &circle, ship: &ship };
        assert_eq!(estimator.estimate_value("rudder_area_m2", &[]), None);
    }

    #[test]
    fn regressions_are_nested_to_the_largest_depth_and_no_further() {
        let ship = ship(&HULL);
        let chain = library(&[
            ("x_g_m", "rudder_area_m2"),
            ("rudder_area_m2", "rudder_height_m"),
            ("rudder_height_m", "block_coefficient"),
            ("block_coefficient", "propeller_diameter_m"),
            ("propeller_diameter_m", "0.7*T"),
        ]);
        let estimator = ParticularEstimator { library: &chain, ship: &ship };
        let of_area = estimator.estimate_value("rudder_area_m2", &[]).unwrap();
        assert!((of_area.value - 4.2).abs() < 1e-12);
        assert_eq!(estimator.estimate_value("x_g_m", &[]), None);
    }

    #[test]
    fn what_is_stated_stays_and_main_dimensions_are_not_invented() {
        let mut known = ship(&[("lpp_m", 140.0), ("x_g_m", 1.0), ("block_coefficient", 0.6)]);
        complete_particulars(&mut known, ["x_g_m", "beam_m", "draught_m", "mass_kg"]);
        assert_eq!(known["x_g_m"].source, "test");
        let invented = ["beam_m", "draught_m", "mass_kg", "displacement_m3"];
        assert!(invented.iter().all(|name| !known.contains_key(*name)), "{known:?}");
        let mut slow = ship(&HULL);
        complete_particulars(&mut slow, ["block_coefficient"]);
        assert_eq!(slow["block_coefficient"].source, "estimated: zoo-medians");
    }
}
