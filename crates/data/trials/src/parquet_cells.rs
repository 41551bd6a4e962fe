//! Values of a Parquet column as f64, read in batches.

use parquet::basic::{ConvertedType, LogicalType};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DataType;
use parquet::errors::{ParquetError, Result as ParquetResult};
use parquet::file::reader::RowGroupReader;
use parquet::schema::types::ColumnDescriptor;

/// Number of rows that are decoded at a time.
pub(crate) const BATCH: usize = 8192;

/// Returns the number of rows of a row group.
pub(crate) fn group_rows(group: &dyn RowGroupReader) -> ParquetResult<usize> {
    usize::try_from(group.metadata().num_rows())
        .map_err(|_| ParquetError::General("a row group has a negative number of rows".into()))
}

/// Column of a row group as f64, decoded in batches; a null becomes NaN, and so does an integer
/// beyond 2^53, which an f64 does not hold exactly.
pub(crate) struct ColumnCells {
    reader: ColumnReader,
    full: i16,
    unsigned: bool,
    rows: usize,
    read: usize,
    /// Values of the last batch; a null is NaN.
    pub values: Vec<f64>,
}

impl ColumnCells {
    pub(crate) fn new(group: &dyn RowGroupReader, index: usize) -> ParquetResult<Self> {
        let descriptor = group.metadata().column(index).column_descr();
        // The definition level of a value; 0 for columns without nulls.
        let (full, unsigned) = (descriptor.max_def_level(), is_unsigned(descriptor));
        let (reader, rows) = (group.get_column_reader(index)?, group_rows(group)?);
        Ok(Self { reader, full, unsigned, rows, read: 0, values: Vec::new() })
    }

    /// Reads the next `count` rows.
    ///
    /// # Errors
    /// Returns an error if the column is damaged, of another type, or shorter than the group
    /// declares.
    pub(crate) fn read_next(&mut self, count: usize) -> ParquetResult<()> {
        let (full, values) = (self.full, &mut self.values);
        values.clear();
        let records = match &mut self.reader {
            ColumnReader::DoubleColumnReader(reader) => {
                read_batch(reader, count, full, |value| value, values)
            }
            ColumnReader::FloatColumnReader(reader) => {
                read_batch(reader, count, full, f64::from, values)
            }
            ColumnReader::Int32ColumnReader(reader) if self.unsigned => {
                read_batch(reader, count, full, |value| f64::from(value.cast_unsigned()), values)
            }
            ColumnReader::Int32ColumnReader(reader) => {
                read_batch(reader, count, full, f64::from, values)
            }
            ColumnReader::Int64ColumnReader(reader) if self.unsigned => read_batch(
                reader,
                count,
                full,
                |value| exact_or_nan(value.cast_unsigned().into()),
                values,
            ),
            ColumnReader::Int64ColumnReader(reader) => {
                read_batch(reader, count, full, |value| exact_or_nan(value.into()), values)
            }
            _ => Err(ParquetError::General("a column is of an unexpected type".into())),
        }?;
        self.read += self.values.len();
        // Fewer values than the group declares mean that the file is damaged.
        if records == count && self.values.len() == count {
            return Ok(());
        }
        let (read, rows) = (self.read, self.rows);
        Err(ParquetError::General(format!(
            "a column has {read} values instead of the {rows} announced"
        )))
    }
}

fn read_batch<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    count: usize,
    full: i16,
    to_f64: impl Fn(T::T) -> f64,
    values: &mut Vec<f64>,
) -> ParquetResult<usize> {
    let (mut levels, mut present) = (Vec::new(), Vec::new());
    let (records, ..) = reader.read_records(count, Some(&mut levels), None, &mut present)?;
    let mut present = present.into_iter().map(to_f64);
    // The reader returns non-null values only; definition levels give the places of nulls.
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

/// Returns the integer as f64, or NaN if an f64 cannot distinguish it from its neighbours.
fn exact_or_nan(value: i128) -> f64 {
    if value.unsigned_abs() <= 1 << 53 { value as f64 } else { f64::NAN }
}
