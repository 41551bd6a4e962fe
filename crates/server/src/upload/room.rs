//! Memory for a file of an upload, taken before the file is read.

use std::path::Path;

use sistership_trials::{Demand, Mapping, demand, measuring};

use crate::app::App;
use crate::problem::{Fault, Problem, Result};
use sistership_pipeline::budget::{self, Share, Shortage};

/// Takes what a file needs from its reading to its samples being kept; gives the mapping room for
/// its rows.
///
/// # Errors
/// There is not so much memory, or not soon; the file is named.
pub(super) async fn room(
    app: &App,
    name: &str,
    path: &Path,
    mapping: &mut Mapping,
) -> Result<Option<Share>> {
    let measuring = measuring(path).map_err(Problem::internal)?;
    let share = budget::share(measuring).await.map_err(|shortage| named(name, None, shortage))?;
    let (at, asked) = (path.to_path_buf(), mapping.clone());
    let measured = app.compute(move || demand(&at, &asked)).await?.map_err(Problem::internal)?;
    // Given back before more is asked for: nobody holds some of the memory while waiting for the
    // rest.
    drop(share);
    mapping.room = measured.rows;
    budget::share(measured.bytes).await.map_err(|shortage| named(name, Some(measured), shortage))
}

fn named(name: &str, measured: Option<Demand>, shortage: Shortage) -> Problem {
    let size = measured
        .map(|Demand { rows, columns, .. }| format!("{rows} rows of {columns} columns: "))
        .unwrap_or_default();
    let problem = Problem::from(shortage);
    let message = format!("{size}{}", problem.detail);
    Problem { detail: format!("{name}: {message}"), ..problem }.with(Fault::at(name, message))
}
