//! Room for the start of a process on a full disk: SQLite cannot even read without a few pages for the index of its log. A file
//! beside the database keeps them, goes where the database could not be opened without, and is made again once there is room.

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::PathBuf;

use crate::connect;
use crate::error::Result;
use crate::objects::ObjectsError;
use crate::statements::{same, statements};
use crate::store::Store;

const BYTES: usize = 1 << 20;

statements! {
    TRY = same("INSERT INTO idempotency_keys (scope, key, request_sha256, created_us) VALUES ('', 'room', '', 0) \
        ON CONFLICT (scope, key) DO UPDATE SET request_sha256 = ''");
    FORGET = same("DELETE FROM idempotency_keys WHERE scope = '' AND key = 'room'");
}

/// The reserve of the database at a URL; none where it is no file.
pub(crate) fn of(url: &str) -> Option<PathBuf> {
    let file = connect::sqlite_file(url)?;
    let mut name = file.file_name()?.to_owned();
    name.push(".reserve");
    Some(file.with_file_name(name))
}

/// Gives the room free; returns whether there was any.
pub(crate) fn release(url: &str) -> bool {
    of(url).is_some_and(|reserve| fs::remove_file(reserve).is_ok())
}

impl Store {
    /// Keeps room for the next start on a full disk, if there is none kept yet.
    ///
    /// # Errors
    /// There is no room, or the folder cannot be written.
    pub fn reserve(&self) -> Result<()> {
        let Some(reserve) = self.reserve_file() else { return Ok(()) };
        if fs::metadata(reserve).is_ok_and(|about| about.len() == BYTES as u64) {
            return Ok(());
        }
        Ok(write(reserve).inspect_err(|_| drop(fs::remove_file(reserve))).map_err(ObjectsError::from)?)
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

fn write(reserve: &std::path::Path) -> io::Result<()> {
    let mut file = File::create(reserve)?;
    file.write_all(&vec![0; BYTES])?;
    file.sync_all()
}
