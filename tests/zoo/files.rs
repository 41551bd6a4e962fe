//! Every file of the zoo.

use std::collections::BTreeSet;
use std::path::PathBuf;

use sistership_model::Zoo;
use sistership_model::effect::EffectForm;
use sistership_model::vessel::Status;
use sistership_simulation::Ship;
use sistership_simulation::manoeuvre::{ManoeuvreSettings, simulate_standard_manoeuvres};

fn zoo() -> Zoo {
    Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn every_file_of_the_folders_reads() {
    let zoo = zoo();
    zoo.check_all().unwrap_or_else(|error| panic!("{error}"));
    let laws = zoo.laws().map(|law| law.name.clone()).collect();
    let effects = zoo.effects().map(|effect| effect.name.clone()).collect();
    let vessels = zoo.vessels().map(|vessel| vessel.name().to_owned()).collect();
    for (folder, names) in [("laws", laws), ("effects", effects), ("vessels", vessels)] {
        let files = file_names(folder);
        let unlike: Vec<&String> = files.symmetric_difference(&names).collect();
        assert!(
            unlike.is_empty(),
            "models/{folder}: {unlike:?} stand only as a file or only in the program; give each \
             file the `name` that it has inside, and build again"
        );
    }
}

/// Names of the YAML files of a folder of `models`, without their ending.
fn file_names(folder: &str) -> BTreeSet<String> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../models").join(folder);
    let files = std::fs::read_dir(&path).unwrap_or_else(|error| panic!("{folder}: {error}"));
    let name = |file: std::io::Result<std::fs::DirEntry>| {
        let name = file.expect("a listed file").file_name().into_string().expect("plain text");
        name.strip_suffix(".yaml").map(str::to_owned)
    };
    files.filter_map(name).collect()
}

#[test]
fn every_model_sails_the_standard_manoeuvres() {
    let zoo = zoo();
    for vessel in zoo.vessels() {
        for file in &vessel.file.models {
            let model = zoo
                .published_model(vessel, Some(&file.name))
                .unwrap_or_else(|error| panic!("{error}"));
            let ship = Ship::new(&model, zoo.law(&model.law).expect("checked"))
                .unwrap_or_else(|error| panic!("{error}"));
            let sailed = simulate_standard_manoeuvres(&ship, &ManoeuvreSettings::default());
            assert!(sailed.failures.is_empty(), "{}: {:?}", model.name, sailed.failures);
            let passed = sailed.imo.iter().filter(|criterion| criterion.pass == Some(true)).count();
            println!("{:<28} {passed} of {} IMO criteria", model.name, sailed.imo.len());
            assert!(
                sailed.turns.iter().all(|turn| turn.tactical_diameter_m.is_some()),
                "{} does not turn",
                model.name
            );
        }
    }
}

#[test]
fn every_number_has_a_source_and_estimates_are_labelled() {
    for vessel in zoo().vessels() {
        assert!(
            vessel.particulars.values().all(|quantity| !quantity.source.is_empty()),
            "{}",
            vessel.name()
        );
        for model in &vessel.file.models {
            let estimated = model.status == Status::Estimated;
            let says_so =
                model.note.as_ref().is_some_and(|note| note.to_lowercase().contains("estimate"));
            assert!(
                !estimated || says_so,
                "{}/{} is estimated and its note does not say how",
                vessel.name(),
                model.name
            );
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
                let dimension =
                    law.coefficient_dimension(term).unwrap_or_else(|error| panic!("{error}"));
                assert_eq!(dimension.to_string(), "1", "{name} {axis} {term}");
            }
        }
    }
}

#[test]
fn every_effect_reads_and_has_a_source() {
    let zoo = zoo();
    for effect in zoo.effects() {
        assert!(!effect.sources.is_empty(), "{} has no source", effect.name);
        assert!(
            effect.sources.values().all(|source| !source.citation.is_empty()),
            "{}",
            effect.name
        );
        assert!(zoo.effect_text(&effect.name).is_some_and(|text| text.contains("kind: effect")));
    }
}

#[test]
fn a_form_means_the_same_wherever_it_is_read() {
    for effect in zoo().effects() {
        for form in &effect.forms {
            let again = EffectForm::from_file(effect.acts_on, &form.file)
                .unwrap_or_else(|(field, message)| panic!("{field}: {message}"));
            assert_eq!(&again, form.as_ref(), "{}", effect.name);
        }
    }
}

#[test]
fn coefficients_that_shallow_water_scales_are_spelled_right() {
    let zoo = zoo();
    let form = &zoo.effect("shallow-water").expect("in the zoo").forms[0];
    let mmg = zoo.law("mmg").expect("in the zoo");
    for name in form.coefficients.keys() {
        assert!(mmg.unscaled_regressor(name).is_ok(), "{name}");
    }
    let of = |name: &str, depth: f64| {
        let lookup = |n: &str| particular(n).or((n == "draught_to_depth").then_some(depth));
        let nested = |n: &str| resolve(form, n, &lookup);
        form.coefficients[name].value(&nested).expect("every name is known")
    };
    for name in form.coefficients.keys() {
        let factors: Vec<f64> =
            [0.0, 0.2, 0.4, 0.6, 0.8].into_iter().map(|depth| of(name, depth)).collect();
        // The effective aspect ratio as published dips a little before it grows.
        assert!(factors.iter().all(|factor| (0.85..8.0).contains(factor)), "{name}: {factors:?}");
        assert!(factors[4] > 1.0 && (factors[0] - 1.0).abs() < 1e-9, "{name}: {factors:?}");
    }
}

fn resolve(form: &EffectForm, name: &str, known: &dyn Fn(&str) -> Option<f64>) -> Option<f64> {
    known(name).or_else(|| form.values.get(name)?.value(&|n| resolve(form, n, known)))
}

fn particular(name: &str) -> Option<f64> {
    // KVLCC2
    Some(match name {
        "lpp_m" => 320.0,
        "beam_m" => 58.0,
        "draught_m" => 20.8,
        "block_coefficient" => 0.81,
        _ => return None,
    })
}
