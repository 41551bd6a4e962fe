//! The measured trials of the Esso Osaka model, some kept out by file.

use std::path::{Path, PathBuf};

use sistership_model::Trial;
use sistership_simulation::error::standard_deviations;
use sistership_tests::{esso_osaka, shared};

use super::DataSet;

/// The files come in so many parts, each of which is kept out once.
pub const FOLDS: usize = 4;
/// Wakita et al. 2022.
const RESTART_S: f64 = 100.0;
const KINDS: [&str; 4] = ["random", "turning", "zigzag", "berthing"];

/// The data with every fourth file kept out, from the file with the number `fold` on; all of them
/// given to the calls, and judged by none, where `fold` is absent. Deviations are those over all
/// files, as in the paper.
pub fn esso_osaka(fold: Option<usize>) -> Option<DataSet> {
    let folder = shared::data("esso-osaka")?;
    let all = esso_osaka::trials(&folder, &KINDS);
    let deviations = standard_deviations(&all.iter().collect::<Vec<_>>());
    let kept_out: Vec<bool> =
        all.iter().enumerate().map(|(k, trial)| Some(part(trial, k)) == fold).collect();
    let (seen, unseen) = split(all, &kept_out);
    let files = written(&folder, &kept_out);
    let ship = "esso-osaka-3m".to_owned();
    let mut data = DataSet::new(ship, files, (seen, unseen), RESTART_S);
    data.deviations = deviations;
    Some(data)
}

/// The file of a turn and what was cut out of it stay together.
fn part(trial: &Trial, k: usize) -> usize {
    if trial.name.contains("15_58_08") { 0 } else { k % FOLDS }
}

fn split(all: Vec<Trial>, kept_out: &[bool]) -> (Vec<Trial>, Vec<Trial>) {
    let (mut seen, mut unseen) = (Vec::new(), Vec::new());
    for (trial, out) in all.into_iter().zip(kept_out) {
        if *out { unseen.push(trial) } else { seen.push(trial) }
    }
    (seen, unseen)
}

/// The given manifest without the lines of files kept out, beside links to the folders of the data.
fn written(data: &Path, kept_out: &[bool]) -> (PathBuf, tempfile::TempDir) {
    let folder = tempfile::tempdir().expect("a folder");
    for kind in KINDS {
        let real = data.join(kind).canonicalize().expect("the data");
        std::os::unix::fs::symlink(real, folder.path().join(kind)).expect("a link");
    }
    let mut out = kept_out.iter();
    let stays = |line: &&str| !line.starts_with("  - {") || !*out.next().expect("a file a line");
    let lines: Vec<&str> = esso_osaka::MANIFEST.lines().filter(stays).collect();
    let path = folder.path().join("trials.yaml");
    std::fs::write(&path, lines.join("\n") + "\n").expect("the manifest is written");
    (path, folder)
}
