//! Excel workbooks (.xlsx): a sheet is read as lines of text, cell by cell, and parsed like CSV.

use std::io::{self, Read, Seek};
use std::panic::{AssertUnwindSafe, catch_unwind};

use calamine::{Data, DataRef, ExcelDateTime, Reader, Xlsx, XlsxCellReader, XlsxError};

use crate::containers::archive;
use crate::csv_file;
use crate::findings::Findings;
use crate::layout;
use crate::limits::FileLimits;
use crate::mapping::Mapping;
use crate::table::Table;

/// Reader of files with random access.
pub(crate) trait ReadSeek: Read + Seek {}
impl<T: Read + Seek> ReadSeek for T {}

/// Number of bytes at the start of a sheet by which the sheet with the table is found.
const START: u64 = 32 << 10;
/// Largest number of sheets that are searched.
const SHEETS: usize = 20;
/// Unpacked size of a workbook, bytes, beyond which only the first sheet is examined: several names
/// may refer to the same large sheet.
const SEARCHED: u64 = 32 << 20;

/// Reads the declared sheet, or the one with most known names in its first lines.
pub(crate) fn read_workbook(
    mut input: Box<dyn ReadSeek + '_>,
    mapping: &Mapping,
    findings: &mut Findings,
) -> Option<Table> {
    let unpacked = check_size(&mut input, mapping.limits)
        .map_err(|message| findings.error(None, None, message))
        .ok()?;
    // The library asserts some properties of the file and panics if they do not hold.
    let read = catch_unwind(AssertUnwindSafe(|| {
        let mut book = Xlsx::new(input).map_err(|error| error.to_string())?;
        let sheet = find_sheet(&mut book, searched_sheets(unpacked), mapping)?;
        let others = book.sheet_names().len() - 1;
        let mut lines = SheetLines::from_sheet(&mut book, &sheet, mapping)
            .map_err(|error| error.to_string())?;
        Ok::<_, String>((csv_file::read_csv(&mut lines, mapping, findings), sheet, others))
    }));
    match read.unwrap_or_else(|_| Err("it contradicts itself".into())) {
        Ok((table, sheet, others)) => {
            if others > 0 && mapping.part.is_none() {
                let message = format!(
                    "the sheet `{sheet}` is read; write `#part=NAME` after the file to read another"
                );
                findings.warning(None, None, message);
            }
            table
        }
        Err(message) => {
            findings.error(None, None, format!("the workbook cannot be read: {message}"));
            None
        }
    }
}

fn check_size(input: &mut Box<dyn ReadSeek + '_>, limits: FileLimits) -> Result<u64, String> {
    let claimed = archive::claimed_bytes(input)?;
    // More than the declared size is damage; the limit of the reader applies in any case.
    archive::check_archive(input, claimed.min(limits.unpacked_bytes as u64))?;
    input.rewind().map_err(|error| error.to_string())?;
    Ok(claimed)
}

fn searched_sheets(unpacked: u64) -> usize {
    if unpacked > SEARCHED { 1 } else { SHEETS }
}

/// Returns the first lines of each sheet.
pub(crate) fn sheet_starts(
    mut input: Box<dyn ReadSeek + '_>,
    limits: FileLimits,
) -> Result<Vec<(String, Vec<u8>)>, String> {
    let unpacked = check_size(&mut input, limits)?;
    let mapping = Mapping { limits, ..Mapping::with_canonical_names() };
    let read = catch_unwind(AssertUnwindSafe(|| {
        let mut book = Xlsx::new(input).map_err(|error| error.to_string())?;
        let names = book.sheet_names().into_iter().take(searched_sheets(unpacked));
        Ok(names.map(|name| (name.clone(), sheet_start(&mut book, &name, &mapping))).collect())
    }));
    read.unwrap_or_else(|_| Err("the workbook contradicts itself".into()))
}

/// Returns the first lines of a sheet; empty for a chart, which is a sheet, too.
fn sheet_start(book: &mut XlsxBook, sheet: &str, mapping: &Mapping) -> Vec<u8> {
    let mut start = Vec::new();
    if let Ok(lines) = SheetLines::from_sheet(book, sheet, mapping) {
        // The error is ignored here: it is reported when the sheet is read.
        let _ = lines.take(START).read_to_end(&mut start);
    }
    start
}

type XlsxBook<'a> = Xlsx<Box<dyn ReadSeek + 'a>>;

fn find_sheet(book: &mut XlsxBook, looked_at: usize, mapping: &Mapping) -> Result<String, String> {
    let names = book.sheet_names();
    if let Some(wanted) = &mapping.part {
        let listed = || names.iter().take(SHEETS).cloned().collect::<Vec<_>>().join(", ");
        let missing = || format!("there is no sheet `{wanted}`; there are {}", listed());
        return names.iter().find(|name| *name == wanted).cloned().ok_or_else(missing);
    }
    let mut best = (0, names.first().cloned().ok_or("it has no sheet")?);
    for name in names.into_iter().take(looked_at) {
        let start = sheet_start(book, &name, mapping);
        let known = layout::count_known_names(&start, mapping);
        // Among equals the first sheet is kept.
        if known > best.0 {
            best = (known, name);
        }
    }
    Ok(best.1)
}

