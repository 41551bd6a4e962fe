//! Faults of instruments planted into trials whose truth is known: what import finds of them, and
//! what they cost a refinement.

mod plant;
mod refinement;

use std::path::Path;

use sistership_model::Trial;
use sistership_trials::samples::to_csv;
use sistership_trials::{ManifestFile, load_cleaned, load_path, propose_files};

pub use plant::{FaultKind, PlantedTrial, plant};
pub use refinement::{RefinementJudge, judge_circles, judge_trials};

/// What import finds of planted faults.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct FaultCount {
    /// Planted values.
    pub planted: usize,
    /// Planted values that are excluded.
    pub found: usize,
    /// Sound values that are excluded.
    pub false_alarms: usize,
    /// All sound values.
    pub sound: usize,
}

/// Trials as import reads them, with the count of faults.
#[derive(Debug)]
pub struct CleanedTrials {
    /// Trials that are accepted with the exclusions.
    pub cleaned: Vec<Trial>,
    /// Trials that are accepted without them: the others are refused.
    pub accepted: Vec<Trial>,
    /// What was found.
    pub count: FaultCount,
}

/// Imports trials with planted faults from files, with and without exclusions.
///
/// # Panics
/// A file cannot be written or its columns cannot be proposed.
pub fn import_planted(folder: &Path, trials: &[PlantedTrial]) -> CleanedTrials {
    let files = trials.iter().map(|one| {
        let path = folder.join(&one.trial.name);
        let file = std::fs::File::create(&path).unwrap_or_else(|error| panic!("{error}"));
        to_csv(file, &one.trial).unwrap_or_else(|error| panic!("{error}"));
        path
    });
    let files: Vec<_> = files.collect();
    let paths: Vec<&Path> = files.iter().map(AsRef::as_ref).collect();
    let request = sistership_trials::ProposalRequest {
        ship: "",
        files: &paths,
        folder: Some(folder),
        given: &[],
    };
    let mut manifest =
        propose_files(&request).unwrap_or_else(|errors| panic!("{errors:?}")).manifest;
    let place = folder.join("trials.yaml");
    let accepted = read_trials(&place, &manifest);
    manifest.declarations.exclude =
        load_cleaned(&place).unwrap_or_else(|error| panic!("{error}")).excluded;
    let count = count_faults(&manifest, trials);
    CleanedTrials { cleaned: read_trials(&place, &manifest), accepted, count }
}

/// Returns the trials that a manifest does not refuse.
fn read_trials(place: &Path, manifest: &ManifestFile) -> Vec<Trial> {
    let text = manifest.to_yaml().unwrap_or_else(|error| panic!("{error}"));
    std::fs::write(place, text).unwrap_or_else(|error| panic!("{error}"));
    let read = load_path(place).unwrap_or_else(|error| panic!("{error}"));
    read.trials.into_iter().filter_map(Result::ok).collect()
}

fn count_faults(manifest: &ManifestFile, trials: &[PlantedTrial]) -> FaultCount {
    let mut count = FaultCount::default();
    for one in trials {
        let own = manifest.declarations.exclude.iter().filter(|all| all.file == one.trial.name);
        let mut excluded = std::collections::BTreeSet::new();
        for exclusion in own {
            let rows = exclusion.rows.iter().flat_map(|rows| &rows.0).cloned().flatten();
            // The first row of the file is its header.
            let channel = exclusion.channel.clone().unwrap_or_default();
            excluded.extend(rows.map(|row| (channel.clone(), row as usize - 2)));
        }
        count.planted += one.faults.len();
        count.found += one.faults.intersection(&excluded).count();
        count.false_alarms += excluded.difference(&one.faults).count();
        count.sound += one.trial.len() * one.trial.channels.len() - one.faults.len();
    }
    count
}
