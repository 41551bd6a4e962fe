//! Memory for a file of an upload, taken before the file is read.

use sistership_trials::{MemoryDemand, demand_of_trial, measuring_bytes};

use crate::app::App;
use crate::problem::{Fault, Problem, Result};
use sistership_jobs::budget::{self, MemoryShare, MemoryShortage};
use sistership_web_support::upload::UploadedTrial;

/// Takes the memory of a file from its reading to the storing of its samples, and sets the number
/// of rows that the mapping reserves.
///
/// # Errors
/// Returns an error that names the file if the memory is too small, or not free in time.
pub(super) async fn reserve_memory(
    app: &App,
    trial: &mut UploadedTrial,
) -> Result<Option<MemoryShare>> {
    let name = trial.name.clone();
    // Measuring the file takes memory itself, which is estimated from its path alone.
    let paths = std::iter::once(&trial.path).chain(trial.sensors.iter().map(|(_, path)| path));
    let each: std::io::Result<Vec<u64>> = paths.map(|path| measuring_bytes(path)).collect();
    let measuring = each.map_err(Problem::internal)?.iter().sum();
    let share = budget::reserve_share(measuring)
        .await
        .map_err(|shortage| named_shortage(&name, None, shortage))?;
    let (path, mapping, sensors) =
        (trial.path.clone(), trial.mapping.clone(), trial.sensors.clone());
    let measure = move || demand_of_trial(&path, &mapping, &sensors);
    let measured = app.read_files(measure).await?.map_err(Problem::internal)?;
    // Given back before more is requested: no task may hold some of the memory while it waits for
    // the rest.
    drop(share);
    trial.mapping.room = measured.rows;
    budget::reserve_share(measured.bytes)
        .await
        .map_err(|shortage| named_shortage(&name, Some(measured), shortage))
}

fn named_shortage(name: &str, measured: Option<MemoryDemand>, shortage: MemoryShortage) -> Problem {
    let size = measured
        .map(|MemoryDemand { rows, columns, .. }| format!("{rows} rows of {columns} columns: "))
        .unwrap_or_default();
    let problem = Problem::from(shortage);
    let message = format!("{size}{}", problem.detail);
    Problem { detail: format!("{name}: {message}"), ..problem }
        .with_fault(Fault::at_field(name, message))
}
