//! Check of a ZIP archive against the limits before it is read.

use std::io::{Read, Seek};

use zip::ZipArchive;

use super::announced_strings::AnnouncedStrings;

/// Largest number of files in an archive.
const FILES: usize = 10_000;
/// Largest number of unpacked bytes of styles; a reader builds a large description from each few of
/// them.
const STYLES: u64 = 2 << 20;
/// Number of bytes that are unpacked at a time.
const PIECE: usize = 64 << 10;

/// Returns the unpacked size that the archive declares, bytes; a larger content is refused by
/// [`check_archive`].
pub fn claimed_bytes(input: &mut (impl Read + Seek)) -> Result<u64, String> {
    let damaged = |error: zip::result::ZipError| format!("the archive is damaged: {error}");
    let mut archive = ZipArchive::new(input).map_err(damaged)?;
    let files = 0..archive.len().min(FILES);
    let sizes: Result<Vec<u64>, _> =
        files.map(|index| archive.by_index_raw(index).map(|file| file.size())).collect();
    Ok(sizes.map_err(damaged)?.into_iter().fold(0, u64::saturating_add))
}

/// Unpacks every file of the archive without keeping it, and refuses content beyond the limits.
///
/// The declared sizes are not trusted: bytes are counted while they are unpacked.
pub fn check_archive(input: &mut (impl Read + Seek), most: u64) -> Result<(), String> {
    let damaged = |error: zip::result::ZipError| format!("the archive is damaged: {error}");
    let mut archive = ZipArchive::new(input).map_err(damaged)?;
    if archive.len() > FILES {
        return Err(format!("an archive of {} files is not a workbook", archive.len()));
    }
    // An Excel workbook has files whose names contain `sheet`.
    let named = |name: &str| name.to_lowercase().contains("sheet");
    if !archive.file_names().any(|name| name.is_ok_and(|name| named(&name))) {
        return Err("a ZIP archive, but not an Excel workbook; unpack it".into());
    }
    let mut left = most;
    for index in 0..archive.len() {
        let mut file = archive.by_index(index).map_err(damaged)?;
        let name = file.name().map_err(damaged)?.to_lowercase();
        // Styles and themes have a limit of their own, since the reader expands them.
        let of_styles = name.ends_with("styles.xml") || name.contains("theme");
        let bound = if of_styles { STYLES.min(left) } else { left };
        let is_text = name.ends_with(".xml") || name.ends_with(".rels");
        left -= count_unpacked(&mut file, bound, is_text)
            .map_err(|error| format!("{name}: {error}"))?;
    }
    Ok(())
}

/// Returns the number of unpacked bytes of a file.
fn count_unpacked(file: &mut impl Read, bound: u64, is_text: bool) -> Result<u64, String> {
    let (mut buffer, mut bytes) = (vec![0; PIECE], 0);
    let mut announced = AnnouncedStrings::default();
    loop {
        let read = file.read(&mut buffer).map_err(|error| error.to_string())?;
        bytes += read as u64;
        if bytes > bound {
            return Err(format!("more than the limit of {bound} bytes unpacked"));
        }
        if read == 0 {
            return Ok(bytes);
        }
        if is_text {
            check_characters(&buffer[..read])?;
            announced.read_piece(&buffer[..read])?;
        }
    }
}

/// Refuses text with control bytes: XML in UTF-8 (or another encoding that contains ASCII) has none,
/// and in other encodings the number of strings could not be found.
fn check_characters(text: &[u8]) -> Result<(), String> {
    let control = |byte: &u8| *byte < b' ' && !matches!(byte, b'\t' | b'\n' | b'\r');
    if text.iter().any(control) { Err("is not XML in UTF-8".into()) } else { Ok(()) }
}
