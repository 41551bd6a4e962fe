//! `sistership backup` and `sistership restore`.

use std::path::PathBuf;

use clap::Args;
use sistership_jobs::upkeep::{self, BackupManifest};

use super::store::{StoreArguments, block_on, with_archive};
use crate::failure::Failure;
use crate::output::{self, format_count};

const BACKUP_EXAMPLES: &str = "\
Examples:
  sistership backup /backup/2026-11-21 --data-dir /var/lib/sistership
  sistership backup /backup/2026-11-21 --database-url postgres://user@host/sistership --data-dir /mnt/shared/sistership

Servers and workers may keep running: the backup is a consistent snapshot of the database, taken
after the command began, with the samples that it refers to. Exit status 1 when samples are missing
or damaged; everything else is copied.";

const RESTORE_EXAMPLES: &str = "\
Examples:
  sistership restore /backup/2026-11-21 --data-dir /var/lib/sistership-2
  sistership restore /backup/2026-11-21 --database-url postgres://user@host/empty --data-dir /mnt/shared/sistership-2

The target must be empty: no database file, or a database without tables, and no samples. Run
`sistership fsck` afterwards.";

/// Back up a store into a folder while servers keep writing.
#[derive(Debug, Args)]
#[command(after_help = BACKUP_EXAMPLES)]
pub struct BackupArguments {
    /// The folder; it must be empty or absent.
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    #[command(flatten)]
    store: StoreArguments,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

/// Restore a backup into an empty store.
#[derive(Debug, Args)]
#[command(after_help = RESTORE_EXAMPLES)]
pub struct RestoreArguments {
    /// The backup's folder.
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    #[command(flatten)]
    store: StoreArguments,
    /// Print one JSON document.
    #[arg(long)]
    json: bool,
}

/// Runs `sistership backup`.
///
/// # Errors
/// Returns an error if the store does not exist, if the folder is not empty, if something cannot be
/// read or written, or if samples are missing.
pub fn run_backup(backup: &BackupArguments) -> Result<(), Failure> {
    let manifest = with_archive(&backup.store, async |archive| {
        upkeep::back_up_archive(archive, &backup.folder).await
    })?;
    output::print_result(backup.json, &manifest, || format_manifest("backed up", &manifest))?;
    // The backup is complete except for the lost samples, which the text above lists.
    if manifest.lost.is_empty() { Ok(()) } else { Err(Failure::Told) }
}

/// Runs `sistership restore`.
///
/// # Errors
/// Returns an error if the place is not empty, if the backup is damaged or of another kind of
/// database, or if something cannot be written.
pub fn run_restore(restore: &RestoreArguments) -> Result<(), Failure> {
    let RestoreArguments { folder, store, json } = restore;
    let place = store.resolve_place(&store.read_config()?)?;
    let manifest = block_on(async {
        let restored = upkeep::restore_archive(folder, &place.database_url, &place.objects).await;
        restored.map_err(|error| Failure::Refused(error.to_string()))
    })?;
    output::print_result(*json, &manifest, || format_manifest("restored", &manifest))
}

fn format_manifest(done: &str, manifest: &BackupManifest) -> String {
    let files: u64 = manifest.files.values().map(|file| file.bytes).sum();
    let lost: String =
        manifest.lost.iter().map(|key| format!("missing or damaged samples: {key}\n")).collect();
    let objects = format_count(manifest.objects, "object");
    format!(
        "{lost}{done}: a database of {files} bytes, {objects} with {} bytes\n",
        manifest.object_bytes
    )
}
