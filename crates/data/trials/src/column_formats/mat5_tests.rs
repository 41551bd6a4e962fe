#![allow(clippy::unwrap_used)]
use std::io::{Cursor, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;

use crate::column_formats::ColumnFormat;
use crate::column_reader::ColumnFile;
use crate::findings::Findings;
use crate::mapping::Mapping;
use crate::table::Table;
use crate::testing::finding_messages;

fn element(kind: u32, data: &[u8]) -> Vec<u8> {
    let mut bytes = kind.to_le_bytes().to_vec();
    bytes.extend(u32::try_from(data.len()).unwrap().to_le_bytes());
    bytes.extend(data);
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}

fn matrix(name: &str, class: u32, rows: i32, columns: i32, content: &[u8]) -> Vec<u8> {
    let mut data = element(6, &[class.to_le_bytes(), [0; 4]].concat());
    data.extend(element(5, &[rows.to_le_bytes(), columns.to_le_bytes()].concat()));
    data.extend(element(1, name.as_bytes()));
    data.extend(content);
    element(14, &data)
}

fn doubles(values: &[f64]) -> Vec<u8> {
    element(9, &values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<_>>())
}

fn packed(element: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(element).unwrap();
    let data = encoder.finish().unwrap();
    let mut bytes = 15_u32.to_le_bytes().to_vec();
    bytes.extend(u32::try_from(data.len()).unwrap().to_le_bytes());
    bytes.extend(data);
    bytes
}

fn mat_file(elements: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = format!("{:<124}", "MATLAB 5.0 MAT-file").into_bytes();
    bytes.extend([0, 1, b'I', b'M']);
    bytes.extend(elements.concat());
    bytes
}

/// `t_s` plain, `u_kn` of 16-bit integers, a matrix, and a structure with `psi`, packed.
fn example() -> Vec<u8> {
    let shorts: Vec<u8> = [10_i16, -11, 12].iter().flat_map(|value| value.to_le_bytes()).collect();
    let names = [&b"psi\0\0\0\0\0"[..], b"note\0\0\0\0"].concat();
    let mut fields = 5_u32.to_le_bytes().to_vec();
    fields[2] = 4;
    fields.extend(8_i32.to_le_bytes());
    fields.extend(element(1, &names));
    fields.extend(matrix("", 6, 1, 3, &doubles(&[0.1, 0.2, 0.3])));
    fields.extend(matrix("", 4, 1, 1, &element(4, &[65, 0])));
    mat_file(&[
        matrix("t_s", 6, 3, 1, &doubles(&[0.0, 1.0, 2.0])),
        matrix("u_kn", 10, 3, 1, &element(3, &shorts)),
        packed(&matrix("track", 6, 3, 2, &doubles(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]))),
        packed(&matrix("log", 2, 1, 1, &fields)),
    ])
}

fn mapping() -> Mapping {
    let mut mapping = Mapping::with_canonical_names();
    let column =
        |column: &str, unit: &str| sistership_model::manifest::ColumnMapping::new(column, unit);
    mapping.columns =
        vec![("y".into(), column("track(:,2)", "m")), ("psi".into(), column("log.psi", "rad"))];
    mapping
}

fn file_of(bytes: Vec<u8>) -> ColumnFile<'static> {
    ColumnFile { format: ColumnFormat::Matlab, input: Box::new(Cursor::new(bytes)) }
}

fn run(bytes: Vec<u8>, mapping: &Mapping) -> (Option<Table>, String) {
    let mut findings = Findings::default();
    let table = file_of(bytes).read_table(mapping, &mut findings);
    (table, finding_messages(findings))
}

#[test]
fn vectors_matrices_and_fields_are_columns() {
    let (table, text) = run(example(), &mapping());
    let table = table.unwrap();
    let of = |header: &str| {
        let at = table.columns.iter().position(|column| column.header == header).unwrap();
        &table.values[at]
    };
    assert_eq!(of("t_s"), &[0.0, 1.0, 2.0], "{text}");
    assert_eq!(of("track(:,2)"), &[4.0, 5.0, 6.0]);
    assert_eq!(of("log.psi"), &[0.1, 0.2, 0.3]);
    assert!((of("u_kn")[1] + 11.0 * 0.514_444).abs() < 1e-4);
    assert!(text.contains("columns not read: track(:,1)"), "{text}");
    let measured = file_of(example()).measure_table(&mapping()).unwrap();
    assert_eq!(measured, (3, 8));
}

