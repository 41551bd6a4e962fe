//! Folders that are still there after the power has failed.

use std::fs::File;
use std::io;
use std::path::Path;

/// Makes a folder and those above it, and writes each new entry to the disk.
pub(crate) fn make(folder: &Path) -> io::Result<()> {
    let missing: Vec<_> = folder
        .ancestors()
        .take_while(|above| !above.as_os_str().is_empty() && !above.exists())
        .collect();
    std::fs::create_dir_all(folder)?;
    missing.into_iter().filter_map(Path::parent).try_for_each(sync)
}

/// Writes a folder's entries to the disk.
pub(crate) fn sync(folder: &Path) -> io::Result<()> {
    let here = folder.as_os_str().is_empty();
    match cfg!(unix) {
        true => File::open(if here { Path::new(".") } else { folder })?.sync_all(),
        false => Ok(()),
    }
}
