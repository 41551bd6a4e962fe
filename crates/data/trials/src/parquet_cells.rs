//! The values of a Parquet column as f64, some rows at a time.

use parquet::basic::{ConvertedType, LogicalType};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DataType;
use parquet::errors::{ParquetError, Result as ParquetResult};
use parquet::file::reader::RowGroupReader;
use parquet::schema::types::ColumnDescriptor;

/// Rows that are decoded at a time.
pub(crate) const BATCH: usize = 8192;

/// Rows of a row group.
pub(crate) fn group_rows(group: &dyn RowGroupReader) -> ParquetResult<usize> {
    usize::try_from(group.metadata().num_rows())
        .map_err(|_| ParquetError::General("a row group has a negative number of rows".into()))
}

/// A column of a row group as f64, decoded some rows at a time; a null becomes NaN, and so does an
/// integer beyond 2^53, which no f64 holds exactly.
pub(crate) struct Cells {
    reader: ColumnReader,
    full: i16,
    unsigned: bool,
    rows: usize,
    read: usize,
    /// The rows last read; a null is NaN.
    pub values: Vec<f64>,
}

impl Cells {
    pub(crate) fn new(group: &dyn RowGroupReader, index: usize) -> ParquetResult<Self> {
        let descriptor = group.metadata().column(index).column_descr();
        let (full, unsigned) = (descriptor.max_def_level(), is_unsigned(descriptor));
        let (reader, rows) = (group.get_column_reader(index)?, group_rows(group)?);
        Ok(Self { reader, full, unsigned, rows, read: 0, values: Vec::new() })
    }

    /// Reads so many further rows.
    ///
    /// # Errors
    /// The column is damaged, of another type, or not as long as the group says.
    pub(crate) fn next(&mut self, count: usize) -> ParquetResult<()> {
        let (full, values) = (self.full, &mut self.values);
        values.clear();
        let records = match &mut self.reader {
            ColumnReader::DoubleColumnReader(reader) => {
                batch(reader, count, full, |value| value, values)
            }
            ColumnReader::FloatColumnReader(reader) => {
                batch(reader, count, full, f64::from, values)
            }
            ColumnReader::Int32ColumnReader(reader) if self.unsigned => {
                batch(reader, count, full, |value| f64::from(value.cast_unsigned()), values)
            }
            ColumnReader::Int32ColumnReader(reader) => {
                batch(reader, count, full, f64::from, values)
            }
            ColumnReader::Int64ColumnReader(reader) if self.unsigned => {
                batch(reader, count, full, |value| exact(value.cast_unsigned().into()), values)
            }
            ColumnReader::Int64ColumnReader(reader) => {
                batch(reader, count, full, |value| exact(value.into()), values)
            }
            _ => Err(ParquetError::General("a column is of an unexpected type".into())),
        }?;
        self.read += self.values.len();
        if records == count && self.values.len() == count {
            return Ok(());
        }
        let (read, rows) = (self.read, self.rows);
        Err(ParquetError::General(format!(
            "a column holds {read} values where {rows} are promised"
        )))
    }
}

fn batch<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    count: usize,
    full: i16,
    to_f64: impl Fn(T::T) -> f64,
    values: &mut Vec<f64>,
) -> ParquetResult<usize> {
    let (mut levels, mut present) = (Vec::new(), Vec::new());
    let (records, ..) = reader.read_records(count, Some(&mut levels), None, &mut present)?;
    let mut present = present.into_iter().map(to_f64);
    match full {
        0 => values.extend(present),
        _ => values.extend(
            levels
                .iter()
                .map(|&at| if at == full { present.next().unwrap_or(f64::NAN) } else { f64::NAN }),
        ),
    }
    Ok(records)
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
