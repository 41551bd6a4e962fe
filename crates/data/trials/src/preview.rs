//! Preview of a file: names, units and the first rows.

use std::io::{self, Cursor, Read};
use std::path::Path;

use csv::{ByteRecord, ReaderBuilder};

use crate::blanks::TabbedReader;
use crate::layout;
use crate::limits::FileLimits;
use crate::nmea_file;
use crate::parquet_footer;
use crate::table::ColumnTarget;
use crate::trial_file::{InputContent, TrialFile};
use crate::workbook;

/// Largest number of bytes and of rows that are examined.
const START: u64 = 64 << 10;
const ROWS: usize = 200;

/// Start of a file, as text.
#[derive(Debug, Default)]
pub(crate) struct FilePreview {
    pub names: Vec<String>,
    /// Units in a row of their own, or empty.
    pub units: Vec<String>,
    /// Cells of the first rows; empty for files that contain no text.
    pub rows: Vec<Vec<String>>,
    /// Sheet, if a workbook has several.
    pub sheet: Option<String>,
    /// NMEA sentences, which need no mapping, and the content of each.
    pub sentences: Vec<(String, ColumnTarget)>,
}

/// Reads the preview of a file.
///
/// # Errors
/// Returns an error if the file cannot be read or its format contains no table.
pub(crate) fn preview_file(name: &str, path: &Path) -> io::Result<FilePreview> {
    let limits = FileLimits::default();
    match TrialFile::open(name, path)?.content {
        InputContent::Csv(input) => {
            let mut start = Vec::new();
            input.take(START).read_to_end(&mut start)?;
            Ok(preview_text(&normalise_text(start)))
        }
        InputContent::Workbook(input) => {
            let sheets = workbook::sheet_starts(input, limits).map_err(io::Error::other)?;
            let several = sheets.len() > 1;
            let seen = sheets.into_iter().map(|(sheet, start)| (sheet, preview_text(&start)));
            // `max_by_key` returns the last of equals: reversed, it is the first.
            let best = seen.rev().max_by_key(|(_, preview)| preview.rows.len());
            let (sheet, preview) = best.ok_or_else(|| io::Error::other("it has no sheet"))?;
            Ok(FilePreview { sheet: several.then_some(sheet), ..preview })
        }
        InputContent::Columns(file) => {
            let (names, units) = file.read_header(limits)?;
            Ok(FilePreview { names, units, ..FilePreview::default() })
        }
        InputContent::ParquetFile(file) => {
            // Segments are read of a long log, so that it may have any number of rows.
            let opened = parquet_footer::open_file(file, FileLimits { rows: usize::MAX, ..limits });
            let reader = opened.map_err(|refused| io::Error::other(refused.to_string()))?;
            Ok(FilePreview {
                names: parquet_footer::header_names(&reader),
                ..FilePreview::default()
            })
        }
        InputContent::Nmea(input) => {
            let mut start = Vec::new();
            input.take(START).read_to_end(&mut start)?;
            let sentences = nmea_file::sentence_contents(&String::from_utf8_lossy(&start));
            Ok(FilePreview { sentences, ..FilePreview::default() })
        }
        InputContent::Other(what) => Err(io::Error::other(format!("the file is {what}"))),
        InputContent::ParquetBytes(_) => {
            Err(io::Error::other("the content is not a file that can be read"))
        }
    }
}

fn normalise_text(text: Vec<u8>) -> Vec<u8> {
    let text =
        String::from_utf8(text).unwrap_or_else(|error| layout::decode_latin_1(error.as_bytes()));
    text.replace("\r\n", "\n").replace('\r', "\n").into_bytes()
}

fn preview_text(start: &[u8]) -> FilePreview {
    let layout = layout::guess_layout(start);
    let by_blanks = layout.separator == b' ';
    let mut reader = ReaderBuilder::new()
        .delimiter(if by_blanks { b'\t' } else { layout.separator })
        .flexible(true)
        .has_headers(false)
        .from_reader(TabbedReader::new(Cursor::new(layout::table_body(start, &layout)), by_blanks));
    let (mut record, mut rows) = (ByteRecord::new(), Vec::new());
    while rows.len() < ROWS && reader.read_byte_record(&mut record).unwrap_or(false) {
        rows.push(record.iter().map(layout::header_text).collect());
    }
    let mut rows = rows.into_iter();
    let names: Vec<String> = rows.next().unwrap_or_default();
    let rows = rows.skip(usize::from(!layout.units.is_empty())).collect();
    let names = names.into_iter().map(|name| name.trim_start_matches('\u{feff}').to_owned());
    FilePreview { names: names.collect(), units: layout.units, rows, ..FilePreview::default() }
}
