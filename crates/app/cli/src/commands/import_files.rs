//! Files that `sistership import` reads: those that are named, and those of named folders.

use std::path::{Path, PathBuf};

use crate::failure::{Failure, about_file};

/// Endings of files of recordings; others in a folder, such as notes and pictures, are not read.
const ENDINGS: [&str; 17] = [
    "csv", "txt", "dat", "tsv", "asc", "log", "nmea", "xlsx", "mat", "h5", "hdf5", "nc", "parquet",
    "gpx", "mcap", "n2k", "candump",
];
/// Largest depth of folders within a named one.
const DEPTH: usize = 8;

/// Returns the named files, each folder replaced by the files in it, in the order of their names.
///
/// # Errors
/// Returns an error if a folder cannot be read or holds no file of a recording.
pub fn input_files(named: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut files = Vec::new();
    for path in named {
        if !path.is_dir() {
            files.push(path.clone());
            continue;
        }
        let before = files.len();
        add_folder(path, DEPTH, &mut files)?;
        if files.len() == before {
            let known = ENDINGS.join(", ");
            let message = format!("the folder holds no recording; files end in one of {known}");
            return Err(about_file(path, message));
        }
    }
    Ok(files)
}

fn add_folder(folder: &Path, depth: usize, files: &mut Vec<PathBuf>) -> Result<(), Failure> {
    let entries = std::fs::read_dir(folder).map_err(|error| about_file(folder, error))?;
    let mut paths = entries
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<Vec<PathBuf>, _>>()
        .map_err(|error| about_file(folder, error))?;
    paths.sort();
    for path in paths.into_iter().filter(|path| !is_hidden(path)) {
        if path.is_dir() && depth > 0 {
            add_folder(&path, depth - 1, files)?;
        } else if path.is_file() && is_recording(&path) {
            files.push(path);
        }
    }
    Ok(())
}

fn is_hidden(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'))
}

/// Returns true if the ending is that of a recording, and the name not that of a note next to it.
fn is_recording(path: &Path) -> bool {
    let text = |part: Option<&std::ffi::OsStr>| {
        part.map(|part| part.to_string_lossy().to_lowercase()).unwrap_or_default()
    };
    let (stem, ending) = (text(path.file_stem()), text(path.extension()));
    let is_note = ["readme", "license", "licence"].contains(&stem.as_str());
    !is_note && ENDINGS.contains(&ending.as_str())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn folders_are_replaced_by_the_recordings_in_them() {
        let folder = tempfile::tempdir().unwrap();
        let inner = folder.path().join("turn_2");
        std::fs::create_dir(&inner).unwrap();
        for name in ["b.csv", "a.CSV", "README.txt", ".draft.csv", "notes.md", "turn_2/gps.txt"] {
            std::fs::write(folder.path().join(name), "t_s\n").unwrap();
        }
        let other = PathBuf::from("other.md");
        let read = input_files(&[folder.path().to_owned(), other.clone()]).unwrap();
        let wanted = ["a.CSV", "b.csv", "turn_2/gps.txt"].map(|name| folder.path().join(name));
        assert_eq!(read, [&wanted[..], &[other]].concat());
        let empty = tempfile::tempdir().unwrap();
        assert!(input_files(&[empty.path().to_owned()]).is_err());
    }
}
