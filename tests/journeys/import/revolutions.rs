//! Trials whose recorder had no revolutions: `import` states them, and laws with a propeller fit.

use std::path::Path;

use sistership_model::Trial;
use sistership_model::trial::Channel;
use sistership_tests::binary;

use super::folder;
use super::forms::{Files, Form, one};
use crate::sea_trials;

/// Writes a trial without its revolutions.
fn without(trial: &Trial, k: usize) -> Files {
    let mut trial = trial.clone();
    trial.channels.remove(&Channel::N);
    one(k, "csv", sea_trials::csv(&trial))
}

#[test]
fn revolutions_that_were_not_recorded_are_stated_in_the_manifest() {
    let trials = sea_trials::few();
    let silent = Form { name: "without revolutions", write: without };
    let (folder, files) = folder(&silent, &trials);
    let path = |name: &str| folder.path().join(name).to_str().expect("text").to_owned();
    let (ship, manifest) = (path("ship.yaml"), path("trials.yaml"));
    let names: Vec<&str> = files.iter().filter_map(|file| file.to_str()).collect();
    let named = ["--ship", &ship, "--out", &manifest, "--json"];
    let answer = binary::json(&[&["import"][..], &names, &named].concat(), 0);
    assert!(answer["notes"].to_string().contains("constant engine order"), "{answer}");
    let loaded = sistership_trials::load_path(Path::new(&manifest)).expect("read");
    for (read, recorded) in loaded.trials.into_iter().zip(&trials) {
        let read = read.expect("accepted");
        let held = read.channel(Channel::N).expect("revolutions")[0];
        let true_n = recorded.channel(Channel::N).expect("revolutions")[0];
        assert!((0.6..1.4).contains(&(held / true_n)), "{held} for {true_n}");
    }
    std::fs::write(path("settings.yaml"), super::SETTINGS).expect("written");
    let call = ["refine", "--ship", &ship, "--source", "kcs", "--trials", &manifest];
    let settings = path("settings.yaml");
    let call = [&call[..], &["--settings", &settings, "--json"]].concat();
    let refined = binary::json(&call, 0);
    assert_eq!(refined["model"]["law"], "mmg", "{refined}");
}
