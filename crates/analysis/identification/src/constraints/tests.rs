#![allow(clippy::unwrap_used)]
use nalgebra::{DMatrix, Matrix2};
use sistership_model::{Law, Model, Zoo};
use sistership_simulation::Ship;

use super::limits::CoefficientLimits;
use super::straight::{spectral_abscissa, sway_and_yaw};
use super::*;

fn zoo(name: &str) -> (Model, std::sync::Arc<Law>) {
    let zoo = Zoo::load_embedded().unwrap();
    let model = zoo.find_model(name).unwrap();
    let law = zoo.law(&model.law).unwrap().clone();
    (model, law)
}

/// The coefficients within limits that are nearest to a solution, a change by its own size counting
/// alike for each.
fn nearest(
    settings: &Constraints,
    source: &Model,
    law: &Law,
    solution: &Model,
) -> Result<Model, LimitError> {
    let limits = CoefficientLimits::new(settings, source, law, [2.0, 8.0])?;
    let names: Vec<String> = source.coefficients.keys().cloned().collect();
    let size = |name: &String| source.coefficient(name).abs().max(1e-6);
    let curvature = DMatrix::from_fn(names.len(), names.len(), |i, j| {
        if i == j { size(&names[i]).powi(-2) } else { 0.0 }
    });
    let values = solution
        .coefficients
        .iter()
        .map(|(name, quantity)| (name.clone(), quantity.value))
        .collect();
    let found = limits.nearest_coefficients(&values, &names, &curvature, &|name| {
        0.1 * source.coefficient(name).abs()
    })?;
    let mut model = solution.clone();
    found
        .into_iter()
        .for_each(|(name, value)| model.coefficients.get_mut(&name).unwrap().value = value);
    Ok(model)
}

fn with(model: &Model, changes: &[(&str, f64)]) -> Model {
    let mut model = model.clone();
    changes
        .iter()
        .for_each(|(name, value)| model.coefficients.get_mut(*name).unwrap().value = *value);
    model
}

fn growth(model: &Model, law: &Law) -> f64 {
    let [vv, vr, rv, rr] = sway_and_yaw(&Ship::new(model, law).unwrap());
    spectral_abscissa(&Matrix2::new(vv, vr, rv, rr))
}

#[test]
fn a_solution_within_the_limits_stays_where_it_is() {
    let (source, law) = zoo("mariner");
    let settings = Constraints {
        physical_signs: true,
        dissipative: true,
        trust_sd: Some(2.0),
        ..Constraints::default()
    };
    let solution = with(&source, &[("Y_v", 1.1 * source.coefficient("Y_v"))]);
    let found = nearest(&settings, &source, &law, &solution).unwrap();
    for (name, quantity) in &found.coefficients {
        let size = source.coefficient(name).abs();
        assert!((quantity.value - solution.coefficient(name)).abs() < 1e-5 * size, "{name}");
    }
}

#[test]
fn a_yaw_damping_of_the_wrong_sign_comes_to_zero() {
    let (source, law) = zoo("mariner");
    let solution = with(&source, &[("N_r", 1e-3), ("N_delta", -1e-4)]);
    let settings = Constraints { physical_signs: true, ..Constraints::default() };
    let found = nearest(&settings, &source, &law, &solution).unwrap();
    assert!(found.coefficient("N_r").abs() < 1e-8 && found.coefficient("N_delta").abs() < 1e-8);
    assert!((found.coefficient("Y_v") / source.coefficient("Y_v") - 1.0).abs() < 1e-5);
}

#[test]
fn bounds_and_the_trust_region_hold() {
    let (source, law) = zoo("mariner");
    let own = source.coefficient("Y_v");
    let bound = Bound { min: Some(0.9 * own.min(0.0)), max: None };
    let settings = Constraints {
        trust_sd: Some(2.0),
        bounds: [("N_v".to_owned(), bound)].into(),
        ..Constraints::default()
    };
    let solution = with(&source, &[("Y_v", 2.0 * own), ("N_v", 1.9 * own)]);
    let found = nearest(&settings, &source, &law, &solution);
    // 0.9 Y_v is far below what two deviations allow N_v.
    let found = found.unwrap();
    assert!((found.coefficient("Y_v") / own - 1.2).abs() < 1e-5, "two deviations of a tenth");
    assert!((found.coefficient("N_v") / source.coefficient("N_v") - 1.2).abs() < 1e-5);
}

