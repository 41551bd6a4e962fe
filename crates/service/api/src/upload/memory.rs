//! Turn and memory for a file of an upload, taken before the file is read. Requests that wait for
//! their turn hold no memory, of which others would then have none.

use sistership_trials::{MemoryDemand, demand_of_trial, measuring_bytes};

use crate::app::App;
use crate::problem::{Fault, Problem, Result};
use sistership_jobs::budget::{self, MemoryShortage};
use sistership_web_support::upload::UploadedTrial;

/// Runs work on a file when it is its turn and the memory for it is free. The number of rows that
/// the mapping reserves is set before.
///
/// # Errors
/// Returns an error that names the file if the memory is too small, or not free in time.
pub(super) async fn run_with_memory<T: Send + 'static>(
    app: &App,
    mut trial: UploadedTrial,
    work: impl FnOnce(&UploadedTrial) -> T + Send + 'static,
) -> Result<T> {
    let measured = measure_trial(app, &trial).await?;
    trial.mapping.room = measured.rows;
    let turn = app.wait_file_turn(measured.bytes).await?;
    let share = budget::reserve_share(measured.bytes)
        .await
        .map_err(|shortage| named_shortage(&trial.name, Some(measured), shortage))?;
    let run = move || {
        let done = work(&trial);
        drop(share);
        done
    };
    turn.run(run).await
}

/// Measures what the reading of a file takes. That takes memory itself, which is estimated from the
/// paths alone, and given back before more is requested: no task may hold some of the memory while
/// it waits for the rest.
async fn measure_trial(app: &App, trial: &UploadedTrial) -> Result<MemoryDemand> {
    let paths = std::iter::once(&trial.path).chain(trial.sensors.iter().map(|(_, path)| path));
    let (mut size, mut measuring) = (0, 0);
    for path in paths {
        size += std::fs::metadata(path).map_err(Problem::internal)?.len();
        measuring += measuring_bytes(path).map_err(Problem::internal)?;
    }
    let turn = app.wait_file_turn(size).await?;
    let share = budget::reserve_share(measuring)
        .await
        .map_err(|shortage| named_shortage(&trial.name, None, shortage))?;
    let (path, mapping, sensors) =
        (trial.path.clone(), trial.mapping.clone(), trial.sensors.clone());
    let measure = move || {
        let measured = demand_of_trial(&path, &mapping, &sensors);
        drop(share);
        measured
    };
    turn.run(measure).await?.map_err(Problem::internal)
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
