//! Check that every row of a CSV file has as many cells as its header.
//!
//! A row with another count is an error: its numbers may be under the wrong headings. There are two
//! exceptions where they cannot be. One more empty cell at the end of *every* row (a separator that
//! closes each line but not the header) is accepted, unless a decimal comma could explain it: that
//! is where commas separate and no number has a point. And a row with too few cells is excluded,
//! with a warning, if the manifest says `missing: drop`.

use csv::ByteRecord;

use crate::findings::Findings;

/// Largest number of rows named in one message.
const NAMED: usize = 5;

/// Result of the count of the cells of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum CellCount {
    /// The row is read.
    Fit,
    /// The row is not read: it has too few cells.
    Few(usize),
    /// The row is not read: it has cells without a heading.
    Many,
}

/// Rows with one kind of wrong count: the first few, their number, and the last.
#[derive(Debug, Default)]
struct MiscountedRows {
    first: Vec<(usize, usize)>,
    count: usize,
    last: usize,
}

/// Counts the cells of each row.
#[derive(Debug)]
pub(crate) struct CellCounter {
    separator: u8,
    width: usize,
    exact: bool,
    point: bool,
    decimal_commas: usize,
    /// Rows with one more separator than the header.
    closed: MiscountedRows,
    few: MiscountedRows,
    many: MiscountedRows,
}

impl MiscountedRows {
    fn record_row(&mut self, row: usize, cells: usize) {
        if self.first.len() < NAMED {
            self.first.push((row, cells));
        }
        self.count += 1;
        self.last = row;
    }

    /// `row 3 has 7 cells, row 5 has 8, and so on in 12 further rows, the last of them row 90`
    fn describe_rows(&self) -> String {
        let cells =
            |count: usize| if count == 1 { "1 cell".to_owned() } else { format!("{count} cells") };
        let first: Vec<String> = self
            .first
            .iter()
            .map(|&(row, count)| format!("row {row} has {}", cells(count)))
            .collect();
        match self.count - self.first.len() {
            0 => first.join(", "),
            more => format!(
                "{}, and {more} further rows, the last of which is row {}",
                first.join(", "),
                self.last
            ),
        }
    }
}

impl CellCounter {
    /// Creates a counter for a file with the given number of headings.
    pub(crate) fn new(separator: u8, width: usize) -> Self {
        let none = MiscountedRows::default;
        Self {
            separator,
            width,
            exact: false,
            point: false,
            decimal_commas: 0,
            closed: none(),
            few: none(),
            many: none(),
        }
    }

    /// Counts one row.
    pub(crate) fn count_row(&mut self, row: usize, record: &ByteRecord) -> CellCount {
        let count = record.len();
        // A decimal point anywhere shows that commas are no decimal marks.
        self.point = self.point || record.as_slice().contains(&b'.');
        if count == self.width {
            self.exact = true;
            return CellCount::Fit;
        }
        if count < self.width {
            self.few.record_row(row, count);
            return CellCount::Few(count);
        }
        // One empty cell more may be a separator at the end of every line.
        if count == self.width + 1
            && record.get(self.width).is_some_and(|cell| cell.trim_ascii().is_empty())
        {
            self.closed.record_row(row, count);
            return CellCount::Fit;
        }
        self.many.record_row(row, count);
        self.decimal_commas +=
            usize::from(self.separator == b',' && is_decimal_comma(record, self.width));
        CellCount::Many
    }

    /// Reports every row with a wrong count; those with too few cells only if they are not
    /// excluded.
    pub(crate) fn report_counts(&self, drops: bool, findings: &mut Findings) {
        if self.many.count > 0 {
            let what = match self.decimal_commas {
                0 => "quote cells that contain the separator, or give every column a header",
                _ => {
                    "this is probably a decimal comma (`7,01` is read as 7 and 01): write \
                     decimals with a point, such as 7.01"
                }
            };
            self.report_rows(&self.many, what, findings);
        }
        if self.closed.count > 0 && !self.is_closed_throughout() {
            let what = "the last cell is empty: end the header with a separator as well, or \
                        remove it from these rows; if it is caused by a decimal comma, write \
                        decimals with a point";
            self.report_rows(&self.closed, what, findings);
        }
        if self.few.count > 0 && !drops {
            let what = "complete the rows (an empty cell still needs its separator), or set \
                        `missing: drop` in the manifest's conventions to skip them";
            self.report_rows(&self.few, what, findings);
        }
    }

    fn is_closed_throughout(&self) -> bool {
        // Only if every row is closed, and no decimal comma can explain the additional cell.
        let alone = !self.exact && self.few.count == 0 && self.many.count == 0;
        alone && (self.separator != b',' || self.point)
    }

    fn report_rows(&self, rows: &MiscountedRows, what: &str, findings: &mut Findings) {
        let separator = if self.separator == b'\t' {
            "tab".to_owned()
        } else {
            format!("`{}`", self.separator as char)
        };
        let row = rows.first.first().map(|&(row, _)| row);
        let (named, width) = (rows.describe_rows(), self.width);
        findings.error(
            row,
            None,
            format!("{named}; the header has {width} (separated by {separator}); {what}"),
        );
    }
}

/// Returns true if at least as many pairs of neighbouring cells as there are excess cells are the
/// two halves of a decimal number.
fn is_decimal_comma(record: &ByteRecord, width: usize) -> bool {
    // Integer part with an optional sign, then a fraction with an optional exponent.
    let digits = |cell: &[u8]| !cell.is_empty() && cell.iter().all(u8::is_ascii_digit);
    let whole =
        |cell: &[u8]| digits(cell.strip_prefix(b"-").or(cell.strip_prefix(b"+")).unwrap_or(cell));
    let fraction =
        |cell: &[u8]| cell.split(|byte| matches!(byte, b'e' | b'E')).next().is_some_and(digits);
    let cells: Vec<&[u8]> = record.iter().map(<[u8]>::trim_ascii).collect();
    // Pairs do not overlap: a matched pair takes two cells.
    let (mut pairs, mut k) = (0, 0);
    while k + 1 < cells.len() {
        let pair = whole(cells[k]) && fraction(cells[k + 1]);
        pairs += usize::from(pair);
        k += if pair { 2 } else { 1 };
    }
    pairs >= cells.len() - width
}
