//! Received uploads.

use sistership_model::manifest::{Manifest, ManifestTrial, TrialConventions, TrialsKind};
use sistership_trials::ManifestFile;

use super::arrived::UploadedTrial;
use crate::problem::{Problem, Result};
use crate::spool::SpooledFile;

/// Maximum length of the name of a file, bytes.
const NAME_BYTES: usize = 200;

/// A received upload: a manifest and the files that it lists.
#[derive(Debug)]
pub struct TrialUpload {
    /// Manifest of the files.
    pub manifest: ManifestFile,
    /// True if the ship's champion is to be diagnosed on the trials.
    pub diagnose: bool,
    pub(super) files: Vec<SpooledFile>,
    /// Index of the file of each trial in `files`, and of the files of its sensors.
    pub(super) places: Vec<(usize, Vec<usize>)>,
}

impl TrialUpload {
    /// Creates an upload of files each of which is a trial, in the order of the manifest.
    pub(super) fn from_files(
        manifest: ManifestFile,
        diagnose: bool,
        files: Vec<SpooledFile>,
    ) -> Self {
        // One file for each trial, and no sensors.
        let places = (0..files.len()).map(|file| (file, Vec::new())).collect();
        Self { manifest, diagnose, files, places }
    }

    /// Returns the ship of the trials.
    pub fn ship(&self) -> &str {
        &self.manifest.manifest.ship
    }

    /// Iterates over the trials; their files exist as long as the upload.
    pub fn trials(&self) -> impl Iterator<Item = UploadedTrial> {
        let path = |file: usize| self.files[file].path.to_path_buf();
        let manifest = &self.manifest;
        let each = manifest.manifest.trials.iter().zip(&manifest.sensors).zip(&self.places);
        each.enumerate().map(move |(index, ((entry, sensors), (file, others)))| UploadedTrial {
            manifest: manifest.only_trial(index),
            name: entry.trial_label(),
            mapping: manifest.trial_mapping(entry),
            path: path(*file),
            sensors: sensors.iter().cloned().zip(others.iter().map(|&other| path(other))).collect(),
        })
    }

    /// Returns the manifest and the hashes of the files, which identify an upload independently of
    /// the boundaries of its parts.
    ///
    /// # Errors
    /// Returns an error if the manifest cannot be written.
    pub fn fingerprint(&self) -> Result<String> {
        let manifest = serde_json::to_string(&self.manifest).map_err(Problem::internal)?;
        let files = self.files.iter().map(|file| file.sha256.as_str());
        Ok(std::iter::once(manifest.as_str()).chain(files).collect::<Vec<_>>().join("\n"))
    }
}

/// Returns the manifest of files with canonical columns.
pub(super) fn canonical_manifest(ship: String, trials: Vec<ManifestTrial>) -> Result<Manifest> {
    for trial in &trials {
        let name = &trial.file;
        if name.is_empty() || name.len() > NAME_BYTES || name.chars().any(char::is_control) {
            return Err(Problem::invalid(
                "name",
                format!(
                    "a file needs a name of 1 to {NAME_BYTES} bytes, without control characters"
                ),
            ));
        }
        if trial.depth_m.is_some_and(|depth| !(depth > 0.0 && depth.is_finite())) {
            return Err(Problem::invalid("depth_m", "must be positive; omit it for deep water"));
        }
    }
    let (kind, conventions) = (TrialsKind::Trials, TrialConventions::default());
    Ok(Manifest { kind, ship, conventions, columns: Default::default(), trials })
}
