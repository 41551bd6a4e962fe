//! Looking after an archive: whether all of it is there and unharmed, and what of it nobody needs.

mod backup;
mod documents;
mod fsck;
mod gc;
mod objects;
#[cfg(test)]
mod tests;

pub use backup::{backup, restore};
pub use fsck::{Checked, Findings, fsck};
pub use gc::{Collected, gc};
pub use objects::Unreferred;
pub use sistership_store::{BackupManifest, Fault};

use sistership_store::{Objects, StoreError};

use crate::derive::DeriveError;

/// Rows read at a time: documents may be long.
const ROWS: i64 = 100;

/// Whether there is an object of this key; of what is no key there is none.
async fn there(objects: &Objects, key: &str) -> Result<bool, StoreError> {
    match objects.exists(key).await {
        Err(StoreError::Invalid { .. }) => Ok(false),
        other => other,
    }
}

/// What is wrong with something that was looked for, as words; where the store itself did not answer, that is the error.
fn fault(error: DeriveError) -> Result<String, StoreError> {
    match error {
        DeriveError::Store(error) => store_fault(error),
        other => Ok(other.to_string()),
    }
}

fn store_fault(error: StoreError) -> Result<String, StoreError> {
    match error {
        StoreError::NotFound { .. } | StoreError::Invalid { .. } => Ok(error.to_string()),
        StoreError::Objects(sistership_store::ObjectsError::Damaged { .. }) => Ok(error.to_string()),
        other => Err(other),
    }
}
