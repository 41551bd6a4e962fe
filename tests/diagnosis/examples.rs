//! The examples of `../shared/data/sr108`: nothing hidden, a current, a rudder that stands askew.

use std::path::Path;
use std::sync::LazyLock;

use sistership_diagnosis::{Diagnosis, DiagnosisInputs, Settings, Verdict, diagnose};
use sistership_model::{Law, Model, Trial};
use sistership_tests::shared;
use sistership_trials::load_path;

use sistership_tests::hidden_effects::baseline::{Baseline, fitted, library};
use sistership_tests::hidden_effects::truth::{ZOO, published};

fn trials(folder: &Path, kind: &str) -> Vec<Trial> {
    let mut files: Vec<_> =
        std::fs::read_dir(folder).unwrap().map(|file| file.unwrap().path()).collect();
    files.retain(|file| {
        file.file_name().is_some_and(|name| name.to_string_lossy().starts_with(kind))
    });
    files.sort();
    assert_eq!(files.len(), 6, "{kind}");
    let read = |file: &std::path::PathBuf| {
        let trial = load_path(file).unwrap_or_else(|error| panic!("{error}")).trials.remove(0);
        trial.unwrap_or_else(|refusal| panic!("{refusal}"))
    };
    files.iter().map(read).collect()
}

fn diagnosed(model: &Model, law: &Law, kind: &str) -> Option<Diagnosis> {
    let folder = shared::data("sr108/examples")?;
    let trials = trials(&folder, kind);
    let trials: Vec<&Trial> = trials.iter().collect();
    let (settings, effects) = (Settings::default(), library());
    let request =
        DiagnosisInputs { model, law, effects: &effects, trials: &trials, settings: &settings };
    let diagnosis =
        diagnose(&request, &|_, _| true).unwrap_or_else(|error| panic!("{kind}: {error}"));
    println!("{kind} by {}: {:?}", model.name, diagnosis.verdict);
    for found in &diagnosis.effects {
        println!(
            "  {}/{} evidence {:.1}: {:?}",
            found.name, found.form, found.evidence, found.parameters
        );
    }
    println!(
        "  unexplained {:?}\n  before {:?}\n  after {:?}",
        diagnosis.unexplained, diagnosis.before, diagnosis.after
    );
    Some(diagnosis)
}

/// A parameter of the effect that is named first, which must be the only one.
fn parameter(diagnosis: &Diagnosis, effect: &str, name: &str) -> f64 {
    let named: Vec<&str> = diagnosis.effects.iter().map(|found| found.name.as_str()).collect();
    assert_eq!(named.first(), Some(&effect), "{named:?}");
    diagnosis.effects[0].parameters[name].value
}

fn judge_current(model: &Model, law: &Law) {
    let Some(diagnosis) = diagnosed(model, law, "b_current06") else { return };
    let (speed, towards) = (
        parameter(&diagnosis, "current", "speed_m_s"),
        parameter(&diagnosis, "current", "towards_deg"),
    );
    assert!(
        (speed - 0.6).abs() < 0.02 && (towards - 45.0).abs() < 2.0,
        "{speed} m/s towards {towards} deg"
    );
}

fn judge_rudder_offset(model: &Model, law: &Law) {
    let Some(diagnosis) = diagnosed(model, law, "c_rudder_offset1p5") else { return };
    let offset = parameter(&diagnosis, "rudder-offset", "offset_deg");
    assert!((offset - 1.5).abs() < 0.05, "{offset} deg");
}

/// The zoo's own model of it, as published.
fn as_published() -> (Model, &'static Law) {
    let model = published();
    let law = ZOO.law(&model.law).unwrap();
    (model, law)
}

/// The Mariner, refined on the control.
static REFINED: LazyLock<Option<Baseline>> = LazyLock::new(|| {
    let trials = trials(&shared::data("sr108/examples")?, "i_control");
    Some(fitted("mariner", "sr108", &trials.iter().collect::<Vec<_>>()))
});

#[test]
fn the_control_is_complete() {
    let (model, law) = as_published();
    let Some(diagnosis) = diagnosed(&model, law, "i_control") else { return };
    assert_eq!((diagnosis.verdict, diagnosis.effects.len()), (Verdict::Complete, 0));
}

#[test]
fn the_current_is_found_with_the_published_model() {
    let (model, law) = as_published();
    judge_current(&model, law);
}

#[test]
fn the_rudder_offset_is_found_with_the_published_model() {
    let (model, law) = as_published();
    judge_rudder_offset(&model, law);
}

#[test]
fn the_current_is_found_with_a_refined_model() {
    let Some(baseline) = &*REFINED else { return };
    judge_current(&baseline.model, &baseline.law);
}

#[test]
fn the_rudder_offset_is_found_with_a_refined_model() {
    let Some(baseline) = &*REFINED else { return };
    judge_rudder_offset(&baseline.model, &baseline.law);
}
