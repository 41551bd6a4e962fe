#![allow(clippy::unwrap_used)]
use std::io::{Cursor, Write};

use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use super::*;
use crate::testing::finding_messages;

const RELS: &str = r#"<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="rId1" Type="http://schemas.openxmlformats.org/officeDocument/2006/relationships/officeDocument" Target="xl/workbook.xml"/></Relationships>"#;
const SHEET_RELS: &str = r#"<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="rId1" Type="http://schemas.openxmlformats.org/officeDocument/2006/relationships/worksheet" Target="worksheets/sheet1.xml"/><Relationship Id="rId2" Type="http://schemas.openxmlformats.org/officeDocument/2006/relationships/worksheet" Target="worksheets/sheet2.xml"/></Relationships>"#;
const BOOK: &str = r#"<workbook xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main" xmlns:r="http://schemas.openxmlformats.org/officeDocument/2006/relationships"><sheets><sheet name="About" sheetId="1" r:id="rId1"/><sheet name="Data" sheetId="2" r:id="rId2"/></sheets></workbook>"#;
const STYLES: &str = r#"<styleSheet xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"><cellXfs><xf numFmtId="0"/><xf numFmtId="22"/></cellXfs></styleSheet>"#;
const STRINGS: &str = r#"<sst xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main" uniqueCount="2"><si><t>Date/Time</t></si><si><t>u_kn</t></si></sst>"#;

fn sheet(rows: &str) -> String {
    format!(
        r#"<worksheet xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"><sheetData>{rows}</sheetData></worksheet>"#
    )
}

const ROWS: &str = r#"<row r="3"><c r="A3" t="s"><v>0</v></c><c r="B3" t="s"><v>1</v></c><c r="C3" t="inlineStr"><is><t>a "note"</t></is></c></row>
<row r="4"><c r="A4" s="1"><v>45413.5</v></c><c r="B4"><v>10</v></c></row>
<row r="5"><c r="A5" s="1"><v>45413.500011574074</v></c><c r="B5"><v>10.5</v></c><c r="C5" t="inlineStr"><is><t>x</t></is></c></row>"#;

fn book(strings: &str, rows: &str) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let about = sheet(r#"<row r="1"><c r="A1" t="inlineStr"><is><t>Ship A</t></is></c></row>"#);
    for (name, text) in [
        ("_rels/.rels", RELS),
        ("xl/workbook.xml", BOOK),
        ("xl/_rels/workbook.xml.rels", SHEET_RELS),
        ("xl/styles.xml", STYLES),
        ("xl/sharedStrings.xml", strings),
        ("xl/worksheets/sheet1.xml", &about),
        ("xl/worksheets/sheet2.xml", &sheet(rows)),
    ] {
        zip.start_file(name, SimpleFileOptions::default()).unwrap();
        zip.write_all(text.as_bytes()).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

fn run(bytes: Vec<u8>, mapping: &Mapping) -> (Option<Table>, String) {
    let mut findings = Findings::default();
    let table = read_workbook(Box::new(Cursor::new(bytes)), mapping, &mut findings);
    (table, finding_messages(findings))
}

#[test]
fn the_sheet_with_the_table_is_read_with_excels_rows() {
    let (table, text) = run(book(STRINGS, ROWS), &Mapping::with_canonical_names());
    let table = table.unwrap();
    assert_eq!(table.values[0].len(), 2, "{text}");
    assert_eq!(table.rows, [4, 5]);
    let time = table.columns.iter().position(|column| column.header == "Date/Time").unwrap();
    assert_eq!(table.values[time], [0.0, 1.0]);
    assert_eq!(table.start.as_ref().unwrap().text, "2024-05-01T12:00:00");
    assert!(text.contains("the sheet `Data` is read") && text.contains("a 'note'"), "{text}");
}

#[test]
fn a_declared_sheet_is_read_and_a_missing_one_told() {
    let mut mapping = Mapping::with_canonical_names();
    mapping.part = Some("About".into());
    assert!(run(book(STRINGS, ROWS), &mapping).1.contains("no column for time"));
    mapping.part = Some("Dat".into());
    assert!(run(book(STRINGS, ROWS), &mapping).1.contains("there are About, Data"));
}

#[test]
fn what_would_fill_the_memory_is_refused_before_it_is_opened() {
    let canonical = Mapping::with_canonical_names();
    let huge = STRINGS.replace("\"2\"", "\"99999999999\"");
    assert!(run(book(&huge, ROWS), &canonical).1.contains("announces 99999999999 strings"));
    // The blanks reach from one piece that is unpacked into the next.
    let blanks = " ".repeat(100_000);
    let spread = STRINGS.replace("uniqueCount=\"2\"", &format!("uniqueCount{blanks}=\"5000000\""));
    assert!(run(book(&spread, ROWS), &canonical).1.contains("announces 5000000 strings"));
    let mut mapping = Mapping::with_canonical_names();
    mapping.limits.unpacked_bytes = 100_000;
    let bomb = " ".repeat(200_000);
    assert!(run(book(STRINGS, &bomb), &mapping).1.contains("bytes unpacked"));
    let far = r#"<row r="1"><c r="XFD1"><v>1</v></c></row>"#;
    assert!(run(book(STRINGS, far), &canonical).1.contains("error"));
    let back = format!(r#"{ROWS}<row r="2"><c r="A2"><v>1</v></c></row>"#);
    assert!(run(book(STRINGS, &back), &canonical).1.contains("out of order"));
}

#[test]
fn a_cell_that_is_written_twice_is_refused() {
    for column in ["A", "B"] {
        let cell = |value: u32| format!(r#"<c r="{column}6"><v>{value}</v></c>"#);
        let rows = format!(r#"{ROWS}<row r="6">{}{}</row>"#, cell(1), cell(2));
        let (_, text) = run(book(STRINGS, &rows), &Mapping::with_canonical_names());
        assert!(text.contains("cells of row 6 are out of order or repeated"), "{column}: {text}");
    }
}

#[test]
fn damaged_workbooks_are_errors() {
    let bytes = book(STRINGS, ROWS);
    for at in (0..bytes.len()).step_by(7) {
        let mut damaged = bytes.clone();
        damaged[at] ^= 0x55;
        let (table, text) = run(damaged, &Mapping::with_canonical_names());
        assert!(table.is_some() || text.contains("error"), "{at}");
        let _ = run(bytes[..at].to_vec(), &Mapping::with_canonical_names());
    }
}
