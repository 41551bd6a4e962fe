//! Test for free space, and the space reserved for the next start.

use crate::error::Result;
use crate::objects_error::ObjectsError;
use crate::reserve;
use crate::statements::{same, statements};
use crate::store::Store;

statements! {
    TRY = same("INSERT INTO idempotency_keys (scope, key, request_sha256, created_us) VALUES ('', \
        'room', '', 0) ON CONFLICT (scope, key) DO UPDATE SET request_sha256 = ''");
    FORGET = same("DELETE FROM idempotency_keys WHERE scope = '' AND key = 'room'");
}

impl Store {
    /// Creates the reserve for the next start on a full disk, unless it exists.
    ///
    /// # Errors
    /// Returns an error if there is no space, or the folder cannot be written.
    pub fn reserve_space(&self) -> Result<()> {
        let Some(reserve) = self.reserve_file() else { return Ok(()) };
        Ok(reserve::create_reserve(reserve).map_err(ObjectsError::from)?)
    }

    /// Writes and removes a row that has no other use, to test for free space.
    pub async fn try_write(&self) -> Result<()> {
        for statement in [TRY, FORGET] {
            let mut tx = self.begin().await?;
            tx.execute(statement, &[]).await?;
            tx.commit().await?;
        }
        Ok(())
    }
}
