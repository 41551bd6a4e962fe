//! Archive file of an FMU.

use std::borrow::Cow;
use std::io::{Cursor, Write};

use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use crate::error::ExportError;

/// File of the archive.
pub struct ArchiveEntry {
    place: Cow<'static, str>,
    bytes: Cow<'static, [u8]>,
}

impl ArchiveEntry {
    /// Creates a file with a path and its bytes.
    pub fn new(place: impl Into<Cow<'static, str>>, bytes: impl Into<Cow<'static, [u8]>>) -> Self {
        Self { place: place.into(), bytes: bytes.into() }
    }

    /// Creates a file of the library's sources.
    pub fn source_entry(&(name, text): &(&'static str, &'static str)) -> Self {
        Self::new(format!("sources/{name}"), text.as_bytes())
    }
}

/// Sources of the library by name; headers are those of the standard, with their licence.
pub const SOURCES: [(&str, &str); 10] = [
    ("model.h", include_str!("../../runtime/model.h")),
    ("model.c", include_str!("../../runtime/model.c")),
    ("fmi2.c", include_str!("../../runtime/fmi2.c")),
    ("fmi3.c", include_str!("../../runtime/fmi3.c")),
    ("headers/fmi2Functions.h", include_str!("../../runtime/headers/fmi2Functions.h")),
    ("headers/fmi2FunctionTypes.h", include_str!("../../runtime/headers/fmi2FunctionTypes.h")),
    ("headers/fmi2TypesPlatform.h", include_str!("../../runtime/headers/fmi2TypesPlatform.h")),
    ("headers/fmi3Functions.h", include_str!("../../runtime/headers/fmi3Functions.h")),
    ("headers/fmi3FunctionTypes.h", include_str!("../../runtime/headers/fmi3FunctionTypes.h")),
    ("headers/fmi3PlatformTypes.h", include_str!("../../runtime/headers/fmi3PlatformTypes.h")),
];

/// Returns the bytes of the archive; the same files give the same bytes.
///
/// # Errors
/// Returns an error if it cannot be packed.
pub fn pack_archive(entries: &[ArchiveEntry]) -> Result<Vec<u8>, ExportError> {
    let pack = || -> zip::result::ZipResult<Vec<u8>> {
        let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
        // Fixed times, so that the bytes do not depend on the clock.
        let time = zip::DateTime::default();
        let plain = SimpleFileOptions::default().last_modified_time(time).unix_permissions(0o644);
        for ArchiveEntry { place, bytes } in entries {
            // Shared libraries are executable.
            let mode = if place.contains("binaries/") { 0o755 } else { 0o644 };
            writer.start_file(place.as_ref(), plain.unix_permissions(mode))?;
            writer.write_all(bytes)?;
        }
        Ok(writer.finish()?.into_inner())
    };
    pack().map_err(|error| ExportError::Archive(error.to_string()))
}
