//! Layout of a CSV file: lines above the header, separator, a row of units below the header.

use csv::{ByteRecord, ReaderBuilder};

use crate::cell_value::split_unit;
use crate::decimals::DecimalMarks;
use crate::mapping::Mapping;
use crate::names;
use crate::number::parse_number;
use crate::stamp::{DateOrder, parse_stamp};
use crate::text_decoder::decode_text;
use crate::units::{is_unit, plain_unit};

/// Number of lines in which the header is searched.
const LINES: usize = 100;
/// Number of known names from which the first line is the header without a search.
const CERTAIN: usize = 2;

/// Location of the table in the file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct TableLayout {
    pub separator: u8,
    /// Number of bytes before the line of the header.
    pub offset: usize,
    /// Number of lines before the header, blank ones included; 0 if the header is the first line
    /// with text.
    pub lines: usize,
    /// Units in the row below the header, if there is one.
    pub units: Vec<String>,
    /// Names of the columns where no single line of the file holds them: `#1`, `#2`, ... of a
    /// table without a header, or those of two lines together.
    pub added_names: Vec<String>,
}

/// Line that is not blank.
#[derive(Clone, Copy)]
struct TextLine<'a> {
    offset: usize,
    /// Number of lines before it, blank ones included.
    before: usize,
    bytes: &'a [u8],
    complete: bool,
    /// True if a mark of a comment was removed from its start.
    is_comment: bool,
}

/// Finds the table. The header is the line with most names that are mapped or canonical, or else
/// the first.
pub(crate) fn find_table(start: &[u8], mapping: &Mapping) -> TableLayout {
    if mapping.unidentified.is_some() {
        return guess_layout(start);
    }
    // A mapping of `#3` refers to a column by its position: the file then has no header.
    let by_place = |name: &str| {
        name.trim().strip_prefix('#').is_some_and(|place| place.parse::<usize>().is_ok())
    };
    if mapping.columns.iter().any(|(_, mapped)| by_place(&mapped.column))
        && let Some(layout) = headerless_layout(start)
    {
        return layout;
    }
    if let Some(layout) = two_line_header(start)
        && mapping.columns.iter().any(|(_, mapped)| layout.added_names.contains(&mapped.column))
    {
        return layout;
    }
    let mut found = nonblank_lines(start).enumerate().peekable();
    let Some(&(_, first)) = found.peek() else {
        return TableLayout { separator: b',', ..TableLayout::default() };
    };
    let (mut best, mut most) = ((0, first), count_known(first.bytes, mapping));
    if most < CERTAIN {
        for (at, line) in found.skip(1) {
            let names = count_known(line.bytes, mapping);
            if names > most {
                (best, most) = ((at, line), names);
            }
        }
    }
    let (at, line) = best;
    // A line that is cut off at the end of `start` is no evidence of units.
    let below = nonblank_lines(start).nth(at + 1).filter(|below| below.complete);
    let separator = separator_above(line.bytes, below);
    let units = below.and_then(|below| row_units(&split_cells(below.bytes, separator)));
    let units = units.unwrap_or_default();
    let is_first = at == 0 && !line.is_comment;
    let (offset, lines) = if is_first { (0, 0) } else { (line.offset, line.before) };
    TableLayout { separator, offset, lines, units, added_names: Vec::new() }
}

/// Returns the separator of a header: that of the values below it where these tell, since the names
/// themselves may contain commas.
fn separator_above(header: &[u8], below: Option<TextLine>) -> u8 {
    let own = header_separator(header);
    let Some(below) = below.filter(|below| is_data(below.bytes)) else { return own };
    let other = likely_separator(below.bytes);
    let width = |line: &[u8], separator: u8| split_cells(line, separator).len();
    let fits = width(header, other) == width(below.bytes, other) && header.contains(&other);
    if fits { other } else { own }
}

/// Finds a table without a header, by its first lines that hold numbers only.
fn headerless_layout(start: &[u8]) -> Option<TableLayout> {
    let lines: Vec<TextLine> = nonblank_lines(start).collect();
    let width = |line: &TextLine| split_cells(line.bytes, likely_separator(line.bytes)).len();
    let alike = |at: usize| {
        let next = lines[at..].iter().take(3).filter(|line| line.complete);
        next.clone().all(|line| is_data(line.bytes) && width(line) == width(&lines[at]))
            && next.count() > 0
    };
    let at = (0..lines.len()).find(|&at| alike(at))?;
    let TextLine { offset, before, bytes, .. } = lines[at];
    let separator = likely_separator(bytes);
    let count = split_cells(bytes, separator).len();
    let added_names = (1..=count).map(|place| format!("#{place}")).collect();
    Some(TableLayout { separator, offset, lines: before, units: Vec::new(), added_names })
}

