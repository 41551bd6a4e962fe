//! How long a diagnosis takes: six trials of 650 s at 2 Hz, all single effects and pairs. Tests are not built for speed, so
//! that the time is printed and not judged.

use std::time::Instant;

use sistership_diagnose::{Request, Settings, diagnose};
use sistership_model::Trial;

use super::baseline::{BASELINE, library};
use super::cases::programme;
use super::truth::{Hidden, effect, trials};

#[test]
fn the_time_of_a_diagnosis() {
    let current = effect("current", "constant", &[("north_m_s", 0.4), ("east_m_s", 0.4)]);
    let hides = [("nothing", Vec::new()), ("a current", vec![current])];
    let (settings, effects) = (Settings::default(), library());
    for (what, hidden) in hides {
        let trials = trials(&Hidden { effects: hidden, ..Hidden::default() }, &programme(), 1);
        let trials: Vec<&Trial> = trials.iter().collect();
        let request =
            Request { model: &BASELINE.model, law: &BASELINE.law, effects: &effects, trials: &trials, settings: &settings };
        let started = Instant::now();
        let diagnosis = diagnose(&request, &|_, _| true).unwrap_or_else(|error| panic!("{error}"));
        let seconds = started.elapsed().as_secs_f64();
        println!("{what} hidden: {seconds:.2} s, {} hypotheses", diagnosis.hypotheses.len());
    }
}
