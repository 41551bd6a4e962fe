//! CSV, streamed row by row.

use std::io::{Chain, Cursor, Read};

use csv::{ByteRecord, ReaderBuilder};

use crate::blanks::TabbedReader;
use crate::cell_value::read_value;
use crate::cells::{CellCount, CellCounter};
use crate::clock::ColumnClock;
use crate::decimals::DecimalMarks;
use crate::findings::Findings;
use crate::layout::{self, TableLayout};
use crate::limits::too_many_rows;
use crate::mapping::Mapping;
use crate::metered::{MeteredReader, RowMeter};
use crate::number::CellFault;
use crate::resolve::{HeaderRows, resolve_heading};
use crate::row_sink::{RowSink, RowSource, time_column};
use crate::stream;
use crate::table::{ColumnTarget, Table, TableColumn, memory_columns};

/// Number of bytes that are read at a time in the search for the header.
const CHUNK: u64 = 4096;

/// Reads the mapped columns; returns `None` after errors that prevent any check.
///
/// The number of a row is that of the line in which it starts, as an editor shows it: the first
/// line is 1, and blank lines and those within quoted cells count.
pub(crate) fn read_csv(
    input: impl Read,
    mapping: &Mapping,
    findings: &mut Findings,
) -> Option<Table> {
    stream::read_whole(CsvRows::open(input, mapping, findings)?, mapping, findings)
}

/// Lines that were read ahead, and the rest of the file.
type WholeText<R> = Chain<Cursor<Vec<u8>>, MeteredReader<R>>;

/// Rows of a CSV file whose header has been read.
pub(crate) struct CsvRows<R> {
    reader: csv::Reader<TabbedReader<WholeText<R>>>,
    meter: RowMeter,
    columns: Vec<TableColumn>,
    room: usize,
    cells: RowReader,
    /// Row and reason at which reading stopped.
    stopped: Option<(usize, String)>,
}

impl<R: Read> CsvRows<R> {
    /// Reads the header; returns `None` after errors.
    pub(crate) fn open(input: R, mapping: &Mapping, findings: &mut Findings) -> Option<Self> {
        let (mut metered, meter) = MeteredReader::new(input, mapping.limits.line_bytes);
        let start = read_start(&mut metered, &meter, mapping, findings)?;
        let layout = layout::find_table(&start, mapping);
        let whole = Cursor::new(layout::table_body(&start, &layout)).chain(metered);
        let mut reader = open_reader(whole, layout.separator);
        let headers = read_headers(&mut reader, mapping, findings)?;
        // The header is no part of the first row's length.
        meter.end_row();
        let columns = resolve_heading(file_heading(&headers, &layout), mapping, findings)?;
        let cells = RowReader {
            shift: layout.line_shift(),
            most: mapping.limits.rows,
            units: !layout.units.is_empty(),
            time: time_column(&columns).map(|at| columns[at].clone()),
            clock: ColumnClock::from_columns(&columns),
            counter: CellCounter::new(layout.separator, headers.len()),
            decimals: DecimalMarks::new(layout.separator),
        };
        Some(Self { reader, meter, columns, room: mapping.room, cells, stopped: None })
    }
}

impl<R: Read> RowSource for CsvRows<R> {
    fn columns(&self) -> &[TableColumn] {
        &self.columns
    }

    fn expected_rows(&self) -> usize {
        self.room
    }

    fn feed_rows(&mut self, taker: &mut impl RowSink) {
        self.stopped = self.cells.read_rows(&mut self.reader, &self.meter, taker).err();
    }

    fn complete_table(&mut self, drops: bool, table: &mut Table, findings: &mut Findings) {
        self.cells.counter.report_counts(drops, findings);
        self.cells.decimals.report_marks(findings);
        self.cells.clock.rebase_table(table, findings);
        if let Some((row, message)) = &self.stopped {
            findings.error(Some(*row), None, message.clone());
        }
    }
}

/// Returns an upper bound of the number of rows, and the number of columns that are read; `None` if
/// the header is invalid.
pub(crate) fn measure_csv(mut input: impl Read, mapping: &Mapping) -> Option<(usize, usize)> {
    let (mut rows, mut before, mut start) = (1, 0, Vec::new());
    input.by_ref().take(mapping.limits.line_bytes as u64).read_to_end(&mut start).ok()?;
    let columns = count_columns(&start[..], mapping)?;
    let mut buffer = vec![0; 64 << 10];
    // Every line end counts, `\r\n` once; quoted cells can only make the number of rows smaller.
    let mut count = |bytes: &[u8]| {
        for &byte in bytes {
            rows += usize::from(byte == b'\r' || (byte == b'\n' && before != b'\r'));
            before = byte;
        }
    };
    count(&start);
    loop {
        match input.read(&mut buffer).ok()? {
            0 => return Some((rows, columns)),
            read => count(&buffer[..read]),
        }
    }
}