/// Finds a table whose header has groups of columns in one line and their members in the next, as
/// merged cells of a sheet give: each column is named by both.
fn two_line_header(start: &[u8]) -> Option<TableLayout> {
    let lines: Vec<TextLine> = nonblank_lines(start).take(LINES).collect();
    let data = (0..lines.len()).find(|&at| is_data(lines[at].bytes))?;
    let separator = Some(likely_separator(lines[data].bytes)).filter(|byte| *byte != b' ')?;
    let cells = |at: usize| split_cells(lines[at].bytes, separator);
    let units = data.checked_sub(1).and_then(|at| row_units(&cells(at)));
    let lower = data.checked_sub(if units.is_some() { 2 } else { 1 })?;
    let names = join_header_lines(&cells(lower.checked_sub(1)?), &cells(lower))?;
    let is_table = names.len().abs_diff(cells(data).len()) <= 1;
    let TextLine { offset, before, .. } = lines[lower + 1];
    is_table.then(|| TableLayout {
        separator,
        offset,
        lines: before,
        units: units.unwrap_or_default(),
        added_names: names,
    })
}

/// Returns the names of columns by two lines; `None` if the lower one names every column, or the
/// names would not be unique.
fn join_header_lines(upper: &[String], lower: &[String]) -> Option<Vec<String>> {
    let text = |cell: &String| !cell.is_empty() && !is_value(cell, b',');
    let is_header = upper.iter().chain(lower).filter(|cell| !cell.is_empty()).all(text)
        // A title alone is no group of columns.
        && upper.iter().filter(|cell| !cell.is_empty()).count() > 1;
    let has_blanks = lower.iter().any(String::is_empty);
    if !is_header || !has_blanks || upper.len().abs_diff(lower.len()) > 1 {
        return None;
    }
    let mut group = String::new();
    let mut names = Vec::new();
    for (upper, lower) in upper.iter().zip(lower) {
        // A group stands above its first member only.
        if !upper.is_empty() || lower.is_empty() {
            group.clone_from(upper);
        }
        names.push(format!("{group} {lower}").trim().to_owned());
    }
    let unique = names.iter().collect::<std::collections::BTreeSet<_>>().len() == names.len();
    (unique && names.iter().all(|name| !name.is_empty())).then_some(names)
}

/// Returns the text of the table from its header on; a table without a header is given one.
pub(crate) fn table_body(start: &[u8], layout: &TableLayout) -> Vec<u8> {
    let text = &start[layout.offset..];
    if layout.added_names.is_empty() {
        return text.to_vec();
    }
    let quoted = |name: &String| match name.contains([char::from(layout.separator), '"']) {
        true => format!("\"{}\"", name.replace('"', "\"\"")),
        false => name.clone(),
    };
    let names: Vec<String> = layout.added_names.iter().map(quoted).collect();
    let separator = char::from(layout.separator).to_string();
    [names.join(&separator).as_bytes(), b"\n", text].concat()
}

impl TableLayout {
    /// Returns the number of lines before those that are read, less the line of an added header.
    pub(crate) fn line_shift(&self) -> isize {
        let lines = isize::try_from(self.lines).unwrap_or(isize::MAX);
        lines - isize::from(!self.added_names.is_empty())
    }
}

/// Returns the number of known names in the header.
pub(crate) fn count_known_names(start: &[u8], mapping: &Mapping) -> usize {
    let offset = find_table(start, mapping).offset;
    nonblank_lines(&start[offset..]).next().map_or(0, |line| count_known(line.bytes, mapping))
}

/// Finds the most likely table of an unknown file: its header is above the first line of values.
pub(crate) fn guess_layout(start: &[u8]) -> TableLayout {
    if let Some(layout) = two_line_header(start) {
        return layout;
    }
    let canonical = Mapping::with_canonical_names();
    let lines: Vec<TextLine> = nonblank_lines(start).collect();
    let data = (0..lines.len()).find(|&at| is_data(lines[at].bytes));
    let Some(data) = data.filter(|_| count_known_names(start, &canonical) < CERTAIN) else {
        return find_table(start, &canonical);
    };
    let separator = likely_separator(lines[data].bytes);
    let width = |at: usize| split_cells(lines[at].bytes, separator).len();
    // The words of a title are separated by blanks as well: there a header needs a name for each
    // column.
    let most = usize::from(separator != b' ');
    let heads = data > 0 && width(data - 1).abs_diff(width(data)) <= most;
    if !heads && let Some(layout) = headerless_layout(start) {
        return layout;
    }
    if data == 0 {
        return find_table(start, &canonical);
    }
    let below = row_units(&split_cells(lines[data - 1].bytes, separator)).filter(|_| data > 1);
    let header = lines[if below.is_some() { data - 2 } else { data - 1 }];
    let (offset, lines, units) = (header.offset, header.before, below.unwrap_or_default());
    TableLayout { separator, offset, lines, units, added_names: Vec::new() }
}

