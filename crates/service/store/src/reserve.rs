//! Reserved disk space for the start of a process on a full disk: SQLite needs a few pages for the
//! index of its log even to read. A file next to the database occupies them; it is removed if the
//! database cannot be opened otherwise, and created again once there is space.

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use crate::connect;

const BYTES: usize = 1 << 20;

/// Returns the path of the reserve of a database; none if the database is not a file.
pub(crate) fn reserve_path(url: &str) -> Option<PathBuf> {
    let file = connect::sqlite_file(url)?;
    let mut name = file.file_name()?.to_owned();
    name.push(".reserve");
    Some(file.with_file_name(name))
}

/// Removes the reserve; returns true if there was one.
pub(crate) fn release_space(url: &str) -> bool {
    reserve_path(url).is_some_and(|reserve| fs::remove_file(reserve).is_ok())
}

/// Creates the reserve, unless it exists with its full size.
pub(crate) fn create_reserve(reserve: &Path) -> io::Result<()> {
    if fs::metadata(reserve).is_ok_and(|about| about.len() == BYTES as u64) {
        return Ok(());
    }
    write_reserve(reserve).inspect_err(|_| drop(fs::remove_file(reserve)))
}

fn write_reserve(reserve: &Path) -> io::Result<()> {
    let mut file = File::create(reserve)?;
    // Written, not only extended: a sparse file would occupy no space.
    file.write_all(&vec![0; BYTES])?;
    file.sync_all()
}
