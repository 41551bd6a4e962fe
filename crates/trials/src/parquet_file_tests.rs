#![allow(clippy::unwrap_used)]
use std::sync::Arc;

use bytes::Bytes;
use parquet::data_type::{ByteArray, ByteArrayType, FloatType, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;

use super::*;
use crate::testing::messages;

/// Three rows as another program might write them: integers, floats with a null, and text.
fn foreign() -> Bytes {
    let schema = "message m { required int64 t_ms; optional float u_m_s; required binary note (UTF8); }";
    let schema = Arc::new(parse_message_type(schema).unwrap());
    let mut bytes = Vec::new();
    let mut writer = SerializedFileWriter::new(&mut bytes, schema, Arc::new(WriterProperties::default())).unwrap();
    let mut group = writer.next_row_group().unwrap();
    let mut column = group.next_column().unwrap().unwrap();
    column.typed::<Int64Type>().write_batch(&[0, 100, 200], None, None).unwrap();
    column.close().unwrap();
    let mut column = group.next_column().unwrap().unwrap();
    column.typed::<FloatType>().write_batch(&[1.5, 2.5], Some(&[1, 0, 1]), None).unwrap();
    column.close().unwrap();
    let mut column = group.next_column().unwrap().unwrap();
    column.typed::<ByteArrayType>().write_batch(&["a", "b", "c"].map(ByteArray::from), None, None).unwrap();
    column.close().unwrap();
    group.close().unwrap();
    writer.close().unwrap();
    bytes.into()
}

#[test]
fn integers_floats_and_nulls_are_read() {
    let mut findings = Findings::default();
    let table = read(foreign(), &Mapping::canonical(), &mut findings).unwrap();
    assert_eq!((table.values[0].clone(), table.values[1].clone()), (vec![0.0, 0.2], vec![1.5, 2.5]));
    assert_eq!(table.rows, [2, 4]);
    let text = messages(findings);
    assert!(text.contains("error Some(3) Some(\"u_m_s\")") && text.contains("columns not read: note"), "{text}");
}

#[test]
fn text_is_no_channel_and_sizes_are_bounded() {
    let mut mapping = Mapping::canonical();
    let note = sistership_model::manifest::ColumnMapping { column: "note".into(), unit: "m/s".into() };
    mapping.columns.push(("v".into(), note));
    let mut findings = Findings::default();
    assert!(read(foreign(), &mapping, &mut findings).is_none());
    assert!(messages(findings).contains("write the column as DOUBLE"));
    for (limits, said) in [
        (Limits { rows: 2, ..Limits::default() }, "3 rows are more than the 2"),
        (Limits { columns: 2, ..Limits::default() }, "3 columns are more than the 2"),
    ] {
        assert!(open(foreign(), limits).err().unwrap().contains(said));
    }
}
