//! `sistership verify`: a version derived again from its recipe.

use std::sync::Arc;

use clap::Args;
use sistership_server::Archive;
use sistership_server::verify::{Verification, verify_with};

use super::store::{StoreArguments, with_archive};
use crate::failure::Failure;
use crate::output::{self, note};

const EXAMPLES: &str = "\
Examples:
  sistership verify esso-osaka-3m/2
  sistership verify sr108/3 --database-url postgres://user@host/sistership --data-dir /var/lib/sistership --json

Exit status 1 when the bytes differ or the version cannot be derived.";

/// Derive a version again from its recipe and compare the bytes.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Verify {
    /// The version: ship and number.
    #[arg(value_name = "SHIP/NUMBER", value_parser = version)]
    version: (String, i64),
    #[command(flatten)]
    store: StoreArguments,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

fn version(text: &str) -> Result<(String, i64), String> {
    let parts = text.rsplit_once('/').and_then(|(ship, number)| Some((ship.to_owned(), number.parse().ok()?)));
    parts
        .filter(|(ship, number)| !ship.is_empty() && *number > 0)
        .ok_or_else(|| "write ship and number, such as `sr108/2`".to_owned())
}

/// Runs the command.
///
/// # Errors
/// The store or the version is not there, or the version is not what its recipe gives.
pub fn run(verify: &Verify) -> Result<(), Failure> {
    let verification = with_archive(&verify.store, async |archive| verification(verify, archive).await)?;
    output::print(verify.json, &verification, || text(&verification))?;
    if verification.identical { Ok(()) } else { Err(Failure::Told) }
}

async fn verification(verify: &Verify, archive: &Archive) -> Result<Verification, String> {
    let (ship, number) = &verify.version;
    let told = |fraction: f64, what: &str| {
        note(&format!("{:3.0} % {what}", 100.0 * fraction));
        true
    };
    let verification = verify_with(archive, ship, *number, Arc::new(told)).await;
    verification.map_err(|error| format!("{ship}/{number}: {error}"))
}

fn text(verification: &Verification) -> String {
    let Verification { model, number, sha256, derived_sha256, identical, remarks, .. } = verification;
    let head = if *identical {
        format!("{model}/{number}: derived again, identical byte for byte\n  sha256 {sha256}\n")
    } else {
        format!(
            "{model}/{number}: DIFFERS from what its recipe gives\n  recorded sha256 {sha256}\n  derived sha256  {derived_sha256}\n"
        )
    };
    head + &remarks.iter().map(|remark| format!("remark: {remark}\n")).collect::<String>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_read() {
        assert_eq!(version("sr108/2"), Ok(("sr108".to_owned(), 2)));
        for wrong in ["sr108", "sr108/x", "/2", "sr108/0", "sr108/-1"] {
            assert!(version(wrong).is_err(), "{wrong}");
        }
    }
}
