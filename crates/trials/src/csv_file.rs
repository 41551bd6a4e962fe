//! CSV, streamed row by row.

use std::io::{BufRead, BufReader, Read};

use csv::{ByteRecord, ReaderBuilder};

use crate::findings::Findings;
use crate::mapping::Mapping;
use crate::metered::{Meter, Metered};
use crate::resolve::resolve;
use crate::rows::Builder;
use crate::table::{Fault, Table};

/// Reads the mapped columns; nothing after errors that leave nothing to check.
///
/// Rows are counted by records from 1, the header being row 1; blank lines do not count.
pub(crate) fn read(input: impl Read, mapping: &Mapping, findings: &mut Findings) -> Option<Table> {
    let (metered, meter) = Metered::new(input, mapping.limits.line_bytes);
    let mut buffered = BufReader::new(metered);
    let delimiter = delimiter(&mut buffered, findings)?;
    let mut reader = ReaderBuilder::new().delimiter(delimiter).flexible(true).from_reader(buffered);
    let headers = headers(&mut reader, mapping, findings)?;
    meter.reset();
    let columns = resolve(&headers, mapping, findings)?;
    let mut builder = Builder::new(columns, mapping.conventions.missing, findings).with_room(mapping.room);
    let stopped = rows(&mut reader, &meter, mapping.limits.rows, &mut builder);
    let table = builder.finish();
    if let Err((row, message)) = stopped {
        findings.error(Some(row), None, message);
    }
    Some(table)
}

/// The most rows that there can be, and the columns that are read; none where the header is no good.
pub(crate) fn measure(mut input: impl Read, mapping: &Mapping) -> Option<(usize, usize)> {
    let (mut rows, mut before, mut start) = (1, 0, Vec::new());
    input.by_ref().take(mapping.limits.line_bytes as u64).read_to_end(&mut start).ok()?;
    let columns = columns(&start[..], mapping)?;
    let mut buffer = vec![0; 64 << 10];
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

/// How many columns of the file that starts like this are read.
fn columns(start: &[u8], mapping: &Mapping) -> Option<usize> {
    let mut findings = Findings::default();
    let mut buffered = BufReader::new(start);
    let delimiter = delimiter(&mut buffered, &mut findings)?;
    let mut reader = ReaderBuilder::new().delimiter(delimiter).flexible(true).from_reader(buffered);
    let headers = headers(&mut reader, mapping, &mut findings)?;
    Some(resolve(&headers, mapping, &mut findings)?.len())
}

/// Comma, semicolon or tab: whichever the header line holds most of.
fn delimiter(input: &mut impl BufRead, findings: &mut Findings) -> Option<u8> {
    let start = match input.fill_buf() {
        Ok(start) => start,
        Err(error) => {
            findings.error(None, None, format!("cannot be read: {error}"));
            return None;
        }
    };
    let header = start.split(|&byte| byte == b'\n').find(|line| !line.trim_ascii().is_empty()).unwrap_or_default();
    let count = |delimiter: &u8| header.iter().filter(|&byte| byte == delimiter).count();
    // The last of equals wins, and a comma is the rule.
    [b'\t', b';', b','].into_iter().max_by_key(count)
}

fn headers(reader: &mut csv::Reader<impl Read>, mapping: &Mapping, findings: &mut Findings) -> Option<Vec<String>> {
    let record = match reader.byte_headers() {
        Ok(record) => record,
        Err(error) => {
            findings.error(Some(1), None, format!("the header cannot be read: {error}"));
            return None;
        }
    };
    let headers: Vec<String> = record.iter().map(|name| String::from_utf8_lossy(name).trim().to_owned()).collect();
    let problem = match headers.len() {
        0 => "the file is empty; it needs a header with column names".to_owned(),
        n if n > mapping.limits.columns => format!("{n} columns are more than the {} that are read", mapping.limits.columns),
        _ => return Some(headers),
    };
    findings.error(Some(1), None, problem);
    None
}

/// Feeds every row to the builder; stops with row and reason at what cannot be read on.
fn rows(reader: &mut csv::Reader<impl Read>, meter: &Meter, most: usize, builder: &mut Builder) -> Result<(), (usize, String)> {
    let mut record = ByteRecord::new();
    let mut row = 1;
    loop {
        row += 1;
        let more = reader.read_byte_record(&mut record).map_err(|error| (row, format!("cannot be read on: {error}")))?;
        if !more {
            return Ok(());
        }
        if row - 1 > most {
            return Err((row, format!("the file has more than the {most} rows that are read; split it")));
        }
        meter.reset();
        builder.row(row, |_, column| record.get(column.index).map_or(Err(Fault::Absent), number));
    }
}

/// The number in a cell.
fn number(cell: &[u8]) -> Result<f64, Fault> {
    let text = cell.trim_ascii();
    if text.is_empty() {
        return Err(Fault::Empty);
    }
    let parsed = std::str::from_utf8(text).ok().and_then(|text| text.parse::<f64>().ok());
    match parsed {
        Some(value) if value.is_finite() => Ok(value),
        Some(_) => Err(Fault::NotANumber),
        None => Err(Fault::Text(String::from_utf8_lossy(&text[..text.len().min(40)]).into_owned())),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn run(text: &str, mapping: &Mapping) -> (Option<Table>, Vec<String>) {
        let mut findings = Findings::default();
        let table = read(text.as_bytes(), mapping, &mut findings);
        (table, findings.finish().0.iter().map(|error| format!("{:?} {}", error.row, error.message)).collect())
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
        assert!(errors[3].contains("ends before"));
        let (_, errors) = run("t_s;u_m_s\n0;1,5\n", &Mapping::canonical());
        assert!(errors[0].contains("with a point"));
    }

    #[test]
    fn sizes_are_bounded() {
        let mut mapping = Mapping::canonical();
        mapping.limits = crate::Limits { rows: 2, columns: 2, line_bytes: 100, ..crate::Limits::default() };
        assert!(run("t_s,u_m_s\n0,1\n1,1\n", &mapping).1.is_empty());
        assert!(run("t_s,u_m_s\n0,1\n1,1\n2,1\n", &mapping).1[0].contains("more than the 2 rows"));
        assert!(run("t_s,u_m_s,v_m_s\n", &mapping).1[0].contains("3 columns"));
        let open = format!("t_s,u_m_s\n0,\"{}", "1\n".repeat(100_000));
        assert!(run(&open, &mapping).1[0].contains("quote left open"));
        assert!(run("", &mapping).1[0].contains("empty"));
    }
}
