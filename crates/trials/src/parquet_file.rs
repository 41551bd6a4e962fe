//! Parquet, by the low-level column readers: no Arrow.

use std::panic::{AssertUnwindSafe, catch_unwind};

use parquet::basic::{ConvertedType, LogicalType, Type};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DataType;
use parquet::errors::{ParquetError, Result as ParquetResult};
use parquet::file::reader::{ChunkReader, FileReader, RowGroupReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;

use crate::findings::Findings;
use crate::limits::Limits;
use crate::mapping::Mapping;
use crate::resolve::resolve;
use crate::rows::Builder;
use crate::table::{Column, Fault, Table};

/// Reads the mapped columns; nothing after errors that leave nothing to check.
///
/// Rows are counted as in a CSV file: the first row of data is row 2.
pub(crate) fn read<R: ChunkReader + 'static>(input: R, mapping: &Mapping, findings: &mut Findings) -> Option<Table> {
    let opened = open(input, mapping.limits).map_err(|message| findings.error(None, None, message));
    let reader = opened.ok()?;
    let columns = resolve(&headers(&reader), mapping, findings)?;
    check_types(&reader, &columns, findings);
    if findings.has_errors() {
        return None;
    }
    let mut builder = Builder::new(columns.clone(), mapping.conventions.missing, findings);
    let outcome = guarded(|| groups(&reader, &columns, &mut builder));
    let table = builder.finish();
    if let Err(error) = outcome {
        findings.error(None, None, format!("the file is damaged: {error}"));
    }
    Some(table)
}

/// The library asserts some of what a file says of itself; on a file that lies, such a panic becomes an error.
pub(crate) fn guarded<T>(work: impl FnOnce() -> ParquetResult<T>) -> ParquetResult<T> {
    let contradiction = |_| Err(ParquetError::General("it contradicts itself".into()));
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(contradiction)
}

/// Opens the file and holds it against the limits before any sample is decoded.
pub(crate) fn open<R: ChunkReader + 'static>(input: R, limits: Limits) -> Result<SerializedFileReader<R>, String> {
    let reader =
        guarded(|| SerializedFileReader::new(input)).map_err(|error| format!("not a Parquet file that can be read: {error}"))?;
    let meta = reader.metadata().file_metadata();
    let columns = meta.schema_descr().num_columns();
    let mut chunks = reader.metadata().row_groups().iter().flat_map(|group| group.columns());
    if chunks.any(|chunk| {
        chunk.compressed_size() < 0 || chunk.data_page_offset() < 0 || chunk.dictionary_page_offset().is_some_and(|at| at < 0)
    }) {
        return Err("not a Parquet file that can be read: a column lies outside the file".into());
    }
    // The groups are what is read, so they are counted, not the file's own total.
    let rows: i64 = reader.metadata().row_groups().iter().map(|group| group.num_rows()).fold(0, i64::saturating_add);
    if usize::try_from(rows).map_or(true, |rows| rows > limits.rows) {
        return Err(format!("{rows} rows are more than the {} that are read; split the file", limits.rows));
    }
    if columns > limits.columns {
        return Err(format!("{columns} columns are more than the {} that are read", limits.columns));
    }
    Ok(reader)
}

/// Dotted names of the columns.
pub(crate) fn headers<R: ChunkReader + 'static>(reader: &SerializedFileReader<R>) -> Vec<String> {
    reader.metadata().file_metadata().schema_descr().columns().iter().map(|column| column.path().string()).collect()
}

fn check_types<R: ChunkReader + 'static>(reader: &SerializedFileReader<R>, columns: &[Column], findings: &mut Findings) {
    let schema = reader.metadata().file_metadata().schema_descr();
    for column in columns {
        let found = schema.column(column.index);
        if !is_number(&found) {
            let message = format!("holds {} values; write the column as DOUBLE, FLOAT, INT32 or INT64", type_name(&found));
            findings.error(Some(1), Some(&column.header), message);
        }
    }
}

/// Dates, times and decimals are integers too, but not of the column's unit: what is not known to be a number is refused.
fn is_number(column: &ColumnDescriptor) -> bool {
    use ConvertedType as C;
    let plain = matches!(column.logical_type_ref(), None | Some(LogicalType::Integer { .. }))
        && matches!(
            column.converted_type(),
            C::NONE | C::INT_8 | C::INT_16 | C::INT_32 | C::INT_64 | C::UINT_8 | C::UINT_16 | C::UINT_32 | C::UINT_64
        );
    plain
        && column.max_rep_level() == 0
        && matches!(column.physical_type(), Type::DOUBLE | Type::FLOAT | Type::INT32 | Type::INT64)
}

