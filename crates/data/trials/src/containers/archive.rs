//! A ZIP archive held against the limits before anything is made of it.

use std::io::{Read, Seek};

use zip::ZipArchive;

/// Files in an archive.
const FILES: usize = 10_000;
/// Unpacked bytes of styles, of each few of which a reader makes a whole description.
const STYLES: u64 = 2 << 20;
/// How many strings a workbook may announce, since room is made for them at once.
const STRINGS: u64 = 4_000_000;
/// The attribute by which it does.
const ANNOUNCES: &[u8] = b"uniqueCount";
/// Bytes that are unpacked at a time.
const PIECE: usize = 64 << 10;

/// Bytes that the archive says it holds when unpacked; more are refused by [`check`].
pub fn claimed(input: &mut (impl Read + Seek)) -> Result<u64, String> {
    let damaged = |error: zip::result::ZipError| format!("the archive is damaged: {error}");
    let mut archive = ZipArchive::new(input).map_err(damaged)?;
    let files = 0..archive.len().min(FILES);
    let sizes: Result<Vec<u64>, _> =
        files.map(|index| archive.by_index_raw(index).map(|file| file.size())).collect();
    Ok(sizes.map_err(damaged)?.into_iter().fold(0, u64::saturating_add))
}

/// Unpacks every file of the archive without keeping it.
///
/// What the archive says of sizes is not believed: bytes are counted as they come.
pub fn check(input: &mut (impl Read + Seek), most: u64) -> Result<(), String> {
    let damaged = |error: zip::result::ZipError| format!("the archive is damaged: {error}");
    let mut archive = ZipArchive::new(input).map_err(damaged)?;
    if archive.len() > FILES {
        return Err(format!("an archive of {} files is no workbook", archive.len()));
    }
    let named = |name: &str| name.to_lowercase().contains("sheet");
    if !archive.file_names().any(|name| name.is_ok_and(|name| named(&name))) {
        return Err("a ZIP archive that is no Excel workbook; unpack it".into());
    }
    let mut left = most;
    for index in 0..archive.len() {
        let mut file = archive.by_index(index).map_err(damaged)?;
        let name = file.name().map_err(damaged)?.to_lowercase();
        let of_styles = name.ends_with("styles.xml") || name.contains("theme");
        let bound = if of_styles { STYLES.min(left) } else { left };
        let is_text = name.ends_with(".xml") || name.ends_with(".rels");
        left -= unpack(&mut file, bound, is_text).map_err(|error| format!("{name}: {error}"))?;
    }
    Ok(())
}

/// How many bytes a file has.
fn unpack(file: &mut impl Read, bound: u64, is_text: bool) -> Result<u64, String> {
    let (mut piece, mut kept, mut bytes) = (vec![0; PIECE], 0, 0);
    loop {
        // The end of the piece before stays in front, so that nothing is missed between two pieces.
        let read = file.read(&mut piece[kept..]).map_err(|error| error.to_string())?;
        bytes += read as u64;
        if bytes > bound {
            return Err(format!("more than the {bound} unpacked bytes that are read"));
        }
        if read == 0 {
            return Ok(bytes);
        }
        let text = &piece[..kept + read];
        if is_text {
            check_text(text)?;
        }
        let keep = text.len().min(64);
        piece.copy_within(kept + read - keep..kept + read, 0);
        kept = keep;
    }
}

/// XML in UTF-8 (or another code that contains ASCII) has no such bytes; in others, what is looked
/// for could hide.
fn check_text(text: &[u8]) -> Result<(), String> {
    if text.iter().any(|&byte| byte < b' ' && !matches!(byte, b'\t' | b'\n' | b'\r')) {
        return Err("is not XML in UTF-8".into());
    }
    let announced =
        text.windows(ANNOUNCES.len()).enumerate().filter(|(_, part)| *part == ANNOUNCES);
    for (at, _) in announced {
        let value = &text[at + ANNOUNCES.len()..];
        let digits = value.iter().skip_while(|byte| !byte.is_ascii_digit()).take(20);
        let count = digits.take_while(|byte| byte.is_ascii_digit());
        let count = count.fold(0_u64, |n, byte| n.saturating_mul(10) + u64::from(byte - b'0'));
        if count > STRINGS {
            return Err(format!(
                "announces {count} strings, more than the {STRINGS} that are read"
            ));
        }
    }
    Ok(())
}
