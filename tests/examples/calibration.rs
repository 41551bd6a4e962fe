//! What the plain call's calibration learns, against that of every sample: time, discrepancies,
//! instruments, systematic errors and remainders.
//!
//! `cargo run --release -p sistership-tests --example calibration -- MODEL.yaml TRIALS.yaml`, where
//! the model was refined on the trials. `docs/evidence/plain.md` has the figures.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Instant;

use sistership_diagnose::calibrate;
use sistership_model::effect::AppliedEffect;
use sistership_model::quantity::Quantity;
use sistership_model::uncertainty::Uncertainty;
use sistership_model::{Model, Trial, Zoo};
use sistership_tests::hidden_effects::baseline::library;
use sistership_trials::load_path;

fn main() {
    let given: Vec<PathBuf> = std::env::args().skip(1).map(PathBuf::from).collect();
    let [model, trials] = given.as_slice() else { panic!("MODEL.yaml TRIALS.yaml") };
    let zoo = Zoo::embedded().expect("the zoo");
    let text = std::fs::read_to_string(model).expect("the model");
    let law = |name: &str| zoo.law(name).map(|law| (**law).clone());
    let model = Model::parse("model", &text, &law).expect("a model");
    let law = zoo.law(&model.law).expect("a law of the zoo");
    let loaded = load_path(trials).expect("the manifest");
    let trials: Vec<Trial> = loaded.trials.into_iter().map(|trial| trial.expect("read")).collect();
    let trials: Vec<&Trial> = trials.iter().collect();
    let learned = |is_thrifty: bool| {
        let begun = Instant::now();
        let learned = calibrate(&model, law, &library(), &trials, is_thrifty).expect("calibrated");
        (begun.elapsed().as_secs_f64(), learned)
    };
    let (whole, thrifty) = (learned(false), learned(true));
    println!("whole:   {:.1} s; {}", whole.0, errors_of(&whole.1));
    println!("thrifty: {:.1} s; {}", thrifty.0, errors_of(&thrifty.1));
    println!("thrifty by whole: {}", compared(&thrifty.1, &whole.1));
}

fn errors_of(learned: &Uncertainty) -> String {
    let value = |(name, quantity): (&String, &Quantity)| format!("{name} {:.3}", quantity.value);
    let one = |error: &AppliedEffect| {
        let values: Vec<String> = error.parameters.iter().map(value).collect();
        format!("{} {}", error.name, values.join(" "))
    };
    let named: Vec<String> = learned.systematic_errors.iter().map(one).collect();
    format!("systematic errors: {}", named.join("; "))
}

fn compared(one: &Uncertainty, other: &Uncertainty) -> String {
    let of = |learned: &Uncertainty| -> BTreeMap<String, f64> {
        let axes = learned.discrepancy.iter();
        let random = axes.map(|(axis, d)| (format!("{axis:?}"), d.deviation.hypot(d.white)));
        let read = learned.instruments.iter();
        let read = read.map(|(name, fit)| (name.clone(), fit.deviation_by_scatter));
        let rest = learned.remainder.iter().map(|(name, size)| (format!("left {name}"), *size));
        random.chain(read).chain(rest).collect()
    };
    let (one_of, other_of) = (of(one), of(other));
    let ratios = one_of.iter().filter_map(|(name, value)| {
        Some(format!("{name} {:.2}", value / other_of.get(name).filter(|v| **v > 0.0)?))
    });
    ratios.collect::<Vec<_>>().join(", ")
}
