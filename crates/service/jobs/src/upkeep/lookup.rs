//! Lookups of the checks: presence of objects, and the distinction of faults and errors.

use sistership_store::{ObjectStorage, StoreError};

use crate::error::DeriveError;

/// Number of rows read at a time: documents may be long.
pub(super) const PAGE_ROWS: i64 = 100;

/// Returns true if there is an object with this key; false for an invalid key.
pub(super) async fn object_exists(objects: &ObjectStorage, key: &str) -> Result<bool, StoreError> {
    match objects.exists(key).await {
        // A damaged document may name anything as a key.
        Err(StoreError::Invalid { .. }) => Ok(false),
        other => other,
    }
}

/// Returns the fault of a failed lookup in words, or the error if the store itself did not answer.
pub(super) fn describe_fault(error: DeriveError) -> Result<String, StoreError> {
    match error {
        DeriveError::Store(error) => describe_store_fault(error),
        other => Ok(other.to_string()),
    }
}

/// Returns the fault of an error of the store in words, or the error if it did not answer.
pub(super) fn describe_store_fault(error: StoreError) -> Result<String, StoreError> {
    match error {
        StoreError::NotFound { .. } | StoreError::Invalid { .. } => Ok(error.to_string()),
        StoreError::Objects(sistership_store::ObjectsError::Damaged { .. }) => {
            Ok(error.to_string())
        }
        other => Err(other),
    }
}
