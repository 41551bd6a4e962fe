#![allow(clippy::unwrap_used)]
use std::io::{self, Read};

use sistership_model::manifest::MissingValues;

use super::*;
use crate::testing::finding_messages;
use crate::text_decoder::TextDecoder;

fn run(text: &str, mapping: &Mapping) -> (Option<Table>, String) {
    let mut findings = Findings::default();
    let table = read_csv(text.as_bytes(), mapping, &mut findings);
    (table, finding_messages(findings))
}

fn said(text: &str) -> String {
    run(text, &Mapping::with_canonical_names()).1
}

fn accepted(text: &str) -> Table {
    let (table, text) = run(text, &Mapping::with_canonical_names());
    assert!(!text.contains("error"), "{text}");
    table.unwrap()
}

fn drops() -> Mapping {
    let mut mapping = Mapping::with_canonical_names();
    mapping.conventions.missing = MissingValues::Drop;
    mapping
}

#[test]
fn rows_of_other_lengths_are_told_together_with_row_and_counts() {
    let long: String = (0..9).map(|k| format!("{k}.5,1.5,a\n")).collect();
    let text = said(&format!("t_s,u_m_s\n{long}9\n10,1\n"));
    assert!(text.contains("row 2 has 3 cells, row 3 has 3 cells"), "{text}");
    assert!(
        text.contains(
            "and 4 further rows, the last of which is row 10; the header has 2 (separated by `,`)"
        ),
        "{text}"
    );
    assert!(
        text.contains("error Some(11)") && text.contains("row 11 has 1 cell; the header has 2"),
        "{text}"
    );
    assert_eq!(text.lines().count(), 2, "{text}");
    assert!(!text.contains("decimal comma"), "{text}");
}

#[test]
fn a_decimal_comma_is_recognised() {
    for file in [
        "t_s,u_m_s,v_m_s,r_rad_s,psi_rad,delta_rad\n0.5,7,01,0.1,0.0,0.0,0.1\n1.0,7,02,0.1,0.0,0.0,0.1\n",
        "t_s,u_m_s,v_m_s\n0,5,7,01,-0,1\n1,5,7,01,-0,2\n",
        "t_s,u_m_s\n0,7,01e-1\n1,7,02\n",
        "t_s,u_m_s,note\n0,7,01,\n1,7,02,\n",
    ] {
        let text = said(file);
        assert!(text.contains("decimal comma") && text.contains("with a point"), "{file}: {text}");
        assert!(text.contains("row 2 has"), "{text}");
    }
    assert!(
        said("t_s;u_m_s\n0;1,5\n1;1,6\n").contains("numbers have a decimal comma, from row 2 on")
    );
    assert!(said("t_s,u_m_s\n0,\"1,5\"\n").contains("with a point"));
}

#[test]
fn a_rudder_has_its_side_and_a_latitude_its_hemisphere() {
    let table = accepted("t_s;delta_rad;u_m_s\n0;StB 0,5;7\n1;BB 0,2;7\n2;0,0;7\n");
    assert_eq!(table.values[1], [0.5, -0.2, 0.0]);
    let table = accepted("t_s,latitude_deg\n0,33.5 S\n1,33.6 S\n");
    assert!((table.values[1][0].to_degrees() + 33.5).abs() < 1e-9, "{:?}", table.values);
}

#[test]
fn separators_that_close_lines_are_passed_over_only_where_nothing_can_shift() {
    assert_eq!(accepted("t_s,u_m_s,\n0,1,\n1,2,\n").values[1], [1.0, 2.0]);
    assert_eq!(accepted("t_s,u_m_s\n0,1.5,\n1,2.5,\n").values[1], [1.5, 2.5]);
    assert_eq!(accepted("t_s;u_m_s\n0;1;\n1;2;\n").values[1], [1.0, 2.0]);
    for file in
        ["t_s,u_m_s\n0,1,\n1,2,\n", "t_s,u_m_s\n0,1.5,\n1,2.5\n", "t_s,u_m_s\n0,1.5,,\n1,2.5,,\n"]
    {
        assert!(said(file).contains("the header has 2"), "{file}");
    }
}

#[test]
fn short_rows_are_left_out_only_on_demand_and_long_ones_never() {
    let (table, text) = run("t_s,u_m_s,note\n0,1,a\n1,2\n2,3,c\n", &drops());
    assert_eq!(table.unwrap().values[0], [0.0, 2.0]);
    assert!(text.contains("row 3 skipped: the row has fewer cells"), "{text}");
    assert!(
        said("t_s,u_m_s,note\n0,1,a\n1,2\n2,3,c\n").contains("row 3 has 2 cells; the header has 3")
    );
    assert!(run("t_s,u_m_s\n0,1\n1,2,3\n2,3\n", &drops()).1.contains("error Some(3)"));
}

