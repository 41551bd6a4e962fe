//! Wind that nobody declares, on random divisions of the measured Esso Osaka trials: half are
//! fitted by a law without wind, the others diagnosed, and again with the wind of another time (a
//! placebo).
//!
//! `cargo run --release -p sistership-tests --example divisions -- FIRST COUNT`; ten from the first
//! where nothing is said, two at once. `docs/evidence/diagnosis_unseen.md` has the results.

use std::time::Instant;

use rayon::prelude::*;
use sistership_diagnosis::Diagnosis;
use sistership_model::Trial;
use sistership_tests::undeclared_wind::{
    baseline, diagnosed, divided, names_wind, trials, with_placebo,
};

/// What came of one division.
struct Outcome {
    seed: usize,
    interval_s: Option<f64>,
    wind: Diagnosis,
    placebo: Diagnosis,
}

impl Outcome {
    fn of(all: &[Trial], seed: usize) -> Self {
        let [fit, judged] = divided(all, seed);
        let baseline = baseline(&fit);
        let false_wind: Vec<Trial> = judged.iter().map(with_placebo).collect();
        let known = baseline.model.uncertainty.as_ref();
        Self {
            seed,
            interval_s: known.map(|known| known.reading_interval_s),
            wind: diagnosed(&baseline, &judged),
            placebo: diagnosed(&baseline, &false_wind),
        }
    }

    fn is_right(&self) -> bool {
        names_wind(&self.wind) && !names_wind(&self.placebo)
    }

    fn print(&self) {
        let factor = |channel: &str| self.wind.before[channel] / self.wind.after[channel];
        println!(
            "| {} | {:.2} | {} | {} | {:.2} | {:.2} |",
            self.seed,
            self.interval_s.unwrap_or_default(),
            named(&self.wind),
            named(&self.placebo),
            factor("v"),
            factor("r")
        );
    }
}

/// Names with their evidence.
fn named(diagnosis: &Diagnosis) -> String {
    let one = |found: &sistership_diagnosis::MissingEffect| {
        format!("{} {:.0}", found.name, found.evidence)
    };
    diagnosis.effects.iter().map(one).collect::<Vec<_>>().join(", ")
}

fn main() {
    let Some(all) = trials() else { return };
    let mut given = std::env::args().skip(1).map(|word| word.parse::<usize>().expect("a number"));
    let (first, count) = (given.next().unwrap_or(0), given.next().unwrap_or(10));
    let begun = Instant::now();
    let outcomes: Vec<Outcome> =
        (first..first + count).into_par_iter().map(|seed| Outcome::of(&all, seed)).collect();
    println!("| division | readings apart, s | named | with the placebo | v, times better | r |");
    println!("| --: | --: | --- | --- | --: | --: |");
    outcomes.iter().for_each(Outcome::print);
    let right = outcomes.iter().filter(|outcome| outcome.is_right()).count();
    println!("\nright in {right} of {count}, {:.0} s", begun.elapsed().as_secs_f64());
}
