//! From a model and a recorded trial to the linearisation along its path.

use super::linearised::{Detail, Linearised};
use super::path::Path;
use super::walker::Walker;
use super::{Record, System};
use sistership_estimate::refine::RefineError;

/// Linearises a model along each gap-free part of a trial.
///
/// # Errors
/// Names the channel that the trial lacks.
pub fn linearise(system: &System, record: &Record<'_>, detail: Detail) -> Result<Vec<Linearised>, RefineError> {
    let path = Path::new(system, record)?;
    Ok(record.parts.iter().map(|part| Walker::new(system, &path, detail).walk(part)).collect())
}
