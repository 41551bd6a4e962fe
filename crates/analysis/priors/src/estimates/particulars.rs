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
    let given = estimate_value(embedded_library()?, particulars, name, 0)?;
    let mut quantity = Quantity::new(given.value, format!("{ESTIMATED}{}", given.regression));
    quantity.standard_error = Some(given.scatter);
    Some(quantity)
}

/// Embedded regressions, parsed once.
fn embedded_library() -> Option<&'static RegressionLibrary> {
    static LIBRARY: OnceLock<Option<RegressionLibrary>> = OnceLock::new();
    LIBRARY.get_or_init(|| RegressionLibrary::parse_embedded().ok()).as_ref()
}

fn estimate_value(
    library: &RegressionLibrary,
    ship: &Particulars,
    name: &str,
    depth: usize,
) -> Option<RegressionValue> {
    let known = |name: &str| formula_input(library, ship, name, depth);
    let all = library.regression_values(name, &known).into_iter();
    all.min_by(|a, b| a.scatter.total_cmp(&b.scatter))
}

/// Input of a formula: stated, or estimated itself.
fn formula_input(
    library: &RegressionLibrary,
    ship: &Particulars,
    name: &str,
    depth: usize,
) -> Option<f64> {
    let name = LETTERS.iter().find(|(letter, _)| *letter == name).map_or(name, |(_, name)| name);
    if name == "Fn" {
        // Froude number at the service speed.
        let speed = particulars::particular_value(ship, "service_speed_m_s")?;
        return Some(speed / (GRAVITY * particulars::particular_value(ship, "lpp_m")?).sqrt());
    }
    let estimated = || {
        // Estimates at the largest depth are discarded.
        let given = estimate_value(library, ship, name, depth + 1).filter(|_| depth < DEEPEST);
        given.map(|given| given.value)
    };
    particulars::particular_value(ship, name).or_else(estimated)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

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

    #[test]
    fn what_is_stated_stays_and_main_dimensions_are_not_invented() {
        let mut known = ship(&[("lpp_m", 140.0), ("x_g_m", 1.0), ("block_coefficient", 0.6)]);
        complete_particulars(&mut known, ["x_g_m", "beam_m", "draught_m", "mass_kg"]);
        assert_eq!(known.len(), 3, "{known:?}");
        let mut slow = ship(&HULL);
        complete_particulars(&mut slow, ["block_coefficient"]);
        assert_eq!(slow["block_coefficient"].source, "estimated: zoo-medians");
    }
}