/// Returns the likely separator of a line; a comma may be a decimal mark if something else
/// separates.
pub(crate) fn likely_separator(line: &[u8]) -> u8 {
    let found = [b'\t', b';', b','].into_iter().find(|byte| line.contains(byte));
    let by_blanks = || {
        let mut cells =
            line.split(|byte| byte.is_ascii_whitespace()).filter(|cell| !cell.is_empty());
        let point =
            |cell: &[u8]| parse_number(&DecimalMarks::new(b' ').with_point(0, cell)).is_ok();
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
    let cells = split_cells(line, separator);
    let written = cells.iter().filter(|cell| !cell.is_empty()).count();
    let values = cells.iter().filter(|cell| is_value(cell, separator)).count();
    values >= 2 && 2 * values > written
}

/// Returns true if a cell is a number, one with a unit, or a time.
pub(crate) fn is_value(cell: &str, separator: u8) -> bool {
    let cell = DecimalMarks::new(separator).with_point(0, cell.as_bytes()).into_owned();
    let is_time = || {
        std::str::from_utf8(&cell).is_ok_and(|cell| parse_stamp(cell, DateOrder::Open).is_some())
    };
    parse_number(&cell).is_ok() || split_unit(&cell).is_some() || is_time()
}

/// Returns true if more of the file could not change the result of [`find_table`].
pub(crate) fn is_settled(start: &[u8], mapping: &Mapping) -> bool {
    let complete = nonblank_lines(start).filter(|line| line.complete).take(LINES);
    let Some(first) = complete.clone().next() else { return false };
    let count = complete.count();
    count >= LINES || (count >= 2 && count_known(first.bytes, mapping) >= CERTAIN)
}

/// Returns the text after the byte order mark, if there is one.
fn strip_mark(start: &[u8]) -> &[u8] {
    start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start)
}

fn nonblank_lines(start: &[u8]) -> impl Iterator<Item = TextLine<'_>> + Clone {
    let text = strip_mark(start);
    let mut offset = start.len() - text.len();
    let lines =
        text.split_inclusive(|&byte| byte == b'\n').enumerate().map(move |(before, line)| {
            offset += line.len();
            let (mark, complete) = (comment_mark(line), line.ends_with(b"\n"));
            let bytes = strip_line_end(&line[mark..]);
            TextLine {
                offset: offset + mark - line.len(),
                before,
                bytes,
                complete,
                is_comment: mark > 0,
            }
        });
    lines.filter(|line| !line.bytes.trim_ascii().is_empty()).take(LINES)
}

/// Returns the number of bytes of the mark of a comment before words: headers of tables for MATLAB
/// and gnuplot are comments. `#1` and `# 12` are no words.
fn comment_mark(line: &[u8]) -> usize {
    let is_mark = |byte: &u8| matches!(byte, b'%' | b'#');
    let after = line.iter().position(|byte| !is_mark(byte)).unwrap_or(0);
    let text = line[after..].trim_ascii_start();
    let is_words =
        text.first().is_some_and(|byte| byte.is_ascii_alphabetic() || b"([".contains(byte));
    if after > 0 && is_words { line.len() - text.len() } else { 0 }
}

fn strip_line_end(line: &[u8]) -> &[u8] {
    let line = line.strip_suffix(b"\n").unwrap_or(line);
    line.strip_suffix(b"\r").unwrap_or(line)
}