#[test]
fn rows_are_the_lines_of_an_editor() {
    for end in ["\n", "\r\n", "\r"] {
        let text = ["t_s,u_m_s,note", "", "0,1,\"two", "lines\"", "", "1,x,", "2,y,"].join(end);
        let text = said(&text);
        assert!(
            text.contains("error Some(6)") && text.contains("error Some(7)"),
            "{end:?}: {text}"
        );
    }
    let mixed = said("t_s,u_m_s\r\n0,1\n\r1,x\r2,2\n");
    assert!(mixed.contains("error Some(4)"), "{mixed}");
    assert_eq!(accepted("\n\nt_s,u_m_s\n0,1\n\n1,2\n").rows, [4, 6]);
}

#[test]
fn the_separator_does_not_depend_on_how_the_bytes_arrive() {
    /// One byte at a time.
    struct Slow<'a>(&'a [u8]);
    impl Read for Slow<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let most = buffer.len().min(1);
            self.0.read(&mut buffer[..most])
        }
    }
    for file in
        ["t_s;u_m_s\r\n0;1\r\n1;2\r\n", "\u{feff}\n\"t_s\";\"a, b, c\";u_m_s\n0;1;1\n1;1;2\n"]
    {
        let mut findings = Findings::default();
        let table =
            read_csv(Slow(file.as_bytes()), &Mapping::with_canonical_names(), &mut findings)
                .unwrap();
        assert_eq!(
            (table.values[0].clone(), table.values[1].clone()),
            (vec![0.0, 1.0], vec![1.0, 2.0])
        );
    }
}

#[test]
fn utf_16_is_read_and_a_damaged_cell_is_told() {
    let mut findings = Findings::default();
    let utf16: Vec<u8> =
        "\u{feff}t_s,u_m_s\n0,1\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
    let text = TextDecoder::new(utf16.as_slice());
    let table = read_csv(text, &Mapping::with_canonical_names(), &mut findings).unwrap();
    assert_eq!(table.values, [[0.0], [1.0]]);
    assert!(said("t_s,u_m_s\n0,1\0\n").contains("NUL"));
}

#[test]
fn a_file_of_a_header_alone_has_no_rows() {
    assert_eq!(accepted("t_s,u_m_s\n").rows.len(), 0);
    assert_eq!(accepted("t_s,u_m_s").rows.len(), 0);
}

#[test]
fn lines_above_the_header_and_units_below_it_are_passed_over() {
    let text = "Vessel;A\n;;\nStart;12:00\n\nt_s;psi;delta;Bemerkung\n[s];\u{b0};deg;\n0;1,5;2;a\n1;2,5;3;b\n";
    let latin: Vec<u8> = text.chars().map(|c| u8::try_from(u32::from(c)).unwrap()).collect();
    for bytes in [text.as_bytes(), &latin] {
        let mut findings = Findings::default();
        let table = read_csv(bytes, &Mapping::with_canonical_names(), &mut findings).unwrap();
        assert_eq!(table.rows, [7, 8]);
        assert!((table.values[1][1] - 2.5_f64.to_radians()).abs() < 1e-12);
        let text = finding_messages(findings);
        assert!(text.contains("warning Some(5) None columns not read: Bemerkung"), "{text}");
        assert!(!text.contains("error"), "{text}");
    }
    let far = format!("{}t_s,u_m_s\n0,1\n1,x\n", "about the ship, and more\n".repeat(90));
    assert!(said(&far).contains("error Some(93)"), "{}", said(&far));
    let long = format!("{}t_s,u_m_s\n0,1\n", "lines of a text without an end, ".repeat(400));
    assert!(said(&long).contains("error"));
}

#[test]
fn ignored_columns_are_not_told_and_empty_ones_once() {
    let mut mapping = Mapping::with_canonical_names();
    mapping.declared.ignore = vec!["note".into(), "u_m_s".into()];
    let (table, text) = run("t_s,u_m_s,v_m_s,r_rad_s,note\n0,1,1,,a\n1,1,1,,b\n", &mapping);
    assert_eq!(table.unwrap().columns.len(), 2);
    assert_eq!(text, "warning None Some(\"r_rad_s\") has no values; it is ignored");
}

#[test]
fn percentages_are_of_what_is_declared() {
    let mut mapping = Mapping::with_canonical_names();
    let column = |column: &str| sistership_model::manifest::ColumnMapping::new(column, "%");
    mapping.columns = vec![("n_s".into(), column("n port")), ("delta".into(), column("helm"))];
    let full = |value, unit: &str| crate::declarations::Maximum { value, unit: unit.into() };
    mapping.declared.maximum.insert("n".into(), full(120.0, "rpm"));
    let text = "t_s,n port,helm\n0,50,100\n1,50,-100\n";
    assert!(run(text, &mapping).1.contains("declare `maximum: { delta: { value: ..., unit: rad"));
    mapping.declared.maximum.insert("delta".into(), full(35.0, "deg"));
    let table = run(text, &mapping).0.unwrap();
    assert!((table.values[0][0] - 1.0).abs() < 1e-12);
    assert!((table.values[1][0] - 35.0_f64.to_radians()).abs() < 1e-12);
}
