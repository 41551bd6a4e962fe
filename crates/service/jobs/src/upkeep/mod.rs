//! Maintenance of an archive: integrity check, garbage collection, backup.

mod backup;
mod documents;
mod findings;
mod fsck;
mod gc;
mod objects;
mod reading;
#[cfg(test)]
mod tests;

pub use backup::{backup, restore};
pub use findings::{Checked, Findings, Unreferred};
pub use fsck::fsck;
pub use gc::{Collected, gc};
pub use sistership_store::{BackupManifest, Fault};
