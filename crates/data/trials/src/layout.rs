//! Layout of a CSV file: lines above the header, separator, a row of units below the header.

use csv::{ByteRecord, ReaderBuilder};

use crate::decimals::Decimals;
use crate::mapping::Mapping;
use crate::names;
use crate::number::number;
use crate::stamp::{Order, stamp};
use crate::units::{is_unit, plain_unit};

/// Number of lines in which the header is searched.
const LINES: usize = 100;
/// Number of known names from which the first line is the header without a search.
const CERTAIN: usize = 2;

/// Location of the table in the file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Layout {
    pub separator: u8,
    /// Number of bytes before the line of the header.
    pub offset: usize,
    /// Number of lines before the header, blank ones included; 0 if the header is the first line
    /// with text.
    pub lines: usize,
    /// Units in the row below the header, if there is one.
    pub units: Vec<String>,
    /// Number of columns of a table without a header; they are named `#1`, `#2`, ...
    pub headerless: Option<usize>,
}

/// Line that is not blank.
#[derive(Clone, Copy)]
struct Line<'a> {
    offset: usize,
    /// Number of lines before it, blank ones included.
    before: usize,
    bytes: &'a [u8],
    complete: bool,
}

/// Finds the table. The header is the line with most names that are mapped or canonical, or else
/// the first.
pub(crate) fn find(start: &[u8], mapping: &Mapping) -> Layout {
    if mapping.unidentified.is_some() {
        return guess(start);
    }
    // A mapping of `#3` refers to a column by its position: the file then has no header.
    let by_place = |name: &str| {
        name.trim().strip_prefix('#').is_some_and(|place| place.parse::<usize>().is_ok())
    };
    if mapping.columns.iter().any(|(_, mapped)| by_place(&mapped.column))
        && let Some(layout) = headerless(start)
    {
        return layout;
    }
    let mut found = lines(start).enumerate().peekable();
    let Some(&(_, first)) = found.peek() else {
        return Layout { separator: b',', ..Layout::default() };
    };
    let (mut best, mut most) = ((0, first), known(first.bytes, mapping));
    if most < CERTAIN {
        for (at, line) in found.skip(1) {
            let names = known(line.bytes, mapping);
            if names > most {
                (best, most) = ((at, line), names);
            }
        }
    }
    let (at, line) = best;
    let separator = separator(line.bytes);
    // A line that is cut off at the end of `start` is no evidence of units.
    let below = lines(start).nth(at + 1).filter(|below| below.complete);
    let units = below.and_then(|below| units(&cells(below.bytes, separator)));
    let (offset, lines) = if at == 0 { (0, 0) } else { (line.offset, line.before) };
    Layout { separator, offset, lines, units: units.unwrap_or_default(), headerless: None }
}

/// Finds a table without a header, by its first lines that hold numbers only.
fn headerless(start: &[u8]) -> Option<Layout> {
    let lines: Vec<Line> = lines(start).collect();
    let width = |line: &Line| cells(line.bytes, likely_separator(line.bytes)).len();
    let alike = |at: usize| {
        let next = lines[at..].iter().take(3).filter(|line| line.complete);
        next.clone().all(|line| is_data(line.bytes) && width(line) == width(&lines[at]))
            && next.count() > 0
    };
    let at = (0..lines.len()).find(|&at| alike(at))?;
    let Line { offset, before, bytes, .. } = lines[at];
    let separator = likely_separator(bytes);
    let headerless = Some(cells(bytes, separator).len());
    Some(Layout { separator, offset, lines: before, units: Vec::new(), headerless })
}

/// Returns the text of the table from its header on; a table without a header is given one.
pub(crate) fn body(start: &[u8], layout: &Layout) -> Vec<u8> {
    let text = &start[layout.offset..];
    let Some(count) = layout.headerless else { return text.to_vec() };
    let names: Vec<String> = (1..=count).map(|place| format!("#{place}")).collect();
    let separator = char::from(layout.separator).to_string();
    [names.join(&separator).as_bytes(), b"\n", text].concat()
}

impl Layout {
    /// Returns the number of lines before those that are read, less the line of an added header.
    pub(crate) fn shift(&self) -> isize {
        let lines = isize::try_from(self.lines).unwrap_or(isize::MAX);
        lines - isize::from(self.headerless.is_some())
    }
}

/// Returns the number of known names in the header.
pub(crate) fn known_names(start: &[u8], mapping: &Mapping) -> usize {
    let offset = find(start, mapping).offset;
    lines(&start[offset..]).next().map_or(0, |line| known(line.bytes, mapping))
}

