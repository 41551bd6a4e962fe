//! `sistership check`: faults of trial files, by row and column.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use sistership_trials::{CheckOutcome, check_path};

use crate::failure::{Failure, all};
use crate::output::{self, count};
use crate::table::number;
use crate::trials::place;

const EXAMPLES: &str = "\
Examples:
  sistership check zigzag.csv turning.parquet
  sistership check trials.yaml --json

Exit status 1 when any trial is refused; warnings refuse nothing.";

/// Check trial files: units, signs, gaps, jumps, time.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct CheckArguments {
    /// Trial manifests, CSV or Parquet files.
    #[arg(required = true)]
    trials: Vec<PathBuf>,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct CheckedTrials {
    trials: Vec<CheckOutcome>,
}

/// Runs the command.
///
/// # Errors
/// Returns an error if a path cannot be read, or if a trial is refused.
pub fn run(check: &CheckArguments) -> Result<(), Failure> {
    let each = check.trials.iter().map(|path| check_path(path).map_err(Failure::from));
    let checked = CheckedTrials { trials: all(each)?.concat() };
    output::print(check.json, &checked, || text(&checked.trials))?;
    // The reasons are in the output already; only the exit status is left.
    if checked.trials.iter().all(CheckOutcome::accepted) { Ok(()) } else { Err(Failure::Told) }
}

fn text(outcomes: &[CheckOutcome]) -> String {
    let refused = outcomes.iter().filter(|outcome| !outcome.accepted()).count();
    let warnings: usize = outcomes.iter().map(|outcome| outcome.warnings.len()).sum();
    let each: String = outcomes.iter().map(one).collect();
    format!(
        "{each}{}: {refused} refused, {}\n",
        count(outcomes.len(), "trial"),
        count(warnings, "warning")
    )
}

fn one(outcome: &CheckOutcome) -> String {
    let verdict = if outcome.accepted() { "accepted" } else { "REFUSED" };
    let size = format!("{}, {} s", count(outcome.rows, "row"), number(outcome.duration_s));
    let errors = outcome.errors.iter().map(|finding| format!("  error: {}\n", place(finding)));
    let warnings =
        outcome.warnings.iter().map(|finding| format!("  warning: {}\n", place(finding)));
    format!("{}: {verdict} ({size})\n{}", outcome.file, errors.chain(warnings).collect::<String>())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn findings_are_listed_below_their_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        std::fs::write(&path, "t_s,u_m_s\n0,1\n0,2\n").unwrap();
        let text = text(&check_path(&path).unwrap());
        assert!(
            text.contains("a.csv: REFUSED (2 rows")
                && text.contains("\n  error: row 3: column `t_s`"),
            "{text}"
        );
        assert!(text.ends_with("1 trial: 1 refused, 0 warnings\n"), "{text}");
    }
}