/// Returns comma, semicolon or tab: the one that the line contains most often outside quotes.
fn header_separator(line: &[u8]) -> u8 {
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

fn split_cells(line: &[u8], separator: u8) -> Vec<String> {
    if separator == b' ' {
        let cells = line.split(|byte| byte.is_ascii_whitespace());
        return cells.filter(|cell| !cell.is_empty()).map(header_text).collect();
    }
    let mut reader = ReaderBuilder::new().delimiter(separator).has_headers(false).from_reader(line);
    let mut record = ByteRecord::new();
    // The error is ignored: a line that cannot be split contains no name.
    let _ = reader.read_byte_record(&mut record);
    record.iter().map(header_text).collect()
}

/// Returns the text of a header.
pub(crate) fn header_text(cell: &[u8]) -> String {
    decode_text(cell).trim().to_owned()
}

/// Returns the number of cells of a line that name a column to be read.
fn count_known(line: &[u8], mapping: &Mapping) -> usize {
    let is_known = |cell: &String| {
        names::canonical_target(cell).is_some()
            || names::is_time(cell)
            || mapping.columns.iter().any(|(_, mapped)| mapped.column.trim() == cell)
    };
    let count =
        |separator| split_cells(line, separator).iter().filter(|cell| is_known(cell)).count();
    // Names may contain commas, so that the other separators are counted too.
    [header_separator(line), b'\t', b';'].into_iter().map(count).max().unwrap_or(0)
}

/// Returns the units of a line that holds nothing else.
fn row_units(cells: &[String]) -> Option<Vec<String>> {
    let written: Vec<&String> = cells.iter().filter(|cell| !cell.is_empty()).collect();
    let named = written.iter().filter(|cell| is_unit(cell)).count();
    let only = !written.iter().any(|cell| is_value(cell, b',')) && 2 * named > written.len();
    only.then(|| cells.iter().map(|cell| plain_unit(cell).to_owned()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> TableLayout {
        find_table(text.as_bytes(), &Mapping::with_canonical_names())
    }

    #[test]
    fn the_header_may_stand_below_other_lines() {
        let text = "Ship: A\nDate;2024-05-01\n\nt_s;u_kn;note\n0;1;a\n";
        let wanted =
            TableLayout { separator: b';', offset: 25, lines: 3, ..TableLayout::default() };
        assert_eq!(of(text), wanted);
        assert_eq!(of("a,b\n1,2\n").offset, 0);
        assert_eq!(of("").separator, b',');
    }

    #[test]
    fn a_table_without_a_header_is_found_below_its_titles() {
        let text =
            b" HSVA, data\n Z10/10 starting to port\n  .00   2.34  -1.0\n  .05   2.40  -1.1\n";
        let layout = guess_layout(text);
        assert_eq!((layout.separator, layout.added_names.len(), layout.lines), (b' ', 3, 2));
        assert!(table_body(text, &layout).starts_with(b"#1 #2 #3\n  .00"));
        assert_eq!(guess_layout(b"a b c\n0 1 2\n1 2 3\n").added_names, [""; 0]);
        assert_eq!(guess_layout(b"0;1;2\n1;2;3\n").added_names, ["#1", "#2", "#3"]);
    }

    #[test]
    fn groups_above_names_become_part_of_them() {
        let text = b"Time\tPosition\t\tRudder\n\tNorth\tEast\t\n[s]\t[m]\t[m]\t[deg]\n0\t1\t2\t3\n";
        let layout = guess_layout(text);
        assert_eq!(layout.added_names, ["Time", "Position North", "Position East", "Rudder"]);
        assert_eq!((layout.units.join(" "), layout.line_shift()), ("s m m deg".into(), 1));
        assert!(table_body(text, &layout).starts_with(b"Time\tPosition North"));
        // A title above a table whose first column has no name is no group.
        assert_eq!(guess_layout(b"A trial,,\n,Time,Heading\n0,1,2\n").added_names, [""; 0]);
    }

    #[test]
    fn a_header_may_be_a_comment() {
        let layout = guess_layout(b"% Run 4\n%  time   x\n%  (s)  (m)\n 0.0  1.0\n 0.1  1.1\n");
        assert_eq!((layout.offset, layout.lines, layout.units.len()), (11, 1, 2));
        assert_eq!(of("#Time,u_m_s\n0,1\n").offset, 1);
        assert_eq!(comment_mark(b"#1 #2"), 0);
    }

    #[test]
    fn values_tell_the_separator_of_names_with_commas() {
        assert_eq!(of("t_s;rudder (deg, port)\n0;1\n").separator, b';');
        assert_eq!(of("t_s,u_m_s\n0,1\n").separator, b',');
    }

    #[test]
    fn units_below_the_header_are_found() {
        assert_eq!(of("t_s\tu\tx\n[s]\t(knots)\t\n0\t1\t2\n").units, ["s", "kn", ""]);
        assert!(of("t_s,u_m_s\n0,1\n").units.is_empty());
        assert!(of("t_s,u_m_s\nabc,def\n").units.is_empty());
    }

    #[test]
    fn latin_1_is_told_from_utf_8() {
        assert_eq!(header_text(b"\xb0C"), "\u{b0}C");
        assert_eq!(header_text(" \u{b0}".as_bytes()), "\u{b0}");
    }

    #[test]
    fn more_is_asked_for_only_where_it_could_matter() {
        let mapping = Mapping::with_canonical_names();
        assert!(is_settled(b"t_s,u_m_s\n0,1\n", &mapping));
        for text in [&b"t_s,u_m_s\n"[..], b"a\nb\n", b"", b"\n\n"] {
            assert!(!is_settled(text, &mapping));
        }
        assert!(is_settled("a\n".repeat(LINES).as_bytes(), &mapping));
    }
}
