//! An upload that has arrived.

use sistership_model::manifest::{Manifest, ManifestTrial, TrialConventions, TrialsKind};
use sistership_model::trial::Trial;
use sistership_trials::{CheckOutcome, ManifestFile, Refusal, check, read_trial};

use super::arrived::Arrived;
use super::room::room;
use crate::app::App;
use crate::problem::{Problem, Result};
use sistership_http::spool::Spooled;

/// The longest name of a file.
const NAME_BYTES: usize = 200;

/// An upload that has arrived: a manifest and the files that it lists.
#[derive(Debug)]
pub(crate) struct Upload {
    /// What the files are.
    pub manifest: ManifestFile,
    /// Whether the ship's champion is to be diagnosed on them.
    pub diagnose: bool,
    pub(super) files: Vec<Spooled>,
    /// Of each trial its file among these, and its sensors'.
    pub(super) places: Vec<(usize, Vec<usize>)>,
}

impl Upload {
    /// Of files each of which is a trial, in the manifest's order.
    pub(super) fn of(manifest: Manifest, diagnose: bool, files: Vec<Spooled>) -> Self {
        let places = (0..files.len()).map(|file| (file, Vec::new())).collect();
        Self { manifest: manifest.into(), diagnose, files, places }
    }

    /// The ship whose trials they are.
    pub(crate) fn ship(&self) -> &str {
        &self.manifest.manifest.ship
    }

    /// Its trials; the files stay where they are while the upload is held.
    pub(super) fn trials(&self) -> impl Iterator<Item = Arrived> {
        let path = |file: usize| self.files[file].path.to_path_buf();
        let manifest = &self.manifest;
        let each = manifest.manifest.trials.iter().zip(&manifest.sensors).zip(&self.places);
        each.enumerate().map(move |(index, ((entry, sensors), (file, others)))| Arrived {
            manifest: manifest.only(index),
            name: entry.label(),
            mapping: manifest.mapping(entry),
            path: path(*file),
            sensors: sensors.iter().cloned().zip(others.iter().map(|&other| path(other))).collect(),
        })
    }

    /// What tells one upload from another, however its parts are delimited.
    pub(crate) fn fingerprint(&self) -> Result<String> {
        let manifest = serde_json::to_string(&self.manifest).map_err(Problem::internal)?;
        let files = self.files.iter().map(|file| file.sha256.as_str());
        Ok(std::iter::once(manifest.as_str()).chain(files).collect::<Vec<_>>().join("\n"))
    }

    /// Reads every file without keeping any, one after the other, and makes something of each.
    pub(crate) async fn each<T: Send + 'static>(
        self,
        app: &App,
        of: impl Fn(usize, std::result::Result<Trial, Refusal>) -> T + Copy + Send + 'static,
    ) -> Result<Vec<T>> {
        let mut made = Vec::with_capacity(self.places.len());
        for (at, mut trial) in self.trials().enumerate() {
            let share = room(app, &mut trial).await?;
            let one = move || {
                let _share = share;
                let source = trial.open().map_err(|error| lost(&trial.name, &error));
                of(at, source.and_then(|source| read_trial(source, &trial.mapping)))
            };
            made.push(app.compute(one).await?);
        }
        Ok(made)
    }

    /// Checks every file without keeping any, one after the other.
    pub(crate) async fn check(self, app: &App) -> Result<Vec<CheckOutcome>> {
        let mut outcomes = Vec::with_capacity(self.places.len());
        for mut trial in self.trials() {
            let share = room(app, &mut trial).await?;
            let one = move || {
                let _share = share;
                match trial.open() {
                    Ok(source) => check(source, &trial.mapping),
                    Err(error) => unreadable(&trial.name, &error),
                }
            };
            outcomes.push(app.compute(one).await?);
        }
        Ok(outcomes)
    }
}

fn unreadable(file: &str, error: &std::io::Error) -> CheckOutcome {
    let Refusal { file, findings } = lost(file, error);
    CheckOutcome { file, rows: 0, duration_s: 0.0, errors: findings, warnings: Vec::new() }
}

/// What could not be read of it.
pub(super) fn lost(file: &str, error: &std::io::Error) -> Refusal {
    let finding = sistership_model::trial::Finding {
        row: None,
        column: None,
        message: format!("cannot be read: {error}"),
    };
    Refusal { file: file.to_owned(), findings: vec![finding] }
}

/// The manifest of files with canonical columns.
pub(super) fn canonical(ship: String, trials: Vec<ManifestTrial>) -> Result<Manifest> {
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
            return Err(Problem::invalid(
                "depth_m",
                "must be positive; leave it out for deep water",
            ));
        }
    }
    let (kind, conventions) = (TrialsKind::Trials, TrialConventions::default());
    Ok(Manifest { kind, ship, conventions, columns: Default::default(), trials })
}
