//! Room for the start of a process on a full disk: SQLite cannot even read without a few pages for
//! the index of its log. A file beside the database keeps them, goes where the database could not
//! be opened without, and is made again once there is room.

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use crate::connect;

const BYTES: usize = 1 << 20;

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

/// Makes it, unless it is there as it should be.
pub(crate) fn keep(reserve: &Path) -> io::Result<()> {
    if fs::metadata(reserve).is_ok_and(|about| about.len() == BYTES as u64) {
        return Ok(());
    }
    write(reserve).inspect_err(|_| drop(fs::remove_file(reserve)))
}

fn write(reserve: &Path) -> io::Result<()> {
    let mut file = File::create(reserve)?;
    file.write_all(&vec![0; BYTES])?;
    file.sync_all()
}
