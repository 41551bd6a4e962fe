//! A trial whose files have arrived.

use std::path::PathBuf;

use sistership_trials::{ManifestFile, Mapping, SensorFile, Source};

/// One trial of an upload.
pub struct Arrived {
    /// What the manifest says of it.
    pub manifest: ManifestFile,
    /// What it is called.
    pub name: String,
    /// How its columns are read.
    pub mapping: Mapping,
    /// Where its file lies.
    pub path: PathBuf,
    /// Its sensors' files.
    pub sensors: Vec<(SensorFile, PathBuf)>,
}

impl Arrived {
    /// Opens its files.
    ///
    /// # Errors
    /// One of them does not open.
    pub fn open(&self) -> std::io::Result<Source<'static>> {
        Source::open_trial(&self.name, &self.path, &self.mapping, &self.sensors)
    }
}
