//! Maintenance of an archive: integrity check, garbage collection, backup.

mod backup;
mod documents;
mod findings;
mod fsck;
mod gc;
mod lookup;
mod objects;
#[cfg(test)]
mod tests;

pub use backup::{back_up_archive, restore_archive};
pub use findings::{CheckCounts, Findings, UnreferencedObjects};
pub use fsck::{check_against_head, check_archive};
pub use gc::{RemovedObjects, collect_garbage};
pub use sistership_store::{AuditHead, BackupManifest, IntegrityFault};
