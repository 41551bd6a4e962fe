//! The SR108 container ship by another group's simulation with roll.

use std::path::Path;

use sistership_model::Trial;
use sistership_tests::shared;
use sistership_trials::load_path;

use super::DataSet;
use sistership_tests::truth::files::write_trials;

/// Ten of its lengths at 20.4 knots.
const RESTART_S: f64 = 167.0;

/// Six trials with noise at 20.4 knots (zigzags 10/10 and 12/5, turns at 12 deg) for the calls;
/// turns at 7.5 deg to both sides at the same speed, without noise, for judgement.
pub fn sr108() -> Option<DataSet> {
    let (examples, reference) = (shared::data("sr108/examples")?, shared::data("sr108/reference")?);
    let seen = read(&examples, "i_control");
    let unseen = read(&reference, "turn_20.4kn");
    let folder = tempfile::tempdir().expect("a folder");
    let trials = write_trials(folder.path(), "sr108", &seen.iter().collect::<Vec<_>>());
    Some(DataSet::new("sr108".into(), (trials, folder), (seen, unseen), RESTART_S))
}

fn read(folder: &Path, prefix: &str) -> Vec<Trial> {
    let entries = std::fs::read_dir(folder).expect("the folder").flatten().map(|e| e.path());
    let begins = |path: &Path| {
        path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(prefix))
    };
    let mut files: Vec<_> = entries.filter(|path| begins(path)).collect();
    files.sort();
    let one = |file: &std::path::PathBuf| {
        let loaded = load_path(file).unwrap_or_else(|error| panic!("{error}")).trials.remove(0);
        loaded.unwrap_or_else(|refusal| panic!("{refusal}"))
    };
    files.iter().map(one).collect()
}
