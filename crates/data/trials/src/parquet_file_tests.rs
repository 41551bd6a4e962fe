#![allow(clippy::unwrap_used)]
use std::sync::Arc;

use bytes::Bytes;
use parquet::data_type::{ByteArray, ByteArrayType, FloatType, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;

use super::*;
use crate::parquet_footer::open_file;
use crate::testing::finding_messages;

/// Three rows as another program might write them: integers, floats with a null, and text.
fn foreign() -> Bytes {
    let schema =
        "message m { required int64 t_ms; optional float u_m_s; required binary note (UTF8); }";
    let schema = Arc::new(parse_message_type(schema).unwrap());
    let mut bytes = Vec::new();
    let mut writer =
        SerializedFileWriter::new(&mut bytes, schema, Arc::new(WriterProperties::default()))
            .unwrap();
    let mut group = writer.next_row_group().unwrap();
    let mut column = group.next_column().unwrap().unwrap();
    column.typed::<Int64Type>().write_batch(&[0, 100, 200], None, None).unwrap();
    column.close().unwrap();
    let mut column = group.next_column().unwrap().unwrap();
    column.typed::<FloatType>().write_batch(&[1.5, 2.5], Some(&[1, 0, 1]), None).unwrap();
    column.close().unwrap();
    let mut column = group.next_column().unwrap().unwrap();
    column
        .typed::<ByteArrayType>()
        .write_batch(&["a", "b", "c"].map(ByteArray::from), None, None)
        .unwrap();
    column.close().unwrap();
    group.close().unwrap();
    writer.close().unwrap();
    bytes.into()
}

#[test]
fn integers_floats_and_nulls_are_read() {
    let mut findings = Findings::default();
    let table = read_parquet(foreign(), &Mapping::with_canonical_names(), &mut findings).unwrap();
    assert_eq!(
        (table.values[0].clone(), table.values[1].clone()),
        (vec![0.0, 0.2], vec![1.5, 2.5])
    );
    assert_eq!(table.rows, [2, 4]);
    let text = finding_messages(findings);
    assert!(
        text.contains("error Some(3) Some(\"u_m_s\")") && text.contains("columns not read: note"),
        "{text}"
    );
}

#[test]
fn text_is_no_channel_and_sizes_are_bounded() {
    let mut mapping = Mapping::with_canonical_names();
    let note = sistership_model::manifest::ColumnMapping::new("note", "m/s");
    mapping.columns.push(("v".into(), note));
    let mut findings = Findings::default();
    assert!(read_parquet(foreign(), &mapping, &mut findings).is_none());
    assert!(finding_messages(findings).contains("write the column as DOUBLE"));
    for (limits, said) in [
        (FileLimits { rows: 2, ..FileLimits::default() }, "3 rows are more than the limit of 2"),
        (
            FileLimits { columns: 2, ..FileLimits::default() },
            "3 columns are more than the limit of 2",
        ),
    ] {
        assert!(open_file(foreign(), limits).err().unwrap().to_string().contains(said));
    }
}

/// A file of time and one column of integers of the given type.
fn integers(kind: &str, small: &[i32], large: &[i64]) -> Bytes {
    let schema = format!("message m {{ required double t_s; required {kind}; }}");
    let schema = Arc::new(parse_message_type(&schema).unwrap());
    let mut bytes = Vec::new();
    let mut writer =
        SerializedFileWriter::new(&mut bytes, schema, Arc::new(WriterProperties::default()))
            .unwrap();
    let mut group = writer.next_row_group().unwrap();
    let mut column = group.next_column().unwrap().unwrap();
    let times: Vec<f64> = (0..small.len().max(large.len())).map(|k| k as f64).collect();
    column.typed::<parquet::data_type::DoubleType>().write_batch(&times, None, None).unwrap();
    column.close().unwrap();
    let mut column = group.next_column().unwrap().unwrap();
    match small {
        [] => column.typed::<Int64Type>().write_batch(large, None, None).unwrap(),
        _ => {
            column.typed::<parquet::data_type::Int32Type>().write_batch(small, None, None).unwrap()
        }
    };
    column.close().unwrap();
    group.close().unwrap();
    writer.close().unwrap();
    bytes.into()
}

#[test]
fn unsigned_integers_are_not_taken_for_negative_ones() {
    let mut findings = Findings::default();
    let file = integers("int32 x_m (UINT_32)", &[1, -1, 3], &[]);
    let table = read_parquet(file, &Mapping::with_canonical_names(), &mut findings).unwrap();
    assert_eq!(table.values[1], [1.0, 4_294_967_295.0, 3.0]);
}

#[test]
fn integers_that_no_f64_holds_are_told() {
    for kind in ["int64 x_m", "int64 x_m (UINT_64)"] {
        let mut findings = Findings::default();
        let file = integers(kind, &[], &[1, 1 << 53, (1 << 53) + 1]);
        read_parquet(file, &Mapping::with_canonical_names(), &mut findings).unwrap();
        assert!(finding_messages(findings).contains("error Some(4) Some(\"x_m\")"));
    }
}

#[test]
fn times_and_decimals_are_no_plain_integers() {
    for kind in [
        "int32 x_m (TIME_MILLIS)",
        "int64 x_m (TIMESTAMP_MICROS)",
        "int32 x_m (DECIMAL(9,2))",
        "int32 x_m (DATE)",
    ] {
        let (small, large) = if kind.starts_with("int32") {
            (vec![1, 2, 3], vec![])
        } else {
            (vec![], vec![1, 2, 3])
        };
        let mut findings = Findings::default();
        assert!(
            read_parquet(
                integers(kind, &small, &large),
                &Mapping::with_canonical_names(),
                &mut findings
            )
            .is_none(),
            "{kind}"
        );
        assert!(finding_messages(findings).contains("write the column as DOUBLE"), "{kind}");
    }
}
