//! An upload that has arrived.

use sistership_model::manifest::{Manifest, ManifestTrial, TrialConventions, TrialsKind};
use sistership_trials::{CheckOutcome, Mapping, Refusal, Source, check};

use super::room::room;
use super::spool::Spooled;
use crate::app::App;
use crate::problem::{Problem, Result};

/// The longest name of a file.
const NAME_BYTES: usize = 200;

/// An upload that has arrived: a manifest and the files that it lists, in its order.
#[derive(Debug)]
pub(crate) struct Upload {
    /// What the files are.
    pub manifest: Manifest,
    /// Whether the ship's champion is to be diagnosed on them.
    pub diagnose: bool,
    pub(super) files: Vec<Spooled>,
}

impl Upload {
    /// What tells one upload from another, however its parts are delimited.
    pub(crate) fn fingerprint(&self) -> Result<String> {
        let manifest = serde_json::to_string(&self.manifest).map_err(Problem::internal)?;
        let files = self.files.iter().map(|file| file.sha256.as_str());
        Ok(std::iter::once(manifest.as_str()).chain(files).collect::<Vec<_>>().join("\n"))
    }

    /// Checks every file without keeping any, one after the other.
    pub(crate) async fn check(self, app: &App) -> Result<Vec<CheckOutcome>> {
        let mut outcomes = Vec::with_capacity(self.files.len());
        for (entry, file) in self.manifest.trials.iter().zip(self.files) {
            let mut mapping = Mapping::of(&self.manifest, entry);
            let share = room(app, &entry.file, &file.path, &mut mapping).await?;
            let name = entry.file.clone();
            let one = move || {
                let _share = share;
                match Source::open(&name, &file.path) {
                    Ok(source) => check(source, &mapping),
                    Err(error) => unreadable(&name, &error),
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