/// Returns the number of columns that are read of a file with this start.
fn count_columns(start: &[u8], mapping: &Mapping) -> Option<usize> {
    let mut findings = Findings::default();
    let layout = layout::find_table(start, mapping);
    let mut reader = open_reader(Cursor::new(layout::table_body(start, &layout)), layout.separator);
    let headers = read_headers(&mut reader, mapping, &mut findings)?;
    let columns = resolve_heading(file_heading(&headers, &layout), mapping, &mut findings)?;
    Some(memory_columns(&columns))
}

fn open_reader<R: Read>(input: R, separator: u8) -> csv::Reader<TabbedReader<R>> {
    let by_blanks = separator == b' ';
    let delimiter = if by_blanks { b'\t' } else { separator };
    let input = TabbedReader::new(input, by_blanks);
    ReaderBuilder::new().delimiter(delimiter).flexible(true).from_reader(input)
}

fn file_heading<'a>(names: &'a [String], layout: &'a TableLayout) -> HeaderRows<'a> {
    HeaderRows { names, units: &layout.units, row: layout.lines + 1 }
}

/// Reads the file at least up to the line below the header, however small the pieces that the
/// reader returns.
fn read_start(
    input: &mut impl Read,
    meter: &RowMeter,
    mapping: &Mapping,
    findings: &mut Findings,
) -> Option<Vec<u8>> {
    let mut start = Vec::new();
    loop {
        let read = match input.by_ref().take(CHUNK).read_to_end(&mut start) {
            Ok(read) => read,
            Err(error) => {
                findings.error(None, None, format!("cannot be read: {error}"));
                return None;
            }
        };
        if read == 0
            || start.len() > mapping.limits.line_bytes
            || layout::is_settled(&start, mapping)
        {
            return Some(start);
        }
        // Lines before the header are complete rows for the limit of their length.
        if start[start.len() - read..].contains(&b'\n') {
            meter.end_row();
        }
    }
}

fn read_headers(
    reader: &mut csv::Reader<impl Read>,
    mapping: &Mapping,
    findings: &mut Findings,
) -> Option<Vec<String>> {
    let record = match reader.byte_headers() {
        Ok(record) => record,
        Err(error) => {
            findings.error(Some(1), None, format!("the header cannot be read: {error}"));
            return None;
        }
    };
    let headers: Vec<String> = record.iter().map(layout::header_text).collect();
    let problem = match headers.len() {
        0 => "the file is empty; it needs a header with column names".to_owned(),
        n if n > mapping.limits.columns => {
            format!("{n} columns are more than the limit of {}", mapping.limits.columns)
        }
        _ => return Some(headers),
    };
    findings.error(Some(1), None, problem);
    None
}

/// State of reading that changes from row to row.
struct RowReader {
    /// Number of lines before those that are read; negative if a header was added.
    shift: isize,
    /// Largest number of rows that are read.
    most: usize,
    /// True if the first row holds units.
    units: bool,
    /// The column of time.
    time: Option<TableColumn>,
    clock: ColumnClock,
    counter: CellCounter,
    decimals: DecimalMarks,
}

impl RowReader {
    /// Passes every row to the sink; returns the row and the reason if reading cannot continue.
    fn read_rows(
        &mut self,
        reader: &mut csv::Reader<impl Read>,
        meter: &RowMeter,
        taker: &mut impl RowSink,
    ) -> Result<(), (usize, String)> {
        let mut record = ByteRecord::new();
        loop {
            // The position before the record, for messages: after an error it no longer names the
            // row.
            let before = reader.position().line();
            let more = reader.read_byte_record(&mut record).map_err(|error| {
                let next = line_number(before).saturating_add_signed(self.shift);
                (next, format!("cannot be read further: {error}"))
            })?;
            if !more {
                return Ok(());
            }
            let row = record_line(reader, &record, before).saturating_add_signed(self.shift);
            meter.end_row();
            if std::mem::take(&mut self.units) {
                continue;
            }
            if !self.read_row(row, &record, taker) {
                return Err((row, too_many_rows(self.most)));
            }
        }
    }

    /// Passes a row to the sink; returns false if it exceeds the number of rows.
    fn read_row<T: RowSink>(&mut self, row: usize, record: &ByteRecord, taker: &mut T) -> bool {
        match self.counter.count_row(row, record) {
            CellCount::Fit if T::TIMED => return self.read_timed_row(row, record, taker),
            CellCount::Fit if taker.stored_rows() >= self.most => return false,
            CellCount::Fit => taker.take_row(row, |_, column| self.read_cell(row, record, column)),
            CellCount::Few(_) => taker.take_short_row(row),
            CellCount::Many => {}
        }
        true
    }

