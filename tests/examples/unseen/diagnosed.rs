//! One case: trials sailed, written, and given to `sistership diagnose`.

use std::collections::BTreeMap;

use serde_json::Value;
use sistership_model::Trial;
use sistership_tests::truth::causes::trials;
use sistership_tests::truth::files::write_trials;

use crate::cases::{Case, courses};
use crate::outcome::Outcome;
use crate::program::Program;
use crate::ships::{Refined, TrueShip};

/// Runs a case.
///
/// # Panics
/// The program refuses.
pub fn run(program: &Program, ship: &TrueShip, model: &Refined, case: Case) -> Outcome {
    let (answer, durations_s, wall_s) = answer(program, ship, model, &case);
    let outcome = Outcome::new(ship.name(), case, &answer, &durations_s, wall_s);
    println!("{}", outcome.line());
    outcome
}

/// Durations of trials by name, s.
pub type Durations = BTreeMap<String, f64>;

/// The document of a case, the durations of its trials and how long the call took, s.
///
/// # Panics
/// The program refuses.
pub fn answer(
    program: &Program,
    ship: &TrueShip,
    model: &Refined,
    case: &Case,
) -> (Value, Durations, f64) {
    let courses = courses(case);
    let sailed = trials(&*ship.truth, &case.hidden, &courses, &ship.instruments(), case.seed);
    let folder = tempfile::tempdir().expect("a folder");
    let files = write_trials(folder.path(), &ship.name(), &sailed.iter().collect::<Vec<&Trial>>());
    let words = [model.path.display().to_string(), files.display().to_string()];
    let (answer, wall_s) =
        program.asked(&["diagnose", "--model", &words[0], "--trials", &words[1]]);
    let answer = answer.unwrap_or_else(|error| panic!("{}, {}: {error}", ship.name(), case.label));
    let duration = |trial: &Trial| Some((trial.name.clone(), *trial.t_s.last()?));
    (answer, sailed.iter().filter_map(duration).collect(), wall_s)
}
