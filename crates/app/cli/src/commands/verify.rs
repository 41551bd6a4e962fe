//! `sistership verify`: derivation of a version again from its recipe, and comparison of the bytes.

use std::sync::Arc;

use clap::Args;
use sistership_jobs::Archive;
use sistership_jobs::derive::DeriveError;
use sistership_jobs::verify::{Verification, verify_with_progress};

use super::store::{StoreArguments, with_archive};
use crate::failure::Failure;
use crate::output::{self, print_note};
use crate::values::version;

const EXAMPLES: &str = "\
Examples:
  sistership verify esso-osaka-3m/2
  sistership verify sr108/3 --database-url postgres://user@host/sistership --data-dir /var/lib/sistership --json

Exit status 1 when the bytes differ or the version cannot be derived.";

/// Repeat the recorded recipe of a version and compare the bytes.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct VerifyArguments {
    /// The version: ship and number.
    #[arg(value_name = "SHIP/NUMBER", value_parser = version)]
    version: (String, i64),
    #[command(flatten)]
    store: StoreArguments,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
/// Returns an error if the store or the version does not exist, or if the version differs from what
/// its recipe gives.
pub fn run(verify: &VerifyArguments) -> Result<(), Failure> {
    let verification =
        with_archive(&verify.store, async |archive| run_verification(verify, archive).await)?;
    output::print_result(verify.json, &verification, || format_verification(&verification))?;
    // The differences are in the output already; only the exit status is left.
    if verification.identical { Ok(()) } else { Err(Failure::Told) }
}

/// Error of a version that cannot be derived again.
#[derive(Debug, thiserror::Error)]
#[error("{ship}/{number}: {error}")]
struct VerifyError {
    ship: String,
    number: i64,
    error: DeriveError,
}

async fn run_verification(
    verify: &VerifyArguments,
    archive: &Archive,
) -> Result<Verification, VerifyError> {
    let (ship, number) = &verify.version;
    let told = |fraction: f64, what: &str| {
        print_note(&format!("{:3.0} % {what}", 100.0 * fraction));
        true
    };
    let verification = verify_with_progress(archive, ship, *number, Arc::new(told)).await;
    verification.map_err(|error| VerifyError { ship: ship.clone(), number: *number, error })
}

fn format_verification(verification: &Verification) -> String {
    let Verification { model, number, sha256, derived_sha256, identical, remarks, .. } =
        verification;
    let head = if *identical {
        format!("{model}/{number}: reproduced, identical byte for byte\n  sha256 {sha256}\n")
    } else {
        format!(
            "{model}/{number}: NOT reproduced by its recipe\n  recorded sha256   {sha256}\n  \
             reproduced sha256 {derived_sha256}\n"
        )
    };
    head + &remarks.iter().map(|remark| format!("remark: {remark}\n")).collect::<String>()
}
