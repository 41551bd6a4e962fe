//! CSV, streamed row by row.

use std::io::{Chain, Cursor, Read};

use csv::{ByteRecord, ReaderBuilder};

use crate::blanks::Blanks;
use crate::cells::{Cells, Counter};
use crate::clock::Clock;
use crate::decimals::Decimals;
use crate::findings::Findings;
use crate::layout::{self, Layout};
use crate::limits::too_many;
use crate::mapping::Mapping;
use crate::metered::{Meter, Metered};
use crate::number::{Fault, number};
use crate::resolve::{Heading, resolve_heading};
use crate::stream;
use crate::table::{Column, Table, Target, width};
use crate::taker::{RowsFile, Taker, time_at};

/// Number of bytes that are read at a time in the search for the header.
const CHUNK: u64 = 4096;

/// Reads the mapped columns; returns `None` after errors that prevent any check.
///
/// The number of a row is that of the line in which it starts, as an editor shows it: the first
/// line is 1, and blank lines and those within quoted cells count.
pub(crate) fn read(input: impl Read, mapping: &Mapping, findings: &mut Findings) -> Option<Table> {
    stream::whole(CsvRows::open(input, mapping, findings)?, mapping, findings)
}

/// Rows of a CSV file whose header has been read.
pub(crate) struct CsvRows<R> {
    reader: csv::Reader<Blanks<Chain<Cursor<Vec<u8>>, Metered<R>>>>,
    meter: Meter,
    columns: Vec<Column>,
    room: usize,
    cells: Reading,
    /// Row and reason at which reading stopped.
    stopped: Option<(usize, String)>,
}

impl<R: Read> CsvRows<R> {
    /// Reads the header; returns `None` after errors.
    pub(crate) fn open(input: R, mapping: &Mapping, findings: &mut Findings) -> Option<Self> {
        let (mut metered, meter) = Metered::new(input, mapping.limits.line_bytes);
        let start = start(&mut metered, &meter, mapping, findings)?;
        let layout = layout::find(&start, mapping);
        let whole = Cursor::new(layout::body(&start, &layout)).chain(metered);
        let mut reader = opened(whole, layout.separator);
        let headers = headers(&mut reader, mapping, findings)?;
        // The header is no part of the first row's length.
        meter.reset();
        let columns = resolve_heading(heading(&headers, &layout), mapping, findings)?;
        let cells = Reading {
            shift: layout.shift(),
            most: mapping.limits.rows,
            units: !layout.units.is_empty(),
            time: time_at(&columns).map(|at| columns[at].clone()),
            clock: Clock::of(&columns),
            counter: Counter::new(layout.separator, headers.len()),
            decimals: Decimals::new(layout.separator),
        };
        Some(Self { reader, meter, columns, room: mapping.room, cells, stopped: None })
    }
}

impl<R: Read> RowsFile for CsvRows<R> {
    fn columns(&self) -> &[Column] {
        &self.columns
    }

    fn room(&self) -> usize {
        self.room
    }

    fn each(&mut self, taker: &mut impl Taker) {
        self.stopped = self.cells.rows(&mut self.reader, &self.meter, taker).err();
    }

    fn finish(&mut self, drops: bool, table: &mut Table, findings: &mut Findings) {
        self.cells.counter.tell(drops, findings);
        self.cells.decimals.tell(findings);
        self.cells.clock.finish(table, findings);
        if let Some((row, message)) = &self.stopped {
            findings.error(Some(*row), None, message.clone());
        }
    }
}

