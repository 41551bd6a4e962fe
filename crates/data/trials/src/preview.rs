//! Preview of a file: names, units and the first rows.

use std::io::{self, Cursor, Read};
use std::path::Path;

use csv::{ByteRecord, ReaderBuilder};

use crate::blanks::Blanks;
use crate::layout;
use crate::limits::Limits;
use crate::mat_file;
use crate::nmea_file;
use crate::parquet_footer;
use crate::source::{Content, Source};
use crate::table::Target;
use crate::workbook;

/// Largest number of bytes and of rows that are examined.
const START: u64 = 64 << 10;
const ROWS: usize = 200;

/// Start of a file, as text.
#[derive(Debug, Default)]
pub(crate) struct Preview {
    pub names: Vec<String>,
    /// Units in a row of their own, or empty.
    pub units: Vec<String>,
    /// Cells of the first rows; empty for files that contain no text.
    pub rows: Vec<Vec<String>>,
    /// Sheet, if a workbook has several.
    pub sheet: Option<String>,
    /// NMEA sentences, which need no mapping, and the content of each.
    pub sentences: Vec<(String, Target)>,
}

/// Reads the preview of a file.
///
/// # Errors
/// Returns an error if the file cannot be read or its format contains no table.
pub(crate) fn preview(name: &str, path: &Path) -> io::Result<Preview> {
    let limits = Limits::default();
    match Source::open(name, path)?.content {
        Content::Csv(input) => {
            let mut start = Vec::new();
            input.take(START).read_to_end(&mut start)?;
            Ok(of_text(&line_ends(start)))
        }
        Content::Workbook(input) => {
            let sheets = workbook::starts(input, limits).map_err(io::Error::other)?;
            let several = sheets.len() > 1;
            let seen = sheets.into_iter().map(|(sheet, start)| (sheet, of_text(&start)));
            // `max_by_key` returns the last of equals: reversed, it is the first.
            let best = seen.rev().max_by_key(|(_, preview)| preview.rows.len());
            let (sheet, preview) = best.ok_or_else(|| io::Error::other("it has no sheet"))?;
            Ok(Preview { sheet: several.then_some(sheet), ..preview })
        }
        Content::Matlab(input) => {
            Ok(Preview { names: mat_file::names(input, limits)?, ..Preview::default() })
        }
        Content::ParquetFile(file) => {
            // Segments are read of a long log, so that it may have any number of rows.
            let opened = parquet_footer::open(file, Limits { rows: usize::MAX, ..limits });
            let reader = opened.map_err(|refused| io::Error::other(refused.to_string()))?;
            Ok(Preview { names: parquet_footer::headers(&reader), ..Preview::default() })
        }
        Content::Nmea(input) => {
            let mut start = Vec::new();
            input.take(START).read_to_end(&mut start)?;
            let sentences = nmea_file::contents(&String::from_utf8_lossy(&start));
            Ok(Preview { sentences, ..Preview::default() })
        }
        Content::Other(what) => Err(io::Error::other(format!("the file is {what}"))),
        Content::ParquetBytes(_) => Err(io::Error::other("bytes are no file")),
    }
}

fn line_ends(text: Vec<u8>) -> Vec<u8> {
    let text = String::from_utf8(text).unwrap_or_else(|error| layout::latin_1(error.as_bytes()));
    text.replace("\r\n", "\n").replace('\r', "\n").into_bytes()
}

fn of_text(start: &[u8]) -> Preview {
    let layout = layout::guess(start);
    let by_blanks = layout.separator == b' ';
    let mut reader = ReaderBuilder::new()
        .delimiter(if by_blanks { b'\t' } else { layout.separator })
        .flexible(true)
        .has_headers(false)
        .from_reader(Blanks::new(Cursor::new(layout::body(start, &layout)), by_blanks));
    let (mut record, mut rows) = (ByteRecord::new(), Vec::new());
    while rows.len() < ROWS && reader.read_byte_record(&mut record).unwrap_or(false) {
        rows.push(record.iter().map(layout::name).collect());
    }
    let mut rows = rows.into_iter();
    let names: Vec<String> = rows.next().unwrap_or_default();
    let rows = rows.skip(usize::from(!layout.units.is_empty())).collect();
    let names = names.into_iter().map(|name| name.trim_start_matches('\u{feff}').to_owned());
    Preview { names: names.collect(), units: layout.units, rows, ..Preview::default() }
}
