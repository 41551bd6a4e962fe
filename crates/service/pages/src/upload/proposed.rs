//! An upload as it is proposed to be read.

use sistership_model::manifest::ColumnMapping;
use sistership_trials::{Derivable, Guess, ManifestFile};

/// Names of what a column may be, as manifests have them.
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
pub struct Proposed {
    /// The ship.
    pub ship: String,
    /// Where its files are looked at.
    pub id: String,
    /// What each column was taken for at first, and why.
    pub guesses: Vec<Guess>,
    /// How the files are read now.
    pub manifest: ManifestFile,
    /// Whether the champion is to be diagnosed on what is kept.
    pub diagnose: bool,
}

impl Proposed {
    /// Whether the manifest maps the columns of a file: of the first, which the other trials share,
    /// and of further sensors.
    pub(super) fn is_mapped(&self, file: &str) -> bool {
        let first = self.manifest.manifest.trials.first();
        let sensors = self.manifest.sensors.iter().flatten();
        first.is_some_and(|first| first.file == file)
            || sensors.into_iter().any(|one| one.file == file)
    }
}

/// The columns of a file as they are mapped now.
pub(super) fn columns_of<'a>(
    manifest: &'a ManifestFile,
    file: &str,
) -> Vec<(&'a String, &'a ColumnMapping)> {
    let sensor = manifest.sensors.iter().flatten().find(|sensor| sensor.file == file);
    match sensor {
        Some(sensor) => sensor.columns.iter().collect(),
        None => manifest.manifest.columns.iter().collect(),
    }
}
