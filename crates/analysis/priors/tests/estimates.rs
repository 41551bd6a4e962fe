//! Estimates of ships of the zoo.

#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use sistership_model::law::Law;
use sistership_model::vessel::Status;
use sistership_model::{Vessel, Zoo};
use sistership_priors::estimates::{
    EstimateError, LAW, RegressionLibrary, ShipEstimate, estimate_bands, estimate_ship,
};
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_standard_manoeuvres};

fn setting() -> (Zoo, RegressionLibrary, Arc<Law>) {
    let zoo = Zoo::load_embedded().unwrap();
    let law = zoo.law(LAW).unwrap().clone();
    (zoo, RegressionLibrary::parse_embedded().unwrap(), law)
}

fn of(name: &str, speed_m_s: f64) -> (ShipEstimate, Arc<Law>) {
    let (zoo, library, law) = setting();
    (estimate_ship(&library, zoo.vessel(name).unwrap(), &law, speed_m_s).unwrap(), law)
}

#[test]
fn a_tanker_is_estimated_near_its_published_set() {
    let (estimate, law) = of("kvlcc2", 7.974);
    let model = &estimate.model;
    assert_eq!(model.status, Status::Estimated);
    for (name, published) in [("Y_v", -0.315), ("N_v", -0.137), ("N_r", -0.049), ("Y_r", 0.083)] {
        let posterior = model.valid_posterior().unwrap();
        let apart = (model.coefficient(name) - published).abs();
        assert!(
            apart < 2.0 * posterior.deviations_by_name()[name],
            "{name} {}",
            model.coefficient(name)
        );
    }
    let ship = Ship::new(model, &law).unwrap();
    let sailed = simulate_standard_manoeuvres(&ship, &ManoeuvreSettings::default());
    assert!(sailed.failures.is_empty(), "{:?}", sailed.failures);
    let diameter = sailed.turns[0].tactical_diameter_m.unwrap() / 320.0;
    assert!((2.0..5.0).contains(&diameter), "{diameter}");
}

#[test]
fn every_value_of_an_estimate_has_a_listed_source() {
    let (estimate, _) = of("mariner", 7.7);
    let model = &estimate.model;
    for (name, quantity) in &model.coefficients {
        assert!(model.sources.contains_key(&quantity.source), "{name}: {}", quantity.source);
    }
    assert!(model.note.as_ref().unwrap().contains("estimated"));
}

#[test]
fn scale_changes_no_estimate_but_the_resistance() {
    let (full, _) = of("kvlcc2", 7.974);
    let (model, _) = of("kvlcc2-7m", 1.179);
    for name in full.model.coefficients.keys().filter(|name| *name != "X_0") {
        let (a, b) = (full.model.coefficient(name), model.model.coefficient(name));
        assert!((a - b).abs() < 0.03 * a.abs().max(0.05), "{name}: {a} and {b}");
    }
    assert!(model.model.coefficient("X_0") < 1.2 * full.model.coefficient("X_0"));
}

#[test]
fn bands_follow_from_the_seed_and_hold_most_draws() {
    let (estimate, law) = of("kvlcc2", 7.974);
    let bands = estimate_bands(&estimate, &law, 1).unwrap();
    let again = estimate_bands(&estimate, &law, 1).unwrap();
    assert_eq!(bands.figures, again.figures);
    assert!(bands.failed * 10 < bands.draws, "{} of {}", bands.failed, bands.draws);
    let name = "turn 35 deg: tactical diameter";
    let band = bands.figures.iter().find(|band| band.figure == name).unwrap();
    let own = bands.manoeuvres.turns[0].tactical_diameter_m.unwrap();
    assert!(band.low < own && own < band.high, "{own} in {band:?}");
    let other = estimate_bands(&estimate, &law, 2).unwrap();
    assert_ne!(bands.figures, other.figures);
}

#[test]
fn what_is_missing_is_named_all_at_once() {
    let (_, library, law) = setting();
    let text = "kind: vessel\nname: box\ntitle: A box\ncategory: barge\nsources: { a: { citation: \
                test } }\nparticulars: { source: a, values: { lpp_m: 60.0 } }\n";
    let vessel = Vessel::parse("box.yaml", text).unwrap();
    let refused = estimate_ship(&library, &vessel, &law, 4.0).unwrap_err();
    let names = vec!["beam_m".to_owned(), "draught_m".to_owned()];
    assert_eq!(refused, EstimateError::Missing { ship: "box".into(), names });
}

#[test]
fn a_ship_of_four_particulars_sails() {
    let (_, library, law) = setting();
    let text = "kind: vessel\nname: coaster\ntitle: A coaster\ncategory: general-cargo\nsources: { \
                a: { citation: test } }\nparticulars: { source: a, values: { lpp_m: 80.0, beam_m: \
                13.0, draught_m: 5.0, block_coefficient: 0.72 } }\n";
    let vessel = Vessel::parse("coaster.yaml", text).unwrap();
    let estimate = estimate_ship(&library, &vessel, &law, 6.0).unwrap();
    let bands = estimate_bands(&estimate, &law, 1).unwrap();
    assert!(bands.manoeuvres.failures.is_empty(), "{:?}", bands.manoeuvres.failures);
    assert!(bands.manoeuvres.turns.iter().all(|turn| turn.tactical_diameter_m.is_some()));
}