/// Finds the most likely table of an unknown file: its header is above the first line of values.
pub(crate) fn guess(start: &[u8]) -> Layout {
    let canonical = Mapping::canonical();
    let lines: Vec<Line> = lines(start).collect();
    let data = (0..lines.len()).find(|&at| is_data(lines[at].bytes));
    let Some(data) = data.filter(|_| known_names(start, &canonical) < CERTAIN) else {
        return find(start, &canonical);
    };
    let separator = likely_separator(lines[data].bytes);
    let width = |at: usize| cells(lines[at].bytes, separator).len();
    // The words of a title are separated by blanks as well: there a header needs a name for each
    // column.
    let most = usize::from(separator != b' ');
    let heads = data > 0 && width(data - 1).abs_diff(width(data)) <= most;
    if !heads && let Some(layout) = headerless(start) {
        return layout;
    }
    if data == 0 {
        return find(start, &canonical);
    }
    let below = units(&cells(lines[data - 1].bytes, separator)).filter(|_| data > 1);
    let header = lines[if below.is_some() { data - 2 } else { data - 1 }];
    let units = below.unwrap_or_default();
    Layout { separator, offset: header.offset, lines: header.before, units, headerless: None }
}

/// Returns the likely separator of a line; a comma may be a decimal mark if something else
/// separates.
fn likely_separator(line: &[u8]) -> u8 {
    let found = [b'\t', b';', b','].into_iter().find(|byte| line.contains(byte));
    let by_blanks = || {
        let mut cells =
            line.split(|byte| byte.is_ascii_whitespace()).filter(|cell| !cell.is_empty());
        let point = |cell: &[u8]| number(&Decimals::new(b' ').point(0, cell)).is_ok();
        cells.clone().count() > 1 && cells.all(point)
    };
    match found {
        // Numbers with decimal commas, separated by blanks.
        Some(b',') if by_blanks() => b' ',
        None if line.trim_ascii().contains(&b' ') => b' ',
        found => found.unwrap_or(b','),
    }
}

/// Returns true if most cells of a line are numbers or times.
fn is_data(line: &[u8]) -> bool {
    let separator = likely_separator(line);
    let cells = cells(line, separator);
    let written = cells.iter().filter(|cell| !cell.is_empty()).count();
    let values = cells.iter().filter(|cell| is_value(cell, separator)).count();
    values >= 2 && 2 * values > written
}

fn is_value(cell: &str, separator: u8) -> bool {
    let cell = Decimals::new(separator).point(0, cell.as_bytes()).into_owned();
    let is_time =
        || std::str::from_utf8(&cell).is_ok_and(|cell| stamp(cell, Order::Open).is_some());
    number(&cell).is_ok() || is_time()
}

/// Returns true if more of the file could not change the result of [`find_table`].
pub(crate) fn is_settled(start: &[u8], mapping: &Mapping) -> bool {
    let complete = lines(start).filter(|line| line.complete).take(LINES);
    let Some(first) = complete.clone().next() else { return false };
    let count = complete.count();
    count >= LINES || (count >= 2 && known(first.bytes, mapping) >= CERTAIN)
}

/// Returns the text after the byte order mark, if there is one.
fn text(start: &[u8]) -> &[u8] {
    start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start)
}

fn lines(start: &[u8]) -> impl Iterator<Item = Line<'_>> + Clone {
    let text = text(start);
    let mut offset = start.len() - text.len();
    let lines =
        text.split_inclusive(|&byte| byte == b'\n').enumerate().map(move |(before, line)| {
            offset += line.len();
            let complete = line.ends_with(b"\n");
            Line { offset: offset - line.len(), before, bytes: unended(line), complete }
        });
    lines.filter(|line| !line.bytes.trim_ascii().is_empty()).take(LINES)
}

fn unended(line: &[u8]) -> &[u8] {
    let line = line.strip_suffix(b"\n").unwrap_or(line);
    line.strip_suffix(b"\r").unwrap_or(line)
}

/// Returns comma, semicolon or tab: the one that the line contains most often outside quotes.
fn separator(line: &[u8]) -> u8 {
    let bare = |separator: u8| {
        let mut quoted = false;
        let counts = |&byte: &u8| {
            quoted ^= byte == b'"';
            byte == separator && !quoted
        };
        line.iter().copied().filter(counts).count()
    };
    // `max_by_key` returns the last of equals, which makes the comma the default.
    let most = [b'\t', b';', b','].into_iter().max_by_key(|&separator| bare(separator));
    let separator = most.unwrap_or(b',');
    if bare(separator) == 0 && line.trim_ascii().contains(&b' ') { b' ' } else { separator }
}