/// Sheet as text: cells separated by tabs, one line for each row, empty rows included, so that line
/// numbers are Excel's row numbers.
struct SheetLines<'a, 'b> {
    cells: XlsxCellReader<'a, Box<dyn ReadSeek + 'b>>,
    /// Cell that was read but belongs to a later row.
    next: Option<(usize, usize, String)>,
    row: usize,
    /// Index of the last column of the widest row so far, to which shorter rows are padded.
    width: usize,
    text: io::Cursor<Vec<u8>>,
    rows: usize,
    columns: usize,
}

impl<'a, 'b> SheetLines<'a, 'b> {
    fn from_sheet(
        book: &'a mut XlsxBook<'b>,
        sheet: &str,
        mapping: &Mapping,
    ) -> Result<Self, XlsxError> {
        // Rows above the table are allowed in addition to the limit.
        let (rows, columns) = (mapping.limits.rows.saturating_add(1000), mapping.limits.columns);
        let cells = book.worksheet_cells_reader(sheet)?;
        let text = io::Cursor::new(Vec::new());
        let mut lines = Self { cells, next: None, row: 0, width: 0, text, rows, columns };
        lines.next = lines.read_cell().map_err(XlsxError::Io)?;
        Ok(lines)
    }

    /// Reads the next cell that is not empty.
    fn read_cell(&mut self) -> io::Result<Option<(usize, usize, String)>> {
        let invalid = |message: String| io::Error::new(io::ErrorKind::InvalidData, message);
        loop {
            let cell = self.cells.next_cell().map_err(|error| invalid(error.to_string()))?;
            let Some(cell) = cell else { return Ok(None) };
            let (row, column) = cell.get_position();
            let text = cell_text(cell.get_value());
            if text.is_empty() {
                continue;
            }
            let (row, column) = (row as usize, column as usize);
            if column >= self.columns || row >= self.rows {
                let message = format!(
                    "a cell in row {}, column {} is beyond the limits of rows and columns",
                    row + 1,
                    column + 1
                );
                return Err(invalid(message));
            }
            return Ok(Some((row, column, text)));
        }
    }

    /// Returns the text of the next row; `None` after the last.
    fn read_line(&mut self) -> io::Result<Option<String>> {
        let Some((row, ..)) = self.next else { return Ok(None) };
        let (mut line, mut column) = (String::new(), 0);
        while let Some((_, at, text)) = self.next.take_if(|(of, ..)| *of == self.row) {
            // Two texts at one position would be read as one.
            if at < column || (at == column && !line.is_empty()) {
                return Err(out_of_order(self.row));
            }
            line.extend(std::iter::repeat_n('\t', at - column));
            line += &text;
            column = at;
            self.next = self.read_cell()?;
        }
        // Rows come in ascending order: an earlier one would be lost.
        if row < self.row {
            return Err(out_of_order(row));
        }
        self.width = self.width.max(column);
        // Rows end after their last cell with content: pad them, as the cells of a row are counted.
        if !line.is_empty() {
            line.extend(std::iter::repeat_n('\t', self.width - column));
        }
        self.row += 1;
        line.push('\n');
        Ok(Some(line))
    }
}

fn out_of_order(row: usize) -> io::Error {
    let message = format!("cells of row {} are out of order or repeated", row + 1);
    io::Error::new(io::ErrorKind::InvalidData, message)
}

impl Read for SheetLines<'_, '_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            let read = self.text.read(buffer)?;
            if read > 0 || buffer.is_empty() {
                return Ok(read);
            }
            match self.read_line()? {
                Some(line) => self.text = io::Cursor::new(line.into_bytes()),
                None => return Ok(0),
            }
        }
    }
}

fn cell_text(value: &DataRef) -> String {
    match Data::from(value.clone()) {
        Data::Int(value) => value.to_string(),
        Data::Float(value) => value.to_string(),
        Data::String(text) | Data::DateTimeIso(text) | Data::DurationIso(text) => plain_text(&text),
        Data::Bool(value) => value.to_string(),
        Data::DateTime(instant) => format_date(&instant),
        Data::Error(error) => error.to_string(),
        Data::Empty => String::new(),
    }
}

/// Replaces the characters of a text that have a meaning between cells.
fn plain_text(text: &str) -> String {
    let plain = |c: char| match c {
        '\t' | '\n' | '\r' => ' ',
        '"' => '\'',
        other => other,
    };
    text.trim().chars().map(plain).collect()
}

/// Formats a date and time of day; without a day only the time of day; a duration in seconds.
fn format_date(instant: &ExcelDateTime) -> String {
    let days = instant.as_f64();
    if instant.is_duration() {
        return (days * 86_400.0).to_string();
    }
    let (year, month, day, hour, minute, second, millisecond) = instant.to_ymd_hms_milli();
    let date = match days {
        // Day 0 of a sheet is no date: the cell is a time of day.
        _ if (0.0..1.0).contains(&days) => String::new(),
        _ => format!("{year:04}-{month:02}-{day:02}T"),
    };
    format!("{date}{hour:02}:{minute:02}:{second:02}.{millisecond:03}")
}

#[cfg(test)]
#[path = "workbook_tests.rs"]
mod tests;