/// Returns an upper bound of the number of rows, and the number of columns that are read; `None` if
/// the header is invalid.
pub(crate) fn measure(mut input: impl Read, mapping: &Mapping) -> Option<(usize, usize)> {
    let (mut rows, mut before, mut start) = (1, 0, Vec::new());
    input.by_ref().take(mapping.limits.line_bytes as u64).read_to_end(&mut start).ok()?;
    let columns = columns(&start[..], mapping)?;
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
fn columns(start: &[u8], mapping: &Mapping) -> Option<usize> {
    let mut findings = Findings::default();
    let layout = layout::find(start, mapping);
    let mut reader = opened(Cursor::new(layout::body(start, &layout)), layout.separator);
    let headers = headers(&mut reader, mapping, &mut findings)?;
    let columns = resolve_heading(heading(&headers, &layout), mapping, &mut findings)?;
    Some(width(&columns))
}

fn opened<R: Read>(input: R, separator: u8) -> csv::Reader<Blanks<R>> {
    let by_blanks = separator == b' ';
    let delimiter = if by_blanks { b'\t' } else { separator };
    let input = Blanks::new(input, by_blanks);
    ReaderBuilder::new().delimiter(delimiter).flexible(true).from_reader(input)
}

fn heading<'a>(names: &'a [String], layout: &'a Layout) -> Heading<'a> {
    Heading { names, units: &layout.units, row: layout.lines + 1 }
}

/// Reads the file at least up to the line below the header, however small the pieces that the
/// reader returns.
fn start(
    input: &mut impl Read,
    meter: &Meter,
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
        if start.starts_with(&[0xff, 0xfe]) || start.starts_with(&[0xfe, 0xff]) {
            findings.error(Some(1), None, "the file is UTF-16 text; save it as UTF-8");
            return None;
        }
        if read == 0
            || start.len() > mapping.limits.line_bytes
            || layout::is_settled(&start, mapping)
        {
            return Some(start);
        }
        // Lines before the header are complete rows for the limit of their length.
        if start[start.len() - read..].contains(&b'\n') {
            meter.reset();
        }
    }
}

fn headers(
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
    let headers: Vec<String> = record.iter().map(layout::name).collect();
    let problem = match headers.len() {
        0 => "the file is empty; it needs a header with column names".to_owned(),
        n if n > mapping.limits.columns => {
            format!("{n} columns are more than the {} that are read", mapping.limits.columns)
        }
        _ => return Some(headers),
    };
    findings.error(Some(1), None, problem);
    None
}

/// State of reading that changes from row to row.
struct Reading {
    /// Number of lines before those that are read; negative if a header was added.
    shift: isize,
    /// Largest number of rows that are read.
    most: usize,
    /// True if the first row holds units.
    units: bool,
    /// The column of time.
    time: Option<Column>,
    clock: Clock,
    counter: Counter,
    decimals: Decimals,
}

impl Reading {
    /// Passes every row to the sink; returns the row and the reason if reading cannot continue.
    fn rows(
        &mut self,
        reader: &mut csv::Reader<impl Read>,
        meter: &Meter,
        taker: &mut impl Taker,
    ) -> Result<(), (usize, String)> {
        let mut record = ByteRecord::new();
        loop {
            // The position before the record, for messages: after an error it no longer names the
            // row.
            let next = usize::try_from(reader.position().line()).unwrap_or(usize::MAX);
            let next = next.saturating_add_signed(self.shift);
            let more = reader
                .read_byte_record(&mut record)
                .map_err(|error| (next, format!("cannot be read on: {error}")))?;
            if !more {
                return Ok(());
            }
            let row = line(reader, &record).saturating_add_signed(self.shift);
            meter.reset();
            if std::mem::take(&mut self.units) {
                continue;
            }
            if !self.row(row, &record, taker) {
                return Err((row, too_many(self.most)));
            }
        }
    }

    /// Passes a row to the sink; returns false if it exceeds the number of rows.
    fn row<T: Taker>(&mut self, row: usize, record: &ByteRecord, taker: &mut T) -> bool {
        match self.counter.row(row, record) {
            Cells::Fit if T::TIMED => return self.timed(row, record, taker),
            Cells::Fit if taker.held() >= self.most => return false,
            Cells::Fit => taker.row(row, |_, column| self.cell(row, record, column)),
            Cells::Few(_) => taker.short(row),
            Cells::Many => {}
        }
        true
    }

