//! Whether a learned branch is taken beside what the plain call makes, by the number of trials, and
//! what it does to manoeuvres that no call saw. Ships with a rudder that stalls, which no law of the
//! library says, and the same ships without.
//!
//! `cargo run --release -p sistership-tests --example branch_choice [SEED]`, some minutes.

use std::path::Path;

use sistership_learned::{BranchSettings, Kinds, Training, attach, choose, train, with_branch};
use sistership_model::{Law, Model, Trial, Zoo};
use sistership_simulation::Ship;
use sistership_simulation::error::{SquaredError, standard_deviations, standardised_mse};
use sistership_simulation::recorded::{ReplaySettings, replay};
use sistership_tests::binary;
use sistership_tests::truth::container::container;
use sistership_tests::truth::ferry::ferry;
use sistership_tests::truth::files::{write_trials, write_vessel};
use sistership_tests::truth::instruments::Instruments;
use sistership_tests::truth::manoeuvre::{PROGRAMME, UNSEEN};
use sistership_tests::truth::model_tanker::model_tanker;
use sistership_tests::truth::motion::Truth;
use sistership_tests::truth::stalled::Stalled;
use sistership_tests::truth::tanker::tanker;
use sistership_tests::truth::trials;

/// Numbers of trials: those of the programme from its beginning.
const TRIALS: [usize; 4] = [4, 6, 8, 12];

fn main() {
    let seed = std::env::args().nth(1).map_or(1, |seed| seed.parse().expect("a seed"));
    let zoo = Zoo::embedded().unwrap_or_else(|error| panic!("{error}"));
    println!(
        "| ship | trials | law alone, left out | best branch | its error | sure to | taken | \
        unseen: law alone | with branch |"
    );
    println!("| --- | --: | --: | --- | --: | --: | --- | --: | --: |");
    for (name, ship) in ships() {
        let instruments = Instruments::of(&*ship);
        let seen = trials(&*ship, &PROGRAMME, &instruments, seed);
        let unseen = trials(&*ship, &UNSEEN, &instruments.without_noise(), seed);
        for count in TRIALS {
            let seen: Vec<&Trial> = seen[..count].iter().collect();
            row(&zoo, (name, &*ship), &seen, &unseen);
        }
    }
}

fn ships() -> [(&'static str, Box<dyn Truth>); 8] {
    [
        ("tanker", Box::new(tanker())),
        ("ferry", Box::new(ferry())),
        ("container ship", Box::new(container())),
        ("model", Box::new(model_tanker())),
        ("tanker, stalls", Box::new(Stalled(tanker()))),
        ("ferry, stalls", Box::new(Stalled(ferry()))),
        ("container ship, stalls", Box::new(Stalled(container()))),
        ("model, stalls", Box::new(Stalled(model_tanker()))),
    ]
}

fn row(zoo: &Zoo, (name, ship): (&str, &dyn Truth), seen: &[&Trial], unseen: &[Trial]) {
    let alone = refined(zoo, ship, seen);
    let law = zoo.law(&alone.law).expect("a law of the zoo");
    let asked = (&BranchSettings::default(), Kinds::WhilePromising { step_s: 0.5 });
    let choice = choose(&alone, law, seen, asked, &|_| true);
    let choice = choice.unwrap_or_else(|error| panic!("{error}")).expect("it was not stopped");
    let best = choice.tried.iter().min_by(|a, b| a.branch.total_cmp(&b.branch));
    let Some(best) = best else {
        return println!("| {name} | {} | {} |", seen.len(), choice.reason);
    };
    let training = asked.0.of(best.kind).training(&alone, law, seen);
    let training = training.unwrap_or_else(|error| panic!("{error}"));
    let both = joined(&alone, law, seen, &training);
    let [before, after] = [&alone, &both].map(|model| error(law, model, ship, unseen));
    println!(
        "| {name} | {} | {:.4} | {} | {:.4} | {:.4} | {} | {before:.5} | {after:.5} |",
        seen.len(),
        best.foundation,
        best.kind.name(),
        best.branch,
        best.standard_error,
        if choice.taken.is_some() { "yes" } else { "no" }
    );
}

/// The law that the plain call makes, without a branch.
fn refined(zoo: &Zoo, ship: &dyn Truth, seen: &[&Trial]) -> Model {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |path: &Path| path.display().to_string();
    let vessel = path(&write_vessel(folder.path(), ship.dimensions()));
    let manifest = path(&write_trials(folder.path(), &ship.dimensions().name, seen));
    let out = path(&folder.path().join("model.yaml"));
    binary::json(&["refine", "--ship", &vessel, "--trials", &manifest, "--out", &out, "--json"], 0);
    let text = std::fs::read_to_string(&out).expect("a model");
    let model = Model::parse("model.yaml", &text, &|law| zoo.law(law).map(|law| (**law).clone()));
    model.unwrap_or_else(|error| panic!("{error}")).foundation()
}

fn joined(alone: &Model, law: &Law, seen: &[&Trial], training: &Training) -> Model {
    let (branch, weights) =
        train(alone, law, seen, training).unwrap_or_else(|error| panic!("{error}"));
    let mut both = with_branch(alone, branch);
    let bytes = weights.bytes().unwrap_or_else(|error| panic!("{error}"));
    attach(&mut both, &bytes).unwrap_or_else(|error| panic!("{error}"));
    both
}

/// The mean over u, v, r, psi, x, y of the standardised squared error; simulations start anew every
/// ten lengths. One that leaves the physical range counts as 10.
fn error(law: &Law, model: &Model, truth: &dyn Truth, unseen: &[Trial]) -> f64 {
    let mut ship = Ship::new(model, law).unwrap_or_else(|error| panic!("{error}"));
    ship.set_envelope_speed(truth.dimensions().speed_m_s);
    let restart_s = Some(10.0 * truth.dimensions().length_time_s());
    let settings = ReplaySettings { restart_s, ..ReplaySettings::default() };
    let mut sum = SquaredError::default();
    for trial in unseen {
        let run = replay(&ship, trial, &settings).unwrap_or_else(|error| panic!("{error}"));
        if run.stopped.is_some() {
            return 10.0;
        }
        sum.add(&SquaredError::of(trial, &run));
    }
    standardised_mse(&sum, &standard_deviations(&unseen.iter().collect::<Vec<_>>())) / 6.0
}