fn is_unsigned(column: &ColumnDescriptor) -> bool {
    use ConvertedType as C;
    matches!(column.logical_type_ref(), Some(LogicalType::Integer(kind)) if !kind.is_signed)
        || matches!(column.converted_type(), C::UINT_8 | C::UINT_16 | C::UINT_32 | C::UINT_64)
}

/// The integer as f64, or NaN where an f64 cannot tell it from its neighbours.
fn exact(value: i128) -> f64 {
    if value.unsigned_abs() <= 1 << 53 { value as f64 } else { f64::NAN }
}

fn type_name(column: &ColumnDescriptor) -> String {
    match column.logical_type_ref() {
        _ if column.max_rep_level() > 0 => "repeated".into(),
        Some(logical) => format!("{logical:?}"),
        None => column.physical_type().to_string(),
    }
}

fn groups<R: ChunkReader + 'static>(
    reader: &SerializedFileReader<R>,
    columns: &[Column],
    builder: &mut Builder,
) -> ParquetResult<()> {
    let mut row = 1;
    for index in 0..reader.num_row_groups() {
        let group = reader.get_row_group(index)?;
        let values: Vec<Vec<f64>> =
            columns.iter().map(|column| column_values(&*group, column.index)).collect::<Result<_, _>>()?;
        let number = |k: usize, position: usize| values[position].get(k).copied().filter(|value| value.is_finite());
        for k in 0..group_rows(&*group)? {
            row += 1;
            builder.row(row, |position, _| number(k, position).ok_or(Fault::NotANumber));
        }
    }
    Ok(())
}

fn group_rows(group: &dyn RowGroupReader) -> ParquetResult<usize> {
    usize::try_from(group.metadata().num_rows())
        .map_err(|_| ParquetError::General("a row group has a negative number of rows".into()))
}

/// A column of a row group as f64; a null becomes NaN, and so does an integer beyond 2^53, which no f64 holds exactly.
///
/// # Errors
/// The column is damaged, of another type, or not as long as the group says.
pub(crate) fn column_values(group: &dyn RowGroupReader, index: usize) -> ParquetResult<Vec<f64>> {
    let rows = group_rows(group)?;
    let descriptor = group.metadata().column(index).column_descr();
    let (nullable, unsigned) = (descriptor.max_def_level(), is_unsigned(descriptor));
    match group.get_column_reader(index)? {
        ColumnReader::DoubleColumnReader(reader) => values(reader, rows, nullable, |value| value),
        ColumnReader::FloatColumnReader(reader) => values(reader, rows, nullable, f64::from),
        ColumnReader::Int32ColumnReader(reader) if unsigned => {
            values(reader, rows, nullable, |value| f64::from(value.cast_unsigned()))
        }
        ColumnReader::Int32ColumnReader(reader) => values(reader, rows, nullable, f64::from),
        ColumnReader::Int64ColumnReader(reader) if unsigned => {
            values(reader, rows, nullable, |value| exact(value.cast_unsigned().into()))
        }
        ColumnReader::Int64ColumnReader(reader) => values(reader, rows, nullable, |value| exact(value.into())),
        _ => Err(ParquetError::General("a column is of an unexpected type".into())),
    }
}

fn values<T: DataType>(
    mut reader: ColumnReaderImpl<T>,
    rows: usize,
    full: i16,
    to_f64: impl Fn(T::T) -> f64,
) -> ParquetResult<Vec<f64>> {
    let (mut levels, mut present) = (Vec::new(), Vec::new());
    let (records, ..) = reader.read_records(rows, Some(&mut levels), None, &mut present)?;
    let mut present = present.into_iter().map(to_f64);
    let values: Vec<f64> = match full {
        0 => present.collect(),
        _ => levels.iter().map(|&level| if level == full { present.next().unwrap_or(f64::NAN) } else { f64::NAN }).collect(),
    };
    if records == rows && values.len() == rows {
        return Ok(values);
    }
    Err(ParquetError::General(format!("a column holds {} values where {rows} are promised", values.len())))
}

#[cfg(test)]
#[path = "parquet_file_tests.rs"]
mod tests;
