//! `sistership gc`: removal of unreferenced objects.

use std::time::Duration;

use clap::Args;
use sistership_jobs::upkeep::{self, RemovedObjects};

use super::store::{StoreArguments, with_archive};
use crate::failure::Failure;
use crate::output::{self, format_count};
use crate::values::hours;

const EXAMPLES: &str = "\
Examples:
  sistership gc --dry-run
  sistership gc --grace-h 72 --data-dir /var/lib/sistership

Removes samples to which no trial (deleted trials included) and no version refers, such as those of
refused or interrupted uploads. Servers and workers may keep running.";

/// Remove unreferenced objects.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct GcArguments {
    #[command(flatten)]
    store: StoreArguments,
    /// Hours for which a new object is kept in any case.
    #[arg(long, value_name = "HOURS", default_value = "24", value_parser = hours)]
    grace_h: Duration,
    /// List what would be removed without removing it.
    #[arg(long)]
    dry_run: bool,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
/// Returns an error if the store does not exist or does not answer.
pub fn run(gc: &GcArguments) -> Result<(), Failure> {
    let collected = with_archive(&gc.store, async |archive| {
        upkeep::collect_garbage(archive, gc.grace_h, gc.dry_run).await
    })?;
    output::print_result(gc.json, &collected, || format_removed(&collected))
}

fn format_removed(collected: &RemovedObjects) -> String {
    let RemovedObjects { dry_run, removed, unfinished, bytes, objects } = collected;
    let lines: String =
        removed.iter().chain(unfinished).map(|place| format!("{place}\n")).collect();
    let done = if *dry_run { "would be removed" } else { "removed" };
    let puts = format_count(unfinished.len(), "put");
    format!(
        "{lines}{} of {objects} and {puts} that were interrupted ({bytes} bytes) {done}\n",
        format_count(removed.len(), "object")
    )
}
