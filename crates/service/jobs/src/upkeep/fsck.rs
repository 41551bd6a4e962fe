//! Every hash, and every reference between rows, documents and objects.

use sistership_store::Result;

use super::findings::Findings;
use super::{documents, objects};
use crate::archive::Archive;

/// Checks all of an archive. It changes nothing, and others may write meanwhile.
///
/// # Errors
/// The database or the object store does not answer; what they hold is told as faults.
pub async fn fsck(archive: &Archive) -> Result<Findings> {
    let mut findings =
        Findings { faults: archive.store.row_faults().await?, ..Findings::default() };
    documents::laws(archive, &mut findings).await?;
    documents::effects(archive, &mut findings).await?;
    documents::versions(archive, &mut findings).await?;
    documents::jobs(archive, &mut findings).await?;
    documents::diagnoses(archive, &mut findings).await?;
    objects::check(archive, &mut findings).await?;
    let (entries, faults) = archive.store.audit().faults().await?;
    findings.checked.audit = usize::try_from(entries).unwrap_or(usize::MAX);
    findings.faults.extend(faults);
    findings.clean = findings.faults.is_empty();
    Ok(findings)
}
