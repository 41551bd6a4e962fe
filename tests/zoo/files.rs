//! Every file of the zoo.

use sistership_dynamics::Ship;
use sistership_dynamics::manoeuvre::{ManoeuvreSettings, standard};
use sistership_model::Zoo;
use sistership_model::vessel::Status;

fn zoo() -> Zoo {
    Zoo::embedded().unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn every_model_sails_the_standard_manoeuvres() {
    let zoo = zoo();
    for vessel in zoo.vessels() {
        for file in &vessel.file.models {
            let model = zoo.published(vessel, Some(&file.name)).unwrap_or_else(|error| panic!("{error}"));
            let ship = Ship::new(&model, zoo.law(&model.law).expect("checked")).unwrap_or_else(|error| panic!("{error}"));
            let sailed = standard(&ship, &ManoeuvreSettings::default());
            assert!(sailed.failures.is_empty(), "{}: {:?}", model.name, sailed.failures);
            let passed = sailed.imo.iter().filter(|criterion| criterion.pass == Some(true)).count();
            println!("{:<28} {passed} of {} IMO criteria", model.name, sailed.imo.len());
            assert!(sailed.turns.iter().all(|turn| turn.tactical_diameter_m.is_some()), "{} does not turn", model.name);
        }
    }
}

#[test]
fn every_number_has_a_source_and_estimates_are_labelled() {
    for vessel in zoo().vessels() {
        assert!(vessel.particulars.values().all(|quantity| !quantity.source.is_empty()), "{}", vessel.name());
        for model in &vessel.file.models {
            let estimated = model.status == Status::Estimated;
            let says_so = model.note.as_ref().is_some_and(|note| note.to_lowercase().contains("estimate"));
            assert!(!estimated || says_so, "{}/{} is estimated and its note does not say how", vessel.name(), model.name);
        }
    }
}

#[test]
fn coefficients_of_prime_laws_have_no_dimension() {
    let zoo = zoo();
    for name in ["abkowitz", "polynomial", "mmg", "son-nomoto", "berlekom-goddard"] {
        let law = zoo.law(name).unwrap_or_else(|| panic!("{name} is missing"));
        for (axis, axis_law) in &law.axes {
            for term in axis_law.terms.keys() {
                let dimension = law.coefficient_dimension(term).unwrap_or_else(|error| panic!("{error}"));
                assert_eq!(dimension.to_string(), "1", "{name} {axis} {term}");
            }
        }
    }
}
