//! Atomic output files: complete or absent.

use std::io::Write;
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::failure::{Failure, about_file};

/// Output file whose place was checked to be writable before the work.
#[derive(Debug)]
pub struct OutputFile {
    path: PathBuf,
    file: NamedTempFile,
}

impl OutputFile {
    /// Checks that a file can be written, without changing an existing one.
    ///
    /// # Errors
    /// Returns an error with the reason if the file cannot be written, or if it is one of `inputs`,
    /// which must not be overwritten.
    pub fn new(path: &Path, inputs: &[PathBuf]) -> Result<Self, Failure> {
        // Symbolic links are followed, so that an input cannot be overwritten under another name.
        let place = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        if inputs.iter().filter_map(|input| input.canonicalize().ok()).any(|input| input == place) {
            return Err(about_file(
                path,
                "is read by this command and will not be overwritten; choose another place",
            ));
        }
        if place.exists() && !place.is_file() {
            return Err(about_file(path, "exists and is not a regular file; choose another place"));
        }
        let file = temporary_file(&place)
            .map_err(|error| about_file(path, write_failure(&place, &error)))?;
        Ok(Self { path: place, file })
    }

    /// Writes the file and moves it to its place.
    ///
    /// # Errors
    /// Returns an error with the reason if it could not be written; the old file is kept.
    pub fn write(mut self, bytes: &[u8]) -> Result<(), Failure> {
        // Synchronised before the rename: after a crash the place has the old file or the new one.
        let written = self.file.write_all(bytes).and_then(|()| self.file.as_file().sync_all());
        let kept = written
            .and_then(|()| self.file.persist(&self.path).map(|_| ()).map_err(|error| error.error));
        kept.map_err(|error| about_file(&self.path, format!("cannot be written: {error}")))
    }
}

fn write_failure(place: &Path, error: &std::io::Error) -> String {
    match place.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.exists() => {
            format!("there is no folder {}", folder.display())
        }
        _ => format!("cannot be written: {}", error.kind()),
    }
}

/// Creates a temporary file in the folder of another, with the permissions of a new file. In the
/// same folder a rename is atomic.
fn temporary_file(path: &Path) -> std::io::Result<NamedTempFile> {
    let folder =
        path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(".sistership-");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_file_is_replaced_only_when_it_is_complete() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.yaml");
        std::fs::write(&path, "old").unwrap();
        drop(OutputFile::new(&path, &[]).unwrap());
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "old");
        OutputFile::new(&path, &[]).unwrap().write(b"new").unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "new");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn inputs_folders_and_lost_places_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        std::fs::write(&path, "data").unwrap();
        let refused = |place: &Path| {
            OutputFile::new(place, std::slice::from_ref(&path))
                .unwrap_err()
                .message()
                .unwrap()
                .to_owned()
        };
        assert!(refused(&path).contains("will not be overwritten"));
        assert!(refused(folder.path()).contains("not a regular file"));
        assert!(refused(&folder.path().join("lost/b.csv")).contains("there is no folder"));
    }
}