#[test]
fn surge_that_speeds_itself_up_is_damped() {
    let (source, law) = zoo("mariner");
    let solution = with(&source, &[("X_u", 2e-3), ("X_deltadelta", 1e-3)]);
    let settings = Constraints { dissipative: true, ..Constraints::default() };
    let found = nearest(&settings, &source, &law, &solution).unwrap();
    let ship = Ship::new(&found, &law).unwrap();
    for speed in [2.0, 3.5, 5.0, 6.5, 8.0] {
        assert!(super::straight::surge_derivative(&ship, speed) < 1e-8, "{speed}");
    }
    assert!(found.coefficient("X_deltadelta") < 1e-9);
}

#[test]
fn a_ship_declared_stable_becomes_so_and_one_declared_unstable_too() {
    let (source, law) = zoo("mariner");
    assert!(growth(&source, &law) < 0.0, "the Mariner is stable");
    // Less yaw damping and more destabilising drift moment.
    let unstable = with(
        &source,
        &[("N_r", 0.5 * source.coefficient("N_r")), ("N_v", 1.6 * source.coefficient("N_v"))],
    );
    assert!(growth(&unstable, &law) > 0.0);
    let declared = |line| Constraints { straight_line: Some(line), ..Constraints::default() };
    let found = nearest(&declared(StraightLine::Stable), &source, &law, &unstable).unwrap();
    assert!(growth(&found, &law) < 0.0, "{}", growth(&found, &law));
    let found = nearest(&declared(StraightLine::Unstable), &source, &law, &source).unwrap();
    assert!(growth(&found, &law) > 0.0, "{}", growth(&found, &law));
    // What is so already is not moved.
    let kept = nearest(&declared(StraightLine::Unstable), &source, &law, &unstable).unwrap();
    assert!((kept.coefficient("N_r") / unstable.coefficient("N_r") - 1.0).abs() < 1e-5);
}

#[test]
fn limits_that_cannot_be_kept_together_are_named_and_no_others() {
    let (source, law) = zoo("mariner");
    let bound = Bound { min: Some(1e-4), max: None };
    let bounds =
        [("N_r".to_owned(), bound), ("X_u".to_owned(), Bound { min: None, max: Some(0.0) })].into();
    let settings = Constraints {
        physical_signs: true,
        bounds,
        trust_sd: Some(1000.0),
        ..Constraints::default()
    };
    let refused = nearest(&settings, &source, &law, &source).unwrap_err().to_string();
    assert_eq!(
        refused,
        "these constraints contradict each other: physical sign: N_r at most 0; bound of N_r: \
         least 0.0001"
    );
}

#[test]
fn a_bound_of_what_the_model_lacks_is_refused() {
    let (source, law) = zoo("mariner");
    let bounds = [("Y_rrr".to_owned(), Bound { min: Some(0.0), max: None })].into();
    let settings = Constraints { bounds, ..Constraints::default() };
    assert!(
        nearest(&settings, &source, &law, &source)
            .unwrap_err()
            .to_string()
            .contains("bounds.Y_rrr")
    );
    assert!(Constraints { trust_sd: Some(-1.0), ..Constraints::default() }.check().is_err());
    let crossed = [("Y_v".to_owned(), Bound { min: Some(1.0), max: Some(0.0) })].into();
    assert!(
        Constraints { bounds: crossed, ..Constraints::default() }
            .check()
            .unwrap_err()
            .to_string()
            .contains("bounds.Y_v")
    );
}

#[test]
fn the_ships_of_the_zoo_keep_signs_and_dissipation() {
    let zoo = Zoo::load_embedded().unwrap();
    let settings =
        Constraints { physical_signs: true, dissipative: true, ..Constraints::default() };
    for name in ["mariner", "sr108", "kvlcc2", "kvlcc2-7m", "kcs", "esso-tanker"] {
        let model = zoo.find_model(name).unwrap();
        let speed = model.speed_m_s.unwrap_or(7.0);
        let limits = CoefficientLimits::new(
            &settings,
            &model,
            zoo.law(&model.law).unwrap(),
            [0.4 * speed, speed],
        )
        .unwrap();
        assert_eq!(limits.check(&model), Ok(()), "{name}");
    }
}
