//! Whether there is room to write, and the room kept for the next start.

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
    /// Keeps room for the next start on a full disk, if there is none kept yet.
    ///
    /// # Errors
    /// There is no room, or the folder cannot be written.
    pub fn reserve(&self) -> Result<()> {
        let Some(reserve) = self.reserve_file() else { return Ok(()) };
        Ok(reserve::keep(reserve).map_err(ObjectsError::from)?)
    }

    /// Writes something that nobody needs, to find out whether there is room.
    pub async fn try_write(&self) -> Result<()> {
        for statement in [TRY, FORGET] {
            let mut tx = self.begin().await?;
            tx.execute(statement, &[]).await?;
            tx.commit().await?;
        }
        Ok(())
    }
}
