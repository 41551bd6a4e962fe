//! `sistership fsck`: integrity check of a store.

use std::path::{Path, PathBuf};

use clap::Args;
use serde::Deserialize;
use sistership_jobs::upkeep::{self, AuditHead, CheckCounts, Findings, IntegrityFault};

use super::store::{StoreArguments, with_archive};
use crate::failure::{Failure, about_file};
use crate::output::{self, format_count};
use crate::zoo::read_text_file;

const EXAMPLES: &str = "\
Examples:
  sistership fsck --data-dir /var/lib/sistership
  sistership fsck --data-dir /var/lib/sistership --head head.json
  sistership fsck --database-url postgres://user@host/sistership --data-dir /var/lib/sistership --json

Checks the hash of every law, version, object and entry of the audit, and every reference between
ships, trials, versions, aliases, jobs, reports, diagnoses and objects; and that users, roles,
keys, ships, trials, laws, families, webhooks and settings are as the audit states. It changes nothing;
servers and workers may keep running. Exit status 1 if there are faults.";

/// Check every hash and every reference of a store.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct FsckArguments {
    #[command(flatten)]
    store: StoreArguments,
    /// File with a head of the audit that was kept elsewhere, as `GET /v1/audit/head` returns it:
    /// its entry must be there unchanged.
    #[arg(long, value_name = "FILE")]
    head: Option<PathBuf>,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
/// Returns an error if the store does not exist, does not answer, or has faults.
pub fn run(fsck: &FsckArguments) -> Result<(), Failure> {
    let kept = fsck.head.as_deref().map(read_head).transpose()?;
    let findings = with_archive(&fsck.store, async |archive| {
        upkeep::check_against_head(archive, kept.as_ref()).await
    })?;
    output::print_result(fsck.json, &findings, || format_findings(&findings))?;
    if findings.clean { Ok(()) } else { Err(Failure::Told) }
}

/// Head of the audit in a file.
#[derive(Deserialize)]
struct HeadFile {
    number: i64,
    sha256: String,
}

fn read_head(file: &Path) -> Result<AuditHead, Failure> {
    let text = read_text_file(file)?;
    let HeadFile { number, sha256 } =
        serde_json::from_str(&text).map_err(|error| about_file(file, error))?;
    Ok(AuditHead { number, sha256 })
}

fn format_findings(findings: &Findings) -> String {
    let Findings { faults, checked, unreferred, unfinished, .. } = findings;
    let CheckCounts { laws, effects, versions, trials, jobs, diagnoses, objects, audit } = checked;
    let fault =
        |fault: &IntegrityFault| format!("{}: {}: {}\n", fault.check, fault.place, fault.message);
    let mut text: String = faults.iter().map(fault).collect();
    text += &format!(
        "checked {laws} laws, {effects} libraries of effects, {versions} versions, {trials} \
         trials, {jobs} jobs, {diagnoses} diagnoses, {objects} objects, {audit} entries of the \
         audit: {}\n",
        if faults.is_empty() { "clean".to_owned() } else { format_count(faults.len(), "fault") }
    );
    // Unreferenced objects are no fault: `gc` removes them.
    if unreferred.objects > 0 {
        let (objects, bytes) = (format_count(unreferred.objects, "object"), unreferred.bytes);
        text += &format!(
            "{objects} ({bytes} bytes) without a reference; `sistership gc` removes the older \
             ones\n"
        );
    }
    if unfinished.objects > 0 {
        let (puts, bytes) = (format_count(unfinished.objects, "put"), unfinished.bytes);
        text += &format!(
            "{puts} ({bytes} bytes) in progress or interrupted; `sistership gc` removes the older \
             ones\n"
        );
    }
    text
}
