//! Linearisation of a model along the path of a recorded trial.

use super::linearised::{LinearisationDetail, LinearisedPart};
use super::lineariser::PathLineariser;
use super::path::RecordedPath;
use super::{ResidualSystem, TrialReadings};
use sistership_identification::refine::RefineError;

/// Linearises a model along each gap-free part of a trial.
///
/// # Errors
/// Returns an error that names the channel that the trial lacks.
pub fn linearise(
    system: &ResidualSystem,
    record: &TrialReadings<'_>,
    detail: LinearisationDetail,
) -> Result<Vec<LinearisedPart>, RefineError> {
    let path = RecordedPath::new(system, record)?;
    Ok(record
        .parts
        .iter()
        .map(|part| PathLineariser::new(system, &path, detail).linearise_part(part))
        .collect())
}
