//! Weights of a learned correction, in a file next to that of its model.

use std::path::{Path, PathBuf};

use serde::Serialize;
use sistership_model::Model;
use sistership_model::branch::CorrectionDocument;

use crate::failure::{Failure, about_file};
use crate::table::format_number;

/// Returns the path of the weights of a model file: `model.weights.json` for `model.yaml`.
pub fn weights_path(model: &Path) -> PathBuf {
    model.with_extension("weights.json")
}

/// Attaches the weights next to a model's file, if the model has a learned correction.
///
/// # Errors
/// Returns an error that names the file if it is missing, or if its content is not what the model
/// names.
pub fn attach_weights(file: &Path, model: &mut Model) -> Result<(), Failure> {
    let Some(bytes) = read_weights(file, model)? else { return Ok(()) };
    // The hash of the weights is checked against the one that the model names.
    sistership_learned::attach(model, &bytes).map_err(|error| about_file(file, error))
}

/// Reads the weights next to a model's file; `None` if the model has no learned correction.
///
/// # Errors
/// Returns an error that names the file that cannot be read.
pub fn read_weights(file: &Path, model: &Model) -> Result<Option<Vec<u8>>, Failure> {
    if model.branch.is_none() {
        return Ok(None);
    }
    let weights = weights_path(file);
    let unread = |error: std::io::Error| {
        let message = format!(
            "branch.weights_sha256: the weights of the learned correction are expected next to \
             the model in {}, which cannot be read: {}",
            weights.display(),
            error.kind()
        );
        about_file(file, message)
    };
    std::fs::read(&weights).map(Some).map_err(unread)
}

/// Description of a learned correction in documents.
#[derive(Debug, Serialize)]
pub struct CorrectionSummary<'a> {
    /// Kind of the learner.
    pub kind: &'a str,
    /// Combination with the law.
    pub mode: &'a str,
}

impl<'a> CorrectionSummary<'a> {
    /// Describes a learned correction.
    pub fn from_branch(branch: &'a CorrectionDocument) -> Self {
        Self { kind: branch.recipe.learner.name(), mode: branch.mode.name() }
    }

    /// Formats a line, with its share in a simulation if that is known.
    pub fn to_line(&self, share: Option<f64>) -> String {
        let counted = share.map_or(String::new(), |share| {
            format!("; its mean share in the simulation is {} %", format_number(100.0 * share))
        });
        format!("learned correction: {}, {}{counted}\n", self.kind, self.mode)
    }
}
