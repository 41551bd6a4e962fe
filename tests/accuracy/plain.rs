//! The plain call on a ship whose law the zoo does not have: not worse than the source that it
//! started from.

use std::path::Path;

use serde_json::Value;
use sistership_learned::attach;
use sistership_model::{Model, Trial, Vessel, Zoo};
use sistership_priors::source::{best_source, rank_similar};
use sistership_priors::transfer::{transfer_model, trial_approach};
use sistership_simulation::Ship;
use sistership_simulation::error::{SquaredError, standard_deviations, standardised_mse};
use sistership_simulation::recorded::{ReplaySettings, replay_trial};
use sistership_tests::binary;
use sistership_tests::truth::container::container;
use sistership_tests::truth::dimensions::Dimensions;
use sistership_tests::truth::ferry::ferry;
use sistership_tests::truth::files::{vessel, write_trials, write_vessel};
use sistership_tests::truth::instruments::Instruments;
use sistership_tests::truth::manoeuvre::{PROGRAMME, UNSEEN};
use sistership_tests::truth::motion::Truth;
use sistership_tests::truth::stalled::Stalled;
use sistership_tests::truth::tanker::tanker;
use sistership_tests::truth::trials;
use tempfile::TempDir;

/// Trials of the call, and of its judgement.
const TRIALS: usize = 4;
const JUDGED: usize = 3;
/// The model may be worse than the source by so much.
const SLACK: f64 = 1.05;

/// The mean over u, v, r, psi, x, y of the standardised squared error; simulations start anew every
/// ten lengths.
fn error(zoo: &Zoo, model: &Model, size: &Dimensions, unseen: &[Trial]) -> f64 {
    let law = zoo.law(&model.law).expect("a law of the zoo");
    let mut ship = Ship::new(model, law).unwrap_or_else(|error| panic!("{error}"));
    ship.set_envelope_speed(size.speed_m_s);
    let restart_s = Some(10.0 * size.length_time_s());
    let settings = ReplaySettings { restart_s, ..ReplaySettings::default() };
    let mut sum = SquaredError::default();
    for trial in unseen {
        let run = replay_trial(&ship, trial, &settings).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(run.stopped, None, "{} by {}", trial.name, model.name);
        sum.add(&SquaredError::from_trial(trial, &run));
    }
    standardised_mse(&sum, &standard_deviations(&unseen.iter().collect::<Vec<_>>())) / 6.0
}

/// The source that the ranking has first, put on the ship's particulars.
fn unrefined(zoo: &Zoo, seen: &[&Trial]) -> Model {
    let target = Vessel::parse("ferry.yaml", &vessel(ferry().dimensions()));
    let target = target.unwrap_or_else(|error| panic!("{error}"));
    let source = best_source(zoo, &rank_similar(zoo, &target, None, seen));
    let source = source.unwrap_or_else(|reason| panic!("{reason}"));
    let law = zoo.law(&source.law).expect("the law of a zoo model");
    transfer_model(&source, law, &target, trial_approach(seen))
}

/// What the plain call makes of a ship's trials, `model.yaml` in a folder, and what it says.
fn refined(ship: &dyn Truth, seen: &[&Trial]) -> (TempDir, Value) {
    let folder = tempfile::tempdir().expect("a folder");
    let vessel = write_vessel(folder.path(), ship.dimensions()).display().to_string();
    let manifest = write_trials(folder.path(), &ship.dimensions().name, seen);
    let manifest = manifest.display().to_string();
    let out = folder.path().join("model.yaml").display().to_string();
    let call = ["refine", "--ship", &vessel, "--trials", &manifest, "--out", &out, "--json"];
    (folder, binary::json(&call, 0))
}

/// The model that was written, with the weights of its branch where it has one.
fn read(zoo: &Zoo, folder: &Path) -> Model {
    let text = std::fs::read_to_string(folder.join("model.yaml")).expect("a model");
    let model = Model::parse("model.yaml", &text, &|law| zoo.law(law).map(|law| (**law).clone()));
    let mut model = model.unwrap_or_else(|error| panic!("{error}"));
    if model.branch.is_some() {
        let weights = std::fs::read(folder.join("model.weights.json")).expect("weights");
        attach(&mut model, &weights).unwrap_or_else(|error| panic!("{error}"));
    }
    model
}

/// Error of the best correction by that of the law alone, on trials held out of both.
fn held_out_ratio(branch: &Value) -> f64 {
    let ratio = |tried: &Value| Some(tried["branch"].as_f64()? / tried["foundation"].as_f64()?);
    let tried = branch["tried"].as_array().expect("kinds of corrections");
    tried.iter().filter_map(ratio).fold(f64::INFINITY, f64::min)
}

/// Where a rudder stalls a correction explains a part of what the law leaves on held-out trials;
/// whether it is used depends on its checks, and what is used is better on unseen trials.
#[test]
fn a_correction_explains_a_rudder_that_stalls_and_is_not_taken_where_the_law_holds() {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    for (ship, is_stalled) in [(&Stalled(container()) as &dyn Truth, true), (&tanker(), false)] {
        let instruments = Instruments::of(ship);
        let seen = trials(ship, &PROGRAMME, &instruments, 1);
        let unseen = trials(ship, &UNSEEN, &instruments.without_noise(), 1);
        let (folder, said) = refined(ship, &seen.iter().collect::<Vec<_>>());
        let both = read(&zoo, folder.path());
        let (alone, size) = (both.without_correction(), ship.dimensions());
        let [alone, with] = [&alone, &both].map(|model| error(&zoo, model, size, &unseen));
        println!("law alone {alone:.5}, as written {with:.5}: {}", said["ladder"]["branch"]);
        let lines = said["ladder"]["lines"].as_array().expect("what was tried");
        assert!(lines.iter().any(|line| line["source"] == "population"), "of twelve trials, too");
        assert_eq!(lines.iter().filter(|line| line["reference"] == true).count(), 1);
        let branch = &said["ladder"]["branch"];
        assert!(held_out_ratio(branch) < 0.95 || !is_stalled, "{branch}");
        assert!(is_stalled || both.branch.is_none(), "{branch}");
        assert!(both.branch.is_none() || with < alone, "{with} against {alone}");
    }
}

#[test]
fn the_plain_call_on_a_ferry_is_not_worse_than_its_source() {
    let zoo = Zoo::load_embedded().unwrap_or_else(|error| panic!("{error}"));
    let ship = ferry();
    let instruments = Instruments::of(&ship);
    let seen = trials(&ship, &PROGRAMME[..TRIALS], &instruments, 1);
    let unseen = trials(&ship, &UNSEEN[..JUDGED], &instruments.without_noise(), 1);
    let seen: Vec<&Trial> = seen.iter().collect();
    let (folder, _) = refined(&ship, &seen);
    let model = read(&zoo, folder.path());
    let size = ship.dimensions();
    let before = error(&zoo, &unrefined(&zoo, &seen), size, &unseen);
    let after = error(&zoo, &model, size, &unseen);
    println!("unrefined {before:.4}, plain {after:.4} by {} ({})", model.name, model.law);
    assert!(after <= SLACK * before, "{after} against {before}");
}
