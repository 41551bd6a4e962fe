//! Preview of a file: names, units and the first rows.

use std::io::{self, Cursor, Read};
use std::path::Path;

use csv::{ByteRecord, ReaderBuilder};

use crate::blanks::TabbedReader;
use crate::column_reader::ColumnHeaders;
use crate::layout;
use crate::limits::FileLimits;
use crate::nmea_file;
use crate::parquet_footer;
use crate::table::ColumnTarget;
use crate::text_decoder::decode_text;
use crate::trial_file::{InputContent, TrialFile};
use crate::workbook::{self, ReadSeek};

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
    /// Sheet, structure or group, if the file has several.
    pub part: Option<String>,
    /// NMEA sentences, which need no mapping, and the content of each.
    pub sentences: Vec<(String, ColumnTarget)>,
}

/// Reads the preview of each table of a file: of each sheet of a workbook that has the rows of a
/// trial, of each structure or group with a time of its own, and of the only table of any other
/// file.
///
/// # Errors
/// Returns an error if the file cannot be read or its format contains no table.
pub(crate) fn preview_tables(name: &str, path: &Path) -> io::Result<Vec<FilePreview>> {
    match TrialFile::open(name, path)?.content {
        InputContent::Workbook(input) => preview_sheets(input),
        InputContent::Columns(file) => {
            let headers = file.read_headers(FileLimits::default())?;
            let of = |ColumnHeaders { part, names, units }| FilePreview {
                part,
                names,
                units,
                ..FilePreview::default()
            };
            Ok(headers.into_iter().map(of).collect())
        }
        other => Ok(vec![preview_content(other)?]),
    }
}

/// Fewest rows with so many values of a sheet that is read beside others.
const SHEET_ROWS: usize = 20;
const SHEET_VALUES: usize = 3;

fn preview_sheets(input: Box<dyn ReadSeek + '_>) -> io::Result<Vec<FilePreview>> {
    let sheets = workbook::sheet_starts(input, FileLimits::default()).map_err(io::Error::other)?;
    let several = sheets.len() > 1;
    let seen = sheets.into_iter().map(|(sheet, start)| FilePreview {
        part: several.then_some(sheet),
        ..preview_text(&start)
    });
    let seen: Vec<FilePreview> = seen.collect();
    let has_values = |row: &&Vec<String>| {
        row.iter().filter(|cell| layout::is_value(cell, b'\t')).count() >= SHEET_VALUES
    };
    let is_table = |one: &FilePreview| one.rows.iter().filter(has_values).count() >= SHEET_ROWS;
    // Sheets of notes and particulars are left out where others hold recordings.
    if seen.iter().any(is_table) {
        return Ok(seen.into_iter().filter(is_table).collect());
    }
    // `max_by_key` returns the last of equals: reversed, it is the first.
    let best = seen.into_iter().rev().max_by_key(|preview| preview.rows.len());
    Ok(vec![best.ok_or_else(|| io::Error::other("it has no sheet"))?])
}

fn preview_content(content: InputContent) -> io::Result<FilePreview> {
    let limits = FileLimits::default();
    match content {
        InputContent::Csv(input) => {
            let mut start = Vec::new();
            input.take(START).read_to_end(&mut start)?;
            Ok(preview_text(&normalise_text(start)))
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
        InputContent::Workbook(_) | InputContent::Columns(_) | InputContent::ParquetBytes(_) => {
            Err(io::Error::other("the content is not a file that can be read"))
        }
    }
}

fn normalise_text(text: Vec<u8>) -> Vec<u8> {
    decode_text(&text).replace("\r\n", "\n").replace('\r', "\n").into_bytes()
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
