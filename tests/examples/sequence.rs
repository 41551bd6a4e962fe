//! Thirty uploads of one trial each, with a rudder offset from the tenth on: when it is named by
//! diagnoses in sequence, by each trial alone, and by one diagnosis of all trials so far.
//!
//! `cargo run --release -p sistership-tests --example sequence`; `SEQUENCE_OFFSET_DEG=0.3` and
//! `SEQUENCE_SEED=1` set size and noise.

use std::time::Instant;

use sistership_diagnosis::{Diagnosis, Settings};
use sistership_tests::hidden_effects::baseline::{BASELINE, diagnosed};
use sistership_tests::hidden_effects::sequence::{Uploads, effect_names, in_sequence};

fn main() {
    let number = |name: &str, default: f64| {
        std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(default)
    };
    let offset_rad = number("SEQUENCE_OFFSET_DEG", 0.3_f64).to_radians();
    let uploads = Uploads { count: 30, first: 10, offset_rad };
    let trials = uploads.trials(number("SEQUENCE_SEED", 1.0) as u64);
    println!("model {}", BASELINE.model.name);
    let started = Instant::now();
    let sequence = in_sequence(&trials);
    let seconds = started.elapsed().as_secs_f64() / trials.len() as f64;
    println!("| upload | in sequence | size, deg | alone |\n| --: | --- | --: | --- |");
    for (trial, diagnosis) in trials.iter().zip(&sequence) {
        let alone = diagnosed(&BASELINE, std::slice::from_ref(trial), &Settings::default());
        let name = trial.name.trim_start_matches("upload ");
        println!("| {name} | {} | {} | {} |", told(diagnosis), size(diagnosis), told(&alone));
    }
    println!("a diagnosis in sequence takes {seconds:.1} s");
    let started = Instant::now();
    let all = diagnosed(&BASELINE, &trials, &Settings::default());
    let seconds = started.elapsed().as_secs_f64();
    println!("one diagnosis of all: {}, {} deg, {seconds:.1} s", told(&all), size(&all));
}

fn told(diagnosis: &Diagnosis) -> String {
    let one = |found: &sistership_diagnosis::MissingEffect| {
        format!("{} {:.0}", found.name, found.evidence)
    };
    match diagnosis.effects.is_empty() {
        true => format!("{:?}", diagnosis.verdict).to_lowercase(),
        false => diagnosis.effects.iter().map(one).collect::<Vec<_>>().join(", "),
    }
}

/// Size of the offset that was found, with its standard error.
fn size(diagnosis: &Diagnosis) -> String {
    let is_found = effect_names(diagnosis).contains(&"rudder-offset");
    let found = diagnosis.effects.iter().find(|found| found.name == "rudder-offset");
    let size = found.filter(|_| is_found).and_then(|found| found.parameters.get("offset_deg"));
    size.map_or(String::new(), |size| format!("{:.2} +- {:.2}", size.value, size.se))
}
