//! The confusion table: every hidden effect against what the diagnosis names.

mod known;
mod outcome;
mod table;
mod targets;

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use outcome::Outcome;
use sistership_diagnosis::{DiagnosisInputs, Settings, diagnose};
use sistership_model::Trial;

use super::baseline::{BASELINE, library};
use super::cases::{Case, Part, cases, programme};
use super::truth::trials;

/// Diagnoses the cases of a part, prints the table, and gives the targets that are missed.
pub fn confusion(part: &Part) -> Vec<String> {
    let cases = cases(part);
    println!("model {}, {} cases", BASELINE.model.name, cases.len());
    let started = Instant::now();
    let outcomes = in_parallel(&cases, run);
    println!("{:.0} s in all", started.elapsed().as_secs_f64());
    table::print(&outcomes);
    targets::print(&outcomes)
}

/// What is named in a case, the first thing first; nothing where nothing is.
pub fn named(label: &str, share: f64) -> Vec<String> {
    let part = Part {
        cases: Some(vec![label.to_owned()]),
        strengths: vec![share],
        seeds: 1,
        is_judged: false,
    };
    cases(&part).first().map(|case| run(case).named).unwrap_or_default()
}

/// Every case in its place, on as many threads as there are cores.
fn in_parallel<T: Send>(cases: &[Case], run: impl Fn(&Case) -> T + Sync) -> Vec<T> {
    let next = AtomicUsize::new(0);
    let done = Mutex::new(Vec::new());
    let work = || {
        while let Some((place, case)) =
            Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|k| Some((k, cases.get(k)?)))
        {
            let outcome = run(case);
            done.lock().unwrap().push((place, outcome));
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(work))));
    let mut done = done.into_inner().unwrap();
    done.sort_by_key(|(place, _)| *place);
    done.into_iter().map(|(_, outcome)| outcome).collect()
}

fn run(case: &Case) -> Outcome {
    let trials = trials(&case.hidden, &programme(), case.seed);
    let trials: Vec<&Trial> = trials.iter().collect();
    let (settings, effects) = (Settings::default(), library());
    let request = DiagnosisInputs {
        model: &BASELINE.model,
        law: &BASELINE.law,
        effects: &effects,
        trials: &trials,
        settings: &settings,
    };
    let started = Instant::now();
    let diagnosis =
        diagnose(&request, &|_, _| true).unwrap_or_else(|error| panic!("{}: {error}", case.label));
    let seconds = started.elapsed().as_secs_f64();
    let outcome = Outcome::new(case, &diagnosis, &trials, seconds);
    println!("{}", outcome.line());
    outcome
}
