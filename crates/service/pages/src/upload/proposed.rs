//! The proposed reading of an upload.

use sistership_model::manifest::ColumnMapping;
use sistership_trials::{ColumnGuess, Derivable, ManifestFile};

/// Channels that a column may be mapped to, as manifests name them.
pub(super) const TARGETS: [&str; 28] = [
    "t",
    "x",
    "y",
    "latitude",
    "longitude",
    "psi",
    "u",
    "v",
    "u_water",
    "v_water",
    "r",
    "phi",
    "p",
    "delta",
    "delta_s",
    "delta_p",
    "n",
    "n_s",
    "n_p",
    "course",
    "speed",
    "v_north",
    "v_east",
    "wind_speed",
    "wind_from",
    "apparent_wind_speed",
    "apparent_wind_from",
    "depth",
];
/// Velocities that can be derived, by the name of their field.
pub(super) const DERIVED: [(&str, Derivable); 3] =
    [("u", Derivable::U), ("v", Derivable::V), ("r", Derivable::R)];

/// An upload whose files have arrived.
#[derive(Debug, Clone)]
pub struct UploadProposal {
    /// The ship.
    pub ship: String,
    /// Id of the upload in addresses.
    pub id: String,
    /// First guess for each column, with its reason.
    pub guesses: Vec<ColumnGuess>,
    /// Manifest by which the files are read now.
    pub manifest: ManifestFile,
    /// True if the champion is to be diagnosed on the stored trials.
    pub diagnose: bool,
}

impl UploadProposal {
    /// Returns true if the manifest maps the columns of a file: of the first trial, which the other
    /// trials share, or of a further sensor.
    pub(super) fn is_mapped(&self, file: &str) -> bool {
        let first = self.manifest.manifest.trials.first();
        let sensors = self.manifest.sensors.iter().flatten();
        first.is_some_and(|first| first.file == file)
            || sensors.into_iter().any(|one| one.file == file)
    }
}

/// Returns the columns of a file as they are mapped now.
pub(super) fn mapped_columns<'a>(
    manifest: &'a ManifestFile,
    file: &str,
) -> Vec<(&'a String, &'a ColumnMapping)> {
    // A file of a further sensor has its own mapping; all others share that of the manifest.
    let sensor = manifest.sensors.iter().flatten().find(|sensor| sensor.file == file);
    match sensor {
        Some(sensor) => sensor.columns.iter().collect(),
        None => manifest.manifest.columns.iter().collect(),
    }
}
