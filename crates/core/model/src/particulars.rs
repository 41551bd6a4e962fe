//! Particulars of a ship: the figures that a file may state, with units in the names.

use std::collections::BTreeMap;

use crate::quantity::Quantity;
use crate::yaml::MAX_FAULTS;
use sistership_formula::units::Dimension;

/// Particulars by name, in SI.
pub type Particulars = BTreeMap<String, Quantity>;

const AREA: Dimension = Dimension::new(0.0, 2.0, 0.0);
const VOLUME: Dimension = Dimension::new(0.0, 3.0, 0.0);
const DENSITY: Dimension = Dimension::new(1.0, -3.0, 0.0);
const MASS: Dimension = Dimension::new(1.0, 0.0, 0.0);

/// Name, dimension, least and greatest plausible value.
const KNOWN_PARTICULARS: &[(&str, Dimension, f64, f64)] = &[
    ("lpp_m", Dimension::LENGTH, 0.3, 600.0),
    ("loa_m", Dimension::LENGTH, 0.3, 700.0),
    ("beam_m", Dimension::LENGTH, 0.03, 100.0),
    ("depth_moulded_m", Dimension::LENGTH, 0.01, 60.0),
    ("draught_m", Dimension::LENGTH, 0.01, 40.0),
    ("draught_fore_m", Dimension::LENGTH, 0.0, 40.0),
    ("draught_aft_m", Dimension::LENGTH, 0.0, 40.0),
    ("displacement_m3", VOLUME, 1e-4, 2e6),
    ("mass_kg", MASS, 0.1, 2e9),
    ("block_coefficient", Dimension::NONE, 0.2, 1.0),
    ("x_g_m", Dimension::LENGTH, -60.0, 60.0),
    ("gm_m", Dimension::LENGTH, -5.0, 40.0),
    ("kg_m", Dimension::LENGTH, 0.0, 60.0),
    ("km_m", Dimension::LENGTH, 0.0, 100.0),
    ("kb_m", Dimension::LENGTH, 0.0, 40.0),
    ("yaw_gyradius_ratio", Dimension::NONE, 0.1, 0.5),
    ("roll_gyradius_ratio", Dimension::NONE, 0.1, 0.8),
    ("service_speed_m_s", Dimension::SPEED, 0.01, 40.0),
    ("rudder_area_m2", AREA, 1e-5, 300.0),
    ("rudder_height_m", Dimension::LENGTH, 1e-3, 30.0),
    ("rudder_aspect_ratio", Dimension::NONE, 0.2, 6.0),
    ("propeller_diameter_m", Dimension::LENGTH, 1e-3, 15.0),
    ("propeller_blades", Dimension::NONE, 2.0, 9.0),
    ("propeller_pitch_ratio", Dimension::NONE, 0.1, 3.0),
    ("thruster_y_m", Dimension::LENGTH, 1e-3, 50.0),
    ("frontal_area_m2", AREA, 1e-3, 5000.0),
    ("lateral_area_m2", AREA, 1e-3, 20000.0),
    ("water_density_kg_m3", DENSITY, 900.0, 1100.0),
];

/// Values of particulars that a ship need not state.
const DEFAULTS: &[(&str, f64)] = &[("water_density_kg_m3", 1025.0)];

/// Dimension of a particular.
pub fn particular_dimension(name: &str) -> Option<Dimension> {
    KNOWN_PARTICULARS.iter().find(|(known, ..)| *known == name).map(|&(_, dimension, ..)| dimension)
}

/// Least and greatest plausible value of a particular.
pub fn plausible_range(name: &str) -> Option<(f64, f64)> {
    KNOWN_PARTICULARS
        .iter()
        .find(|(known, ..)| *known == name)
        .map(|&(_, _, low, high)| (low, high))
}

/// Names of all particulars.
pub fn particular_names() -> impl Iterator<Item = &'static str> {
    KNOWN_PARTICULARS.iter().map(|&(name, ..)| name)
}

/// Checks names and ranges, and the consistency of the figures of one ship.
///
/// # Errors
/// Returns the particular at fault and its plausible range.
pub fn check_particulars(particulars: &Particulars) -> Result<(), (String, String)> {
    find_faults(particulars).into_iter().next().map_or(Ok(()), Err)
}

