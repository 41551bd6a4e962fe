//! Output folder with one file for each trial.

use std::path::{Path, PathBuf};

use crate::failure::{Failure, about_file};
use crate::files;

/// File of the folder.
#[derive(Debug)]
pub struct TrackFile {
    /// The file.
    pub file: files::OutputFile,
    /// Its path in messages.
    pub shown: String,
}

/// Prepares one CSV file for each trial; the folder is created if it does not exist.
///
/// # Errors
/// Returns an error if the folder cannot be written, or if a file of it is among the inputs.
pub fn prepare_files(
    folder: &Path,
    trials: &[&str],
    inputs: &[PathBuf],
) -> Result<Vec<TrackFile>, Failure> {
    std::fs::create_dir_all(folder)
        .map_err(|error| about_file(folder, format!("the folder cannot be created: {error}")))?;
    let one = |name: String| {
        let path = folder.join(name);
        Ok(TrackFile {
            file: files::OutputFile::new(&path, inputs)?,
            shown: path.display().to_string(),
        })
    };
    file_names(trials).into_iter().map(one).collect()
}

/// Returns the file name of each trial, with its folder if two have the same name.
fn file_names(trials: &[&str]) -> Vec<String> {
    let stem =
        |name: &str| Path::new(name).with_extension("").to_string_lossy().replace(['/', '\\'], "-");
    let last = |name: &str| stem(name.rsplit(['/', '\\']).next().unwrap_or(name));
    let lasts: Vec<String> = trials.iter().map(|name| last(name)).collect();
    let mut names: Vec<String> = Vec::new();
    for (index, trial) in trials.iter().enumerate() {
        let alone = lasts.iter().filter(|other| **other == lasts[index]).count() == 1;
        let name = if alone { lasts[index].clone() } else { stem(trial) };
        // Two paths may give the same name after separators are replaced; the number makes it
        // unique.
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
        let refused =
            prepare_files(folder.path(), &["a.csv"], std::slice::from_ref(&path)).unwrap_err();
        assert!(refused.message().unwrap().contains("will not be overwritten"));
    }
}