/// Structures with the fields `t_s`, `u_m_s` and `r_rad_s`, one for each given speed.
fn structures(name: &str, speeds: &[f64]) -> Vec<u8> {
    let mut fields = 5_u32.to_le_bytes().to_vec();
    fields[2] = 4;
    fields.extend(8_i32.to_le_bytes());
    fields.extend(element(1, b"t_s\0\0\0\0\0u_m_s\0\0\0r_rad_s\0"));
    let column = |of: &dyn Fn(usize) -> f64| {
        matrix("", 6, 1, 20, &doubles(&(0..20).map(of).collect::<Vec<_>>()))
    };
    for speed in speeds {
        fields.extend(column(&|k| k as f64));
        fields.extend(column(&|_| *speed));
        fields.extend(column(&|k| 0.01 * k as f64));
    }
    matrix(name, 2, 1, i32::try_from(speeds.len()).unwrap(), &fields)
}

fn speed_of(bytes: Vec<u8>, part: Option<&str>) -> (f64, String) {
    let mapping = Mapping { part: part.map(str::to_owned), ..Mapping::with_canonical_names() };
    let (table, text) = run(bytes, &mapping);
    let speed = table.and_then(|table| {
        let at = table.columns.iter().position(|column| column.header == "u_m_s")?;
        table.values[at].first().copied()
    });
    (speed.unwrap_or(f64::NAN), text)
}

#[test]
fn structures_of_an_array_and_of_a_cell_are_parts() {
    let array = mat_file(&[packed(&structures("runs", &[3.0, 4.0, 5.0]))]);
    assert_eq!(speed_of(array.clone(), Some("runs(2)")).0, 4.0);
    let (_, refused) = speed_of(array, None);
    assert!(refused.contains("3 tables") && refused.contains("runs(3)"), "{refused}");
    let held = [structures("", &[6.0]), structures("", &[7.0])].concat();
    let cell = mat_file(&[matrix("all", 1, 1, 2, &held)]);
    assert_eq!(speed_of(cell.clone(), Some("all{2}")).0, 7.0);
    assert!(speed_of(cell, Some("all{3}")).1.contains("no part `all{3}` (all{1}, all{2})"));
    assert_eq!(speed_of(mat_file(&[structures("log", &[2.0])]), None).0, 2.0);
    // Any number of structures without a field.
    let mut none = 5_u32.to_le_bytes().to_vec();
    none[2] = 4;
    none.extend(2_i32.to_le_bytes());
    none.extend(element(1, b""));
    let many = matrix("many", 2, i32::MAX, i32::MAX, &none);
    assert_eq!(speed_of(mat_file(&[many, structures("log", &[2.0])]), None).0, 2.0);
}

#[test]
fn columns_on_different_time_bases_and_bombs_are_refused() {
    let mut uneven = example();
    uneven.extend(matrix("v_m_s", 6, 2, 1, &doubles(&[1.0, 2.0])));
    assert!(run(uneven, &mapping()).1.contains("has 2 values, but time has 3"));
    let mut bomb = mapping();
    bomb.limits.unpacked_bytes = 1000;
    let zeros = packed(&matrix("zeros", 6, 1000, 1, &doubles(&[0.0; 1000])));
    assert!(run(mat_file(&[zeros]), &bomb).1.contains("too many bytes"));
    bomb = mapping();
    bomb.limits.rows = 2;
    assert!(run(example(), &bomb).1.contains("3 values are more than the limit of 2"));
}

#[test]
fn damaged_files_are_errors_at_worst() {
    let bytes = example();
    for at in 0..bytes.len() {
        for change in [0x01, 0x80, 0xff] {
            let mut damaged = bytes.clone();
            damaged[at] ^= change;
            let _ = run(damaged, &mapping());
        }
        let _ = run(bytes[..at].to_vec(), &mapping());
    }
}