    /// Converts the time of a row, and passes the row on if the sink accepts it.
    fn timed(&mut self, row: usize, record: &ByteRecord, taker: &mut impl Taker) -> bool {
        // Taken out and put back, since `read_cell` borrows `self` mutably.
        let Some(column) = self.time.take() else { return true };
        let time = self.cell(row, record, &column);
        let si = time.as_ref().ok().map(|time| time * column.to_si);
        self.time = Some(column);
        let t_s = si.and_then(|si| self.clock.since_start(si));
        if !taker.wants(row, t_s, &self.clock) {
            return true;
        }
        if taker.held() >= self.most {
            return false;
        }
        taker.row(row, |_, column| match column.target {
            Target::Time => time.clone(),
            _ => self.cell(row, record, column),
        });
        true
    }

    #[inline]
    fn cell(&mut self, row: usize, record: &ByteRecord, column: &Column) -> Result<f64, Fault> {
        let cell = record.get(column.index).ok_or(Fault::Absent)?;
        let cell = self.decimals.point(row, cell);
        match column.target {
            Target::Time => self.clock.cell(row, &cell),
            _ => number(&cell),
        }
    }
}

/// Returns the line in which the record just read starts: its end is the current line, less one
/// line end after it and those within it.
fn line(reader: &csv::Reader<impl Read>, record: &ByteRecord) -> usize {
    let inside = record.as_slice().iter().filter(|&&byte| byte == b'\n').count();
    usize::try_from(reader.position().line()).unwrap_or(usize::MAX).saturating_sub(1 + inside)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn run(text: &str, mapping: &Mapping) -> (Option<Table>, Vec<String>) {
        let mut findings = Findings::default();
        let table = read(text.as_bytes(), mapping, &mut findings);
        (
            table,
            findings
                .finish()
                .0
                .iter()
                .map(|error| format!("{:?} {}", error.row, error.message))
                .collect(),
        )
    }

    #[test]
    fn commas_semicolons_and_tabs_are_told_apart() {
        for text in ["t_s,u_kn\n0,1\n", "\u{feff}t_s;u_kn\r\n0; 1\r\n", "t_s\tu_kn\n0\t1"] {
            let table = run(text, &Mapping::canonical()).0.unwrap();
            assert!((table.values[1][0] - 0.514_444).abs() < 1e-5);
        }
    }

    #[test]
    fn faulty_cells_name_row_and_reason() {
        let (_, errors) = run("t_s,u_m_s\n0,1\n1,\n2,nan\n3,abc\n4\n", &Mapping::canonical());
        assert!(errors[0].starts_with("Some(3) the cell is empty"), "{errors:?}");
        assert!(errors[1].contains("not a finite number") && errors[2].contains("`abc`"));
        assert!(errors[3].contains("row 6 has 1 cell; the header has 2"), "{errors:?}");
        let (_, errors) = run("t_s;u_m_s\n0;1,5\n1;1.5\n", &Mapping::canonical());
        assert!(errors[0].contains("with a point"));
    }

    #[test]
    fn sizes_are_bounded() {
        let mut mapping = Mapping::canonical();
        mapping.limits =
            crate::Limits { rows: 2, columns: 2, line_bytes: 100, ..crate::Limits::default() };
        assert!(run("t_s,u_m_s\n0,1\n1,1\n", &mapping).1.is_empty());
        assert!(run("t_s,u_m_s\n0,1\n1,1\n2,1\n", &mapping).1[0].contains("more than the 2 rows"));
        assert!(run("t_s,u_m_s,v_m_s\n", &mapping).1[0].contains("3 columns"));
        let open = format!("t_s,u_m_s\n0,\"{}", "1\n".repeat(100_000));
        assert!(run(&open, &mapping).1[0].contains("quote left open"));
        assert!(run("", &mapping).1[0].contains("empty"));
    }
}

#[cfg(test)]
#[path = "csv_file_tests.rs"]
mod more_tests;