/// Returns the particulars at fault with their plausible ranges, at most [`MOST_FAULTS`].
pub fn find_faults(particulars: &Particulars) -> Vec<(String, String)> {
    let one = |(name, quantity): (&String, &Quantity)| {
        let Some(&(_, _, low, high)) = KNOWN_PARTICULARS.iter().find(|(known, ..)| known == name)
        else {
            let known: Vec<&str> = particular_names().collect();
            return Some((
                name.clone(),
                format!("unknown particular; known: {}", known.join(", ")),
            ));
        };
        let is_possible = (low..=high).contains(&quantity.value);
        let message = || format!("{} is outside {low} to {high}; check the unit", quantity.value);
        (!is_possible).then(|| (name.clone(), message()))
    };
    let found: Vec<(String, String)> =
        particulars.iter().filter_map(one).take(MAX_FAULTS).collect();
    // The consistency of several figures is checked only if each is plausible.
    match found.is_empty() {
        true => check_block_coefficient(particulars).err().into_iter().collect(),
        false => found,
    }
}

/// Checks that displacement and block coefficient agree within 8 %.
fn check_block_coefficient(particulars: &Particulars) -> Result<(), (String, String)> {
    let of = |name: &str| particulars.get(name).map(|q| q.value);
    let (Some(c_b), Some(volume), Some(l), Some(b), Some(t)) = (
        of("block_coefficient"),
        of("displacement_m3"),
        of("lpp_m"),
        of("beam_m"),
        of("draught_m"),
    ) else {
        return Ok(());
    };
    let from_volume = volume / (l * b * t);
    if (from_volume / c_b - 1.0).abs() > 0.08 {
        let message = format!(
            "{c_b} contradicts displacement_m3 / (lpp_m beam_m draught_m) = {from_volume:.3}"
        );
        return Err(("block_coefficient".into(), message));
    }
    Ok(())
}

/// Value of a particular: stated, derived from others, or by default.
pub fn particular_value(particulars: &Particulars, name: &str) -> Option<f64> {
    let default =
        |name: &str| DEFAULTS.iter().find(|(known, _)| *known == name).map(|&(_, value)| value);
    stated_value(particulars, name).or_else(|| default(name))
}

/// Value of a particular: stated, or derived from stated ones.
pub fn stated_value(particulars: &Particulars, name: &str) -> Option<f64> {
    let stated = |name: &str| particulars.get(name).map(|q| q.value);
    stated(name).or_else(|| derived_value(name, &stated))
}

/// Value that follows from other particulars.
fn derived_value(name: &str, stated: &dyn Fn(&str) -> Option<f64>) -> Option<f64> {
    let density = stated("water_density_kg_m3").unwrap_or(DEFAULTS[0].1);
    let box_volume = || Some(stated("lpp_m")? * stated("beam_m")? * stated("draught_m")?);
    let from_block = || Some(stated("block_coefficient")? * box_volume()?);
    let volume = || stated("displacement_m3").or_else(|| Some(stated("mass_kg")? / density));
    // Each relation is used for every figure that it determines.
    match name {
        "displacement_m3" => volume().or_else(from_block),
        "block_coefficient" => Some(volume()? / box_volume()?),
        "mass_kg" => Some(stated("displacement_m3").or_else(from_block)? * density),
        // Between the hull of a catamaran and its outer side, where the actuators are not stated.
        "thruster_y_m" => Some(0.4 * stated("beam_m")?),
        "rudder_height_m" => {
            Some((stated("rudder_area_m2")? * stated("rudder_aspect_ratio")?).sqrt())
        }
        "rudder_aspect_ratio" => {
            Some(stated("rudder_height_m")?.powi(2) / stated("rudder_area_m2")?)
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn ship(values: &[(&str, f64)]) -> Particulars {
        values
            .iter()
            .map(|&(name, value)| (name.to_owned(), Quantity::new(value, "test")))
            .collect()
    }

    #[test]
    fn mass_follows_from_displacement_and_density() {
        let ship = ship(&[("displacement_m3", 2.0), ("water_density_kg_m3", 1000.0)]);
        assert_eq!(particular_value(&ship, "mass_kg"), Some(2000.0));
        assert_eq!(particular_value(&ship, "lpp_m"), None);
    }

    #[test]
    fn nonsense_is_refused_by_name() {
        assert_eq!(check_particulars(&ship(&[("lenght_m", 3.0)])).unwrap_err().0, "lenght_m");
        assert!(check_particulars(&ship(&[("lpp_m", 17500.0)])).unwrap_err().1.contains("unit"));
        let contradictory = ship(&[
            ("lpp_m", 100.0),
            ("beam_m", 20.0),
            ("draught_m", 5.0),
            ("displacement_m3", 5000.0),
            ("block_coefficient", 0.8),
        ]);
        assert!(check_particulars(&contradictory).unwrap_err().1.contains("contradicts"));
    }
}