    /// Converts the time of a row, and passes the row on if the sink accepts it.
    fn read_timed_row(
        &mut self,
        row: usize,
        record: &ByteRecord,
        taker: &mut impl RowSink,
    ) -> bool {
        // Taken out and put back, since `read_cell` borrows `self` mutably.
        let Some(column) = self.time.take() else { return true };
        let time = self.read_cell(row, record, &column);
        let si = time.as_ref().ok().map(|time| time * column.to_si);
        self.time = Some(column);
        let t_s = si.and_then(|si| self.clock.seconds_since_start(si));
        if !taker.accepts_row(row, t_s, &self.clock) {
            return true;
        }
        if taker.stored_rows() >= self.most {
            return false;
        }
        taker.take_row(row, |_, column| match column.target {
            ColumnTarget::Time => time.clone(),
            _ => self.read_cell(row, record, column),
        });
        true
    }

    #[inline]
    fn read_cell(
        &mut self,
        row: usize,
        record: &ByteRecord,
        column: &TableColumn,
    ) -> Result<f64, CellFault> {
        let cell = record.get(column.index).ok_or(CellFault::Absent)?;
        let cell = self.decimals.with_point(row, cell);
        match column.target {
            ColumnTarget::Time => self.clock.read_cell(row, &cell),
            _ => read_value(&cell, record.get(column.index + 1), column),
        }
    }
}

/// Returns the line in which the record just read starts: its end is the current line, less one
/// line end after it and those within it. `before` is the line at which reading began.
fn record_line(reader: &csv::Reader<impl Read>, record: &ByteRecord, before: u64) -> usize {
    let end = reader.position().line();
    // Most records are one line, with no blank line before it.
    if end == before + 1 {
        return line_number(before);
    }
    let inside = record.as_slice().iter().filter(|&&byte| byte == b'\n').count();
    line_number(end).saturating_sub(1 + inside)
}

fn line_number(line: u64) -> usize {
    usize::try_from(line).unwrap_or(usize::MAX)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn run(text: &str, mapping: &Mapping) -> (Option<Table>, Vec<String>) {
        let mut findings = Findings::default();
        let table = read_csv(text.as_bytes(), mapping, &mut findings);
        (
            table,
            findings
                .into_lists()
                .0
                .iter()
                .map(|error| format!("{:?} {}", error.row, error.message))
                .collect(),
        )
    }

    #[test]
    fn commas_semicolons_and_tabs_are_told_apart() {
        for text in ["t_s,u_kn\n0,1\n", "\u{feff}t_s;u_kn\r\n0; 1\r\n", "t_s\tu_kn\n0\t1"] {
            let table = run(text, &Mapping::with_canonical_names()).0.unwrap();
            assert!((table.values[1][0] - 0.514_444).abs() < 1e-5);
        }
    }

    #[test]
    fn faulty_cells_name_row_and_reason() {
        let (_, errors) =
            run("t_s,u_m_s\n0,1\n1,\n2,nan\n3,abc\n4\n", &Mapping::with_canonical_names());
        assert!(errors[0].starts_with("Some(3) the cell is empty"), "{errors:?}");
        assert!(errors[1].contains("not a finite number") && errors[2].contains("`abc`"));
        assert!(errors[3].contains("row 6 has 1 cell; the header has 2"), "{errors:?}");
        let (_, errors) = run("t_s;u_m_s\n0;1,5\n1;1.5\n", &Mapping::with_canonical_names());
        assert!(errors[0].contains("with a point"));
    }

    #[test]
    fn sizes_are_bounded() {
        let mut mapping = Mapping::with_canonical_names();
        mapping.limits = crate::FileLimits {
            rows: 2,
            columns: 2,
            line_bytes: 100,
            ..crate::FileLimits::default()
        };
        assert!(run("t_s,u_m_s\n0,1\n1,1\n", &mapping).1.is_empty());
        assert!(
            run("t_s,u_m_s\n0,1\n1,1\n2,1\n", &mapping).1[0]
                .contains("more rows than the limit of 2")
        );
        assert!(run("t_s,u_m_s,v_m_s\n", &mapping).1[0].contains("3 columns"));
        let open = format!("t_s,u_m_s\n0,\"{}", "1\n".repeat(100_000));
        assert!(run(&open, &mapping).1[0].contains("unclosed quote"));
        assert!(run("", &mapping).1[0].contains("empty"));
    }
}

#[cfg(test)]
#[path = "csv_file_tests.rs"]
mod more_tests;
