//! Files as people have them: imported without editing, and refined as well as canonical files.

mod broken;
mod containers;
mod formats;
mod forms;
mod long_log;
mod revolutions;
mod table;
mod templates;

use std::path::{Path, PathBuf};

use forms::{FORMS, Form};
use serde_json::Value;
use sistership_model::Trial;
use sistership_tests::binary;

use crate::sea_trials;

/// The error from a form by that from canonical files may be so much more.
const WITHIN: f64 = 1.05;
/// The same for NMEA 0183.
const WITHIN_SENTENCES: f64 = 1.1;

/// A folder with a ship and its trials in a form; the paths of the trials' files.
fn folder(form: &Form, trials: &[Trial]) -> (tempfile::TempDir, Vec<PathBuf>) {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("ship.yaml"), sea_trials::ship()).expect("written");
    let mut paths = Vec::new();
    for (k, trial) in trials.iter().enumerate() {
        for (name, bytes) in (form.write)(trial, k) {
            let path = folder.path().join(name);
            std::fs::write(&path, bytes).expect("written");
            paths.push(path);
        }
    }
    (folder, paths)
}

/// What `import` answers for some files.
fn import(folder: &Path, files: &[PathBuf], status: i32) -> Value {
    let out = folder.join("trials.yaml");
    let names: Vec<&str> = files.iter().filter_map(|file| file.to_str()).collect();
    let fixed = ["--ship", sea_trials::NAME, "--out", out.to_str().expect("text"), "--json"];
    binary::json(&[&["import"][..], &names, &fixed].concat(), status)
}

/// No bands, and the noise model of one trial: neither is looked at here.
const SETTINGS: &str =
    "method: weak\nfamilies: [own]\nbands: { samples: 0 }\ncalibration_samples: 1\n";

/// The heading's error on manoeuvres left out, by one and the same explicit call.
fn refined(folder: &Path) -> f64 {
    std::fs::write(folder.join("settings.yaml"), SETTINGS).expect("written");
    let path = |name: &str| folder.join(name).to_str().expect("text").to_owned();
    let (ship, trials, settings) = (path("ship.yaml"), path("trials.yaml"), path("settings.yaml"));
    let call = ["refine", "--ship", &ship, "--source", "mariner", "--trials", &trials];
    let answer = binary::json(&[&call[..], &["--settings", &settings, "--json"]].concat(), 0);
    answer["held_out"]["refined"]["psi"].as_f64().unwrap_or_else(|| panic!("{answer}"))
}

#[test]
fn every_form_is_imported_and_refined_like_canonical_files() {
    let trials = sea_trials::trials();
    let error = |form: &Form| {
        let (folder, files) = folder(form, &trials);
        let answer = import(folder.path(), &files, 0);
        assert_eq!(answer["trials"].as_array().map(Vec::len), Some(trials.len()), "{}", form.name);
        refined(folder.path())
    };
    let canonical = error(&FORMS[0]);
    let mut worse = Vec::new();
    for form in &FORMS[1..] {
        let ratio = error(form) / canonical;
        println!("{:<42} {ratio:.3}", form.name);
        // Sentences have fewer digits than the other forms: 0.1 kn and 0.1 deg.
        let within = if form.name.contains("NMEA") { WITHIN_SENTENCES } else { WITHIN };
        if ratio > within {
            worse.push(format!("{}: {ratio:.3}", form.name));
        }
    }
    assert!(worse.is_empty(), "{worse:?}");
}
