//! Check of all hashes, and of all references between rows, documents and objects.

use sistership_store::{AuditHead, Result};

use super::findings::Findings;
use super::{documents, objects};
use crate::archive::Archive;

/// Checks a whole archive. It changes nothing, and other processes may write at the same time.
///
/// # Errors
/// Returns an error if the database or the object store does not answer; faults of their content
/// are findings.
pub async fn check_archive(archive: &Archive) -> Result<Findings> {
    check_against_head(archive, None).await
}

/// Checks a whole archive, and that its audit has the entry of a head that was kept elsewhere.
///
/// # Errors
/// Returns an error if the database or the object store does not answer.
pub async fn check_against_head(archive: &Archive, kept: Option<&AuditHead>) -> Result<Findings> {
    let mut findings =
        Findings { faults: archive.store.row_faults().await?, ..Findings::default() };
    documents::check_laws(archive, &mut findings).await?;
    documents::check_effects(archive, &mut findings).await?;
    documents::check_versions(archive, &mut findings).await?;
    documents::check_jobs(archive, &mut findings).await?;
    documents::check_diagnoses(archive, &mut findings).await?;
    objects::check_objects(archive, &mut findings).await?;
    let (entries, faults) = archive.store.audit().find_faults(kept).await?;
    findings.checked.audit = usize::try_from(entries).unwrap_or(usize::MAX);
    findings.faults.extend(faults);
    findings.faults.extend(archive.store.seal_faults().await?);
    findings.clean = findings.faults.is_empty();
    Ok(findings)
}
