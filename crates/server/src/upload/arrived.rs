//! A trial whose files have arrived.

use std::path::PathBuf;

use sistership_trials::{ManifestFile, Mapping, SensorFile, Source};

/// One trial of an upload.
pub(super) struct Arrived {
    /// What the manifest says of it.
    pub manifest: ManifestFile,
    pub name: String,
    pub mapping: Mapping,
    pub path: PathBuf,
    pub sensors: Vec<(SensorFile, PathBuf)>,
}

impl Arrived {
    pub(super) fn open(&self) -> std::io::Result<Source<'static>> {
        Source::open_trial(&self.name, &self.path, &self.mapping, &self.sensors)
    }
}
