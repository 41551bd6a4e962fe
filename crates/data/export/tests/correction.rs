//! Models with a learned correction, exported and sailed beside our own simulation.
#![allow(clippy::unwrap_used)]

#[path = "../../../analysis/learned/tests/ships/mod.rs"]
mod foundation;
mod shared;

use std::process::Command;

use sistership_export::{ExportSubject, FORMATS, by_name};
use sistership_learned::attach;
use sistership_model::branch::{CorrectionMode, Learner};
use sistership_model::{Model, Zoo};

use foundation::{Foundation, learners, training};
use shared::programs::{by_c, run};
use shared::{Circle, Track, largest, sailed, written};

const MOST: f64 = 1e-6;

fn corrected(name: &str, learner: Learner, mode: CorrectionMode) -> Model {
    let (mut model, weights) = Foundation::of(name).trained(&training(learner, mode));
    attach(&mut model, &weights).unwrap();
    model
}

fn sails_alike(name: &str, learner: Learner, mode: CorrectionMode) {
    let zoo = Zoo::load_embedded().unwrap();
    let what = format!("{name} {} {mode:?}", learner.name());
    let (model, circle) = (corrected(name, learner, mode), Circle::of(&zoo, name, 10.0));
    let own = sailed(&shared::ship(&zoo, &model), &circle);
    let code = written(&zoo, &model, "c");
    let folder = tempfile::tempdir().unwrap();
    let difference = largest(&circle, &by_c(folder.path(), &code, &circle.arguments()), &own);
    println!("{what}: {difference:.1e}");
    assert!(difference < MOST, "{what}: {difference:e}");
    let alone = sailed(&shared::ship(&zoo, &model.without_correction()), &circle);
    assert!(largest(&circle, &alone, &own) > 1e-3, "{what}: the correction changes nothing");
}

#[test]
fn every_kind_acts_as_in_our_own_simulation() {
    for learner in learners() {
        sails_alike("mariner", learner, CorrectionMode::Parallel);
    }
    let [_, boosted, kernels, _] = learners();
    sails_alike("kvlcc2-7m", boosted, CorrectionMode::Parallel);
    sails_alike("mariner", kernels, CorrectionMode::Serial);
}

#[test]
fn a_correction_in_the_place_of_the_law_does_too() {
    let [_, boosted, kernels, _] = learners();
    sails_alike("mariner", boosted, CorrectionMode::Convert);
    sails_alike("kvlcc2-7m", kernels, CorrectionMode::Convert);
}

#[test]
fn every_format_writes_it() {
    let zoo = Zoo::load_embedded().unwrap();
    let [forest, ..] = learners();
    let model = corrected("mariner", forest, CorrectionMode::Parallel);
    for format in FORMATS {
        let own = written(&zoo, &model, format.name()).len();
        let alone = written(&zoo, &model.without_correction(), format.name()).len();
        assert!(
            own > alone + 1000,
            "{}: {own} bytes with a learned correction, {alone} without: write the operations of \
             the plan, which include it (`rates.rs`)",
            format.name()
        );
    }
}

#[test]
fn python_sails_it_as_we_do() {
    let there = Command::new("python3").arg("--version").output();
    if !there.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: no python3");
        return;
    }
    let zoo = Zoo::load_embedded().unwrap();
    let [.., network] = learners();
    let model = corrected("mariner", network, CorrectionMode::Parallel);
    let circle = Circle::of(&zoo, "mariner", 4.0);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("model.py");
    let code = written(&zoo, &model, "python");
    std::fs::write(&file, code).unwrap();
    let found = Track::read(&run(Command::new("python3").arg(&file).args(circle.arguments())));
    let own = sailed(&shared::ship(&zoo, &model), &circle);
    assert!(largest(&circle, &found, &own) < MOST);
}

#[test]
fn a_correction_without_its_weights_is_refused_by_their_hash() {
    let zoo = Zoo::load_embedded().unwrap();
    let [_, boosted, ..] = learners();
    let (model, _) =
        Foundation::of("mariner").trained(&training(boosted, CorrectionMode::Parallel));
    let law = zoo.law(&model.law).unwrap();
    let subject = ExportSubject { model: &model, law, version: None, sha256: String::new() };
    let refused = by_name("fmu2").unwrap().prepare(&subject).unwrap_err().to_string();
    let hash = &model.branch.as_ref().unwrap().weights_sha256;
    assert!(refused.contains(hash), "{refused}");
}
