//! The weights of a learned branch beside the file of its model.

use std::path::{Path, PathBuf};

use serde::Serialize;
use sistership_model::Model;
use sistership_model::branch::Branch;

use crate::failure::{Failure, about_file};
use crate::table::number;

/// Where the weights of a model file are: `model.weights.json` for `model.yaml`.
pub fn beside(model: &Path) -> PathBuf {
    model.with_extension("weights.json")
}

/// Attaches the weights beside a model's file, where the model has a learned branch.
///
/// # Errors
/// Names the file that is missing, or is not what the model names.
pub fn attach(file: &Path, model: &mut Model) -> Result<(), Failure> {
    let Some(bytes) = read_beside(file, model)? else { return Ok(()) };
    sistership_learned::attach(model, &bytes).map_err(|error| about_file(file, error))
}

/// The weights beside a model's file; none where the model has no learned correction.
///
/// # Errors
/// Names the file that cannot be read.
pub fn read_beside(file: &Path, model: &Model) -> Result<Option<Vec<u8>>, Failure> {
    if model.branch.is_none() {
        return Ok(None);
    }
    let weights = beside(file);
    let unread = |error: std::io::Error| {
        let message = format!(
            "branch.weights_sha256: the weights of its learned branch should be beside it in {}, \
             which cannot be read: {}",
            weights.display(),
            error.kind()
        );
        about_file(file, message)
    };
    std::fs::read(&weights).map(Some).map_err(unread)
}

/// What a learned branch is, as documents name it.
#[derive(Debug, Serialize)]
pub struct BranchWords<'a> {
    /// What learned.
    pub kind: &'a str,
    /// How it is joined to the law.
    pub mode: &'a str,
}

impl<'a> BranchWords<'a> {
    /// Of a branch.
    pub fn of(branch: &'a Branch) -> Self {
        Self { kind: branch.recipe.learner.name(), mode: branch.mode.name() }
    }

    /// A line on it, with what it counted for in a simulation where that is known.
    pub fn line(&self, share: Option<f64>) -> String {
        let counted = share.map_or(String::new(), |share| {
            format!("; it counted for {} % of the simulated time", number(100.0 * share))
        });
        format!("learned branch: {}, {}{counted}\n", self.kind, self.mode)
    }
}