fn cells(line: &[u8], separator: u8) -> Vec<String> {
    if separator == b' ' {
        let cells = line.split(|byte| byte.is_ascii_whitespace());
        return cells.filter(|cell| !cell.is_empty()).map(name).collect();
    }
    let mut reader = ReaderBuilder::new().delimiter(separator).has_headers(false).from_reader(line);
    let mut record = ByteRecord::new();
    // The error is ignored: a line that cannot be split contains no name.
    let _ = reader.read_byte_record(&mut record);
    record.iter().map(name).collect()
}

/// Returns the text of a header; bytes that are not UTF-8 are read as Latin-1, where every byte is
/// a character.
pub(crate) fn name(cell: &[u8]) -> String {
    std::str::from_utf8(cell).map_or_else(|_| latin_1(cell), str::to_owned).trim().to_owned()
}

pub(crate) fn latin_1(bytes: &[u8]) -> String {
    bytes.iter().map(|&byte| char::from(byte)).collect()
}

/// Returns the number of cells of a line that name a column to be read.
fn known(line: &[u8], mapping: &Mapping) -> usize {
    let is_known = |cell: &String| {
        names::canonical(cell).is_some()
            || names::is_time(cell)
            || mapping.columns.iter().any(|(_, mapped)| mapped.column.trim() == cell)
    };
    cells(line, separator(line)).iter().filter(|cell| is_known(cell)).count()
}

/// Returns the units of a line that holds nothing else.
fn units(cells: &[String]) -> Option<Vec<String>> {
    let written: Vec<&String> = cells.iter().filter(|cell| !cell.is_empty()).collect();
    let named = written.iter().filter(|cell| is_unit(cell)).count();
    let only = !written.iter().any(|cell| is_value(cell, b',')) && 2 * named > written.len();
    only.then(|| cells.iter().map(|cell| plain_unit(cell).to_owned()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Layout {
        find(text.as_bytes(), &Mapping::canonical())
    }

    #[test]
    fn the_header_may_stand_below_other_lines() {
        let text = "Ship: A\nDate;2024-05-01\n\nt_s;u_kn;note\n0;1;a\n";
        let wanted = Layout { separator: b';', offset: 25, lines: 3, ..Layout::default() };
        assert_eq!(of(text), wanted);
        assert_eq!(of("a,b\n1,2\n").offset, 0);
        assert_eq!(of("").separator, b',');
    }

    #[test]
    fn a_table_without_a_header_is_found_below_its_titles() {
        let text =
            b" HSVA, data\n Z10/10 starting to port\n  .00   2.34  -1.0\n  .05   2.40  -1.1\n";
        let layout = guess(text);
        assert_eq!((layout.separator, layout.headerless, layout.lines), (b' ', Some(3), 2));
        assert!(body(text, &layout).starts_with(b"#1 #2 #3\n  .00"));
        assert_eq!(guess(b"a b c\n0 1 2\n1 2 3\n").headerless, None);
        assert_eq!(guess(b"0;1;2\n1;2;3\n").headerless, Some(3));
    }

    #[test]
    fn units_below_the_header_are_found() {
        assert_eq!(of("t_s\tu\tx\n[s]\t(knots)\t\n0\t1\t2\n").units, ["s", "kn", ""]);
        assert!(of("t_s,u_m_s\n0,1\n").units.is_empty());
        assert!(of("t_s,u_m_s\nabc,def\n").units.is_empty());
    }

    #[test]
    fn latin_1_is_told_from_utf_8() {
        assert_eq!(name(b"\xb0C"), "\u{b0}C");
        assert_eq!(name(" \u{b0}".as_bytes()), "\u{b0}");
    }

    #[test]
    fn more_is_asked_for_only_where_it_could_matter() {
        let mapping = Mapping::canonical();
        assert!(is_settled(b"t_s,u_m_s\n0,1\n", &mapping));
        for text in [&b"t_s,u_m_s\n"[..], b"a\nb\n", b"", b"\n\n"] {
            assert!(!is_settled(text, &mapping));
        }
        assert!(is_settled("a\n".repeat(LINES).as_bytes(), &mapping));
    }
}
