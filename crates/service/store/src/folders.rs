//! Creation of folders that survives a power failure.

use std::fs::File;
use std::io;
use std::path::Path;

/// Creates a folder and its missing parents, and syncs each new entry to the disk.
pub(crate) fn create_durably(folder: &Path) -> io::Result<()> {
    let missing: Vec<_> = folder
        .ancestors()
        .take_while(|above| !above.as_os_str().is_empty() && !above.exists())
        .collect();
    std::fs::create_dir_all(folder)?;
    // The entry of a new folder is in its parent, which must be synced.
    missing.into_iter().filter_map(Path::parent).try_for_each(sync_folder)
}

/// Syncs the entries of a folder to the disk; does nothing on systems other than Unix.
pub(crate) fn sync_folder(folder: &Path) -> io::Result<()> {
    let here = folder.as_os_str().is_empty();
    match cfg!(unix) {
        true => File::open(if here { Path::new(".") } else { folder })?.sync_all(),
        false => Ok(()),
    }
}
