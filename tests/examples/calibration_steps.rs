//! What calibration learns from samples at several distances: time, discrepancies, instruments,
//! systematic errors and remainders, each by those of every sample.
//!
//! `cargo run --release -p sistership-tests --example calibration_steps -- MODEL.yaml TRIALS.yaml`,
//! where the model was refined on the trials. `docs/evidence/plain.md` has a table.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Instant;

use sistership_diagnose::calibrate;
use sistership_model::uncertainty::Uncertainty;
use sistership_model::{Model, Trial, Zoo};
use sistership_tests::hidden_effects::baseline::library;
use sistership_trials::load_path;

/// Shortest intervals between samples, by the time in which the ship sails its length.
const STEPS: [f64; 4] = [0.02, 0.04, 0.08, 0.16];

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
    let learned = |step: Option<f64>| {
        let begun = Instant::now();
        let learned = calibrate(&model, law, &library(), &trials, step).expect("calibrated");
        (begun.elapsed().as_secs_f64(), learned)
    };
    let (seconds, every) = learned(None);
    println!("every sample: {seconds:.1} s; {}", errors_of(&every));
    println!("{:>5} {:>6}  all else by that of every sample", "step", "s");
    for step in STEPS {
        let (seconds, coarse) = learned(Some(step));
        println!("{step:5.2} {seconds:6.1}  {}", compared(&coarse, &every));
    }
}

fn errors_of(learned: &Uncertainty) -> String {
    let named = learned.systematic_errors.iter().map(|one| format!("{one:?}"));
    format!("systematic errors: {}", named.collect::<Vec<_>>().join("; "))
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
    format!("{}; {}", ratios.collect::<Vec<_>>().join(", "), errors_of(one))
}
