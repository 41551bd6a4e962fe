//! A trial whose files have arrived.

use std::path::PathBuf;

use sistership_trials::{ManifestFile, Mapping, SensorFile, TrialFile};

/// One trial of an upload.
pub struct UploadedTrial {
    /// Manifest of this trial alone.
    pub manifest: ManifestFile,
    /// Name.
    pub name: String,
    /// Mapping of its columns.
    pub mapping: Mapping,
    /// Path of its file.
    pub path: PathBuf,
    /// Additional files of sensors, with their paths.
    pub sensors: Vec<(SensorFile, PathBuf)>,
}

impl UploadedTrial {
    /// Opens the files of the trial.
    ///
    /// # Errors
    /// Returns an error if one of them cannot be opened.
    pub fn open(&self) -> std::io::Result<TrialFile<'static>> {
        TrialFile::open_trial(&self.name, &self.path, &self.mapping, &self.sensors)
    }
}
