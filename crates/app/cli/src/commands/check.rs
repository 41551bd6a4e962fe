//! `sistership check`: faults of trial files, by row and column.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use sistership_trials::{CheckOutcome, check_path};

use crate::failure::{Failure, collect_results};
use crate::output::{self, format_count};
use crate::table::format_number;
use crate::trials::format_finding;

const EXAMPLES: &str = "Examples:
  sistership check zigzag.csv turning.parquet
  sistership check trials.yaml --json

Exit status 1 if a trial is refused; a trial with warnings only is accepted.";

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
    let checked = CheckedTrials { trials: collect_results(each)?.concat() };
    output::print_result(check.json, &checked, || format_outcomes(&checked.trials))?;
    // The reasons are in the output already; only the exit status is left.
    if checked.trials.iter().all(CheckOutcome::is_accepted) { Ok(()) } else { Err(Failure::Told) }
}

fn format_outcomes(outcomes: &[CheckOutcome]) -> String {
    let refused = outcomes.iter().filter(|outcome| !outcome.is_accepted()).count();
    let warnings: usize = outcomes.iter().map(|outcome| outcome.warnings.len()).sum();
    let each: String = outcomes.iter().map(format_outcome).collect();
    format!(
        "{each}{}: {refused} refused, {}\n",
        format_count(outcomes.len(), "trial"),
        format_count(warnings, "warning")
    )
}

fn format_outcome(outcome: &CheckOutcome) -> String {
    let verdict = if outcome.is_accepted() { "accepted" } else { "REFUSED" };
    let size =
        format!("{}, {} s", format_count(outcome.rows, "row"), format_number(outcome.duration_s));
    let errors =
        outcome.errors.iter().map(|finding| format!("  error: {}\n", format_finding(finding)));
    let warnings =
        outcome.warnings.iter().map(|finding| format!("  warning: {}\n", format_finding(finding)));
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
        let text = format_outcomes(&check_path(&path).unwrap());
        assert!(
            text.contains("a.csv: REFUSED (2 rows")
                && text.contains("\n  error: row 3: column `t_s`"),
            "{text}"
        );
        assert!(text.ends_with("1 trial: 1 refused, 0 warnings\n"), "{text}");
    }
}
