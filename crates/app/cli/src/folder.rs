//! A folder of result files, one for each trial.

use std::path::{Path, PathBuf};

use crate::failure::{Failure, about_file};
use crate::files;

/// A file of the folder.
#[derive(Debug)]
pub struct PromisedTrack {
    /// The file.
    pub file: files::PromisedFile,
    /// Its path as people are told.
    pub shown: String,
}

/// Promises one CSV file for each trial; the folder is made where it does not exist.
///
/// # Errors
/// The folder cannot be written, or a file of it is among the inputs.
pub fn promise(
    folder: &Path,
    trials: &[&str],
    inputs: &[PathBuf],
) -> Result<Vec<PromisedTrack>, Failure> {
    std::fs::create_dir_all(folder)
        .map_err(|error| about_file(folder, format!("cannot be made a folder: {error}")))?;
    let one = |name: String| {
        let path = folder.join(name);
        Ok(PromisedTrack {
            file: files::PromisedFile::new(&path, inputs)?,
            shown: path.display().to_string(),
        })
    };
    file_names(trials).into_iter().map(one).collect()
}

/// The trial's own file name; with its folder where two have the same.
fn file_names(trials: &[&str]) -> Vec<String> {
    let stem =
        |name: &str| Path::new(name).with_extension("").to_string_lossy().replace(['/', '\\'], "-");
    let last = |name: &str| stem(name.rsplit(['/', '\\']).next().unwrap_or(name));
    let lasts: Vec<String> = trials.iter().map(|name| last(name)).collect();
    let mut names: Vec<String> = Vec::new();
    for (index, trial) in trials.iter().enumerate() {
        let alone = lasts.iter().filter(|other| **other == lasts[index]).count() == 1;
        let name = if alone { lasts[index].clone() } else { stem(trial) };
        let taken = names.contains(&format!("{name}.csv"));
        names.push(if taken { format!("{name}-{}.csv", index + 1) } else { format!("{name}.csv") });
    }
    names
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn each_trial_has_a_file_of_its_own() {
        assert_eq!(file_names(&["zigzag/a.csv", "b.v2.parquet"]), ["a.csv", "b.v2.csv"]);
        assert_eq!(file_names(&["x/a.csv", "y/a.csv"]), ["x-a.csv", "y-a.csv"]);
        assert_eq!(file_names(&["a.csv", "a.parquet"]), ["a.csv", "a-2.csv"]);
    }

    #[test]
    fn measured_files_are_not_overwritten() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        std::fs::write(&path, "measured").unwrap();
        let refused = promise(folder.path(), &["a.csv"], std::slice::from_ref(&path)).unwrap_err();
        assert!(refused.message().unwrap().contains("will not be overwritten"));
    }
}
