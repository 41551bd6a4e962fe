#![allow(clippy::unwrap_used)]
use std::sync::Arc;

use bytes::Bytes;
use parquet::basic::{Compression, GzipLevel};
use parquet::data_type::DoubleType;
use parquet::file::properties::{WriterProperties, WriterVersion};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;

use super::*;
use crate::{FileLimits, Mapping, TrialFile, check_source};

/// Time and a constant speed.
fn file(rows: usize, properties: WriterProperties) -> Bytes {
    let schema = Arc::new(
        parse_message_type("message m { required double t_s; required double u_m_s; }").unwrap(),
    );
    let mut bytes = Vec::new();
    let mut writer = SerializedFileWriter::new(&mut bytes, schema, Arc::new(properties)).unwrap();
    let mut group = writer.next_row_group().unwrap();
    for values in [(0..rows).map(|k| k as f64).collect::<Vec<_>>(), vec![5.0; rows]] {
        let mut column = group.next_column().unwrap().unwrap();
        column.typed::<DoubleType>().write_batch(&values, None, None).unwrap();
        column.close().unwrap();
    }
    group.close().unwrap();
    writer.close().unwrap();
    bytes.into()
}

/// One page for each column, whatever its size.
fn one_page(compression: Compression, version: WriterVersion) -> WriterProperties {
    let plain = WriterProperties::builder()
        .set_dictionary_enabled(false)
        .set_compression(compression)
        .set_writer_version(version);
    plain.set_data_page_size_limit(1 << 30).set_data_page_row_count_limit(1 << 30).build()
}

fn second(bytes: &Bytes, most: usize) -> Result<PageMemory, String> {
    let reader = SerializedFileReader::new(bytes.clone()).unwrap();
    measure_pages(bytes, reader.metadata().row_group(0).column(1), most)
}

#[test]
fn pages_are_measured_without_being_read() {
    for version in [WriterVersion::PARQUET_1_0, WriterVersion::PARQUET_2_0] {
        for compression in [
            Compression::UNCOMPRESSED,
            Compression::SNAPPY,
            Compression::GZIP(GzipLevel::default()),
        ] {
            let bytes = file(10_000, one_page(compression, version));
            let found = second(&bytes, 1 << 20).unwrap();
            assert!((80_000..170_000).contains(&found.total_bytes()), "{found:?}");
            assert!(second(&bytes, 79_999).unwrap_err().contains("write smaller pages"));
        }
    }
    let small = file(100_000, WriterProperties::builder().set_dictionary_enabled(false).build());
    assert!(second(&small, 1 << 20).unwrap().total_bytes() < 400_000);
}

#[test]
fn a_header_that_lies_is_found_out_before_its_page_is_unpacked() {
    // Eight million bytes of one number take a few thousand in gzip; the header is made to say that
    // they are fewer.
    for version in [WriterVersion::PARQUET_1_0, WriterVersion::PARQUET_2_0] {
        let bytes = file(1_000_000, one_page(Compression::GZIP(GzipLevel::default()), version));
        let reader = SerializedFileReader::new(bytes.clone()).unwrap();
        let (start, _) = reader.metadata().row_group(0).column(1).byte_range();
        let mut lying = bytes.to_vec();
        // Type, then the size in memory as a number of several bytes: 16,000,000 zigzagged.
        let at = start as usize + 3;
        let size = [0x80, 0xc8, 0xd0, 0x07];
        assert_eq!(lying[at..at + 4], size, "{:02x?}", &lying[start as usize..start as usize + 12]);
        lying[at + 3] = 0x01;
        let error = second(&lying.into(), 16 << 20).unwrap_err();
        assert!(error.contains("larger than declared in its header"), "{error}");
    }
}

#[test]
fn files_of_large_pages_are_refused_by_column() {
    let bytes = file(300_000, one_page(Compression::SNAPPY, WriterVersion::PARQUET_1_0));
    let limits = FileLimits { page_bytes: 1 << 20, ..FileLimits::default() };
    let outcome = check_source(
        TrialFile::from_parquet("a", bytes),
        &Mapping { limits, ..Mapping::with_canonical_names() },
    );
    assert_eq!(outcome.errors.len(), 2, "{outcome:?}");
    assert!(
        outcome.errors[1].column.as_deref() == Some("u_m_s")
            && outcome.errors[1].message.contains("2400000 bytes")
    );
}

/// Found by the fuzz target: 47, 108 and 150 bytes that kept the library busy for seconds.
#[test]
fn lists_that_are_not_there_take_no_time() {
    let lists: [&'static [u8]; 3] = [
        include_bytes!("../../../../tests/fuzz/corpus/parquet/list-that-is-not-there"),
        include_bytes!("../../../../tests/fuzz/corpus/parquet/list-of-truths"),
        include_bytes!("../../../../tests/fuzz/corpus/parquet/field-of-another-kind"),
    ];
    for bytes in lists {
        let begun = std::time::Instant::now();
        let outcome = check_source(
            TrialFile::from_parquet("a.parquet", Bytes::from_static(bytes)),
            &Mapping::with_canonical_names(),
        );
        assert!(
            !outcome.errors.is_empty() && begun.elapsed() < std::time::Duration::from_millis(200),
            "{:?}",
            begun.elapsed()
        );
    }
}
