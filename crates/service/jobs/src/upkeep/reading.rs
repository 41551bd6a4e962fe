//! Looking for something: whether it is there, and what of it is a fault and not an error.

use sistership_store::{Objects, StoreError};

use crate::error::DeriveError;

/// Rows read at a time: documents may be long.
pub(super) const ROWS: i64 = 100;

/// Whether there is an object of this key; of what is no key there is none.
pub(super) async fn there(objects: &Objects, key: &str) -> Result<bool, StoreError> {
    match objects.exists(key).await {
        Err(StoreError::Invalid { .. }) => Ok(false),
        other => other,
    }
}

/// What is wrong with something that was looked for, as words; where the store itself did not
/// answer, that is the error.
pub(super) fn fault(error: DeriveError) -> Result<String, StoreError> {
    match error {
        DeriveError::Store(error) => store_fault(error),
        other => Ok(other.to_string()),
    }
}

/// The same of an error of the store itself.
pub(super) fn store_fault(error: StoreError) -> Result<String, StoreError> {
    match error {
        StoreError::NotFound { .. } | StoreError::Invalid { .. } => Ok(error.to_string()),
        StoreError::Objects(sistership_store::ObjectsError::Damaged { .. }) => {
            Ok(error.to_string())
        }
        other => Err(other),
    }
}
