//! The measured trials of the Esso Osaka model, read where they are.

use std::path::Path;

use sistership_model::Trial;
use sistership_trials::{Mapping, TrialFile, read_manifest_file, read_trial};

/// How the files of the dataset are read: the columns of `../shared/data/esso-osaka/README.md`.
pub const MANIFEST: &str = include_str!("../data/esso-osaka.yaml");

/// The trials of a manifest whose files lie under `folder`.
///
/// # Panics
/// Where a file cannot be read: the measured data must pass the door.
pub fn trials(folder: &Path, kinds: &[&str]) -> Vec<Trial> {
    let manifest =
        read_manifest_file("esso-osaka.yaml", MANIFEST).unwrap_or_else(|error| panic!("{error}"));
    let manifest = manifest.manifest;
    let wanted = manifest
        .trials
        .iter()
        .filter(|trial| kinds.iter().any(|kind| trial.file.starts_with(kind)));
    wanted
        .map(|entry| {
            let source = TrialFile::open(&entry.file, &folder.join(&entry.file))
                .unwrap_or_else(|error| panic!("{}: {error}", entry.file));
            read_trial(source, &Mapping::from_manifest(&manifest, entry))
                .unwrap_or_else(|refusal| panic!("{refusal}"))
        })
        .collect()
}
