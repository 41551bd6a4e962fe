//! Parquet, by the low-level column readers: no Arrow.

use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};

use parquet::basic::{ConvertedType, LogicalType, Type};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DataType;
use parquet::errors::{ParquetError, Result as ParquetResult};
use parquet::file::metadata::{ParquetMetaData, ParquetMetaDataReader, RowGroupMetaData};
use parquet::file::reader::{ChunkReader, FileReader, RowGroupReader, SerializedFileReader};
use parquet::schema::types::{ColumnDescriptor, SchemaDescriptor};

use crate::clock::Clock;
use crate::findings::Findings;
use crate::limits::{Limits, too_many};
use crate::mapping::Mapping;
use crate::number::Fault;
use crate::resolve::resolve;
use crate::stream;
use crate::table::{Column, Table, width};
use crate::taker::{RowsFile, Taker, time_at};
use sistership_containers::pages::{self, Held, held};

/// Reads the mapped columns; nothing after errors that leave nothing to check.
///
/// Rows are counted as in a CSV file: the first row of data is row 2.
pub(crate) fn read<R: ChunkReader + 'static>(
    input: R,
    mapping: &Mapping,
    findings: &mut Findings,
) -> Option<Table> {
    let file = ParquetRows::open(input, mapping, findings)?;
    if file.rows > mapping.limits.rows {
        let refused = FileRefusal::Rows { found: file.rows, most: mapping.limits.rows };
        findings.error(None, None, refused.to_string());
        return None;
    }
    stream::whole(file, mapping, findings)
}

/// The rows of a Parquet file.
pub(crate) struct ParquetRows<R: ChunkReader + 'static> {
    reader: SerializedFileReader<R>,
    columns: Vec<Column>,
    clock: Clock,
    rows: usize,
    most: usize,
    /// Why it cannot be read on.
    stopped: Option<String>,
}

impl<R: ChunkReader + 'static> ParquetRows<R> {
    /// Reads what the file says of itself; nothing after errors. Rows are counted by who holds
    /// them.
    pub(crate) fn open(input: R, mapping: &Mapping, findings: &mut Findings) -> Option<Self> {
        let limits = Limits { rows: usize::MAX, ..mapping.limits };
        let Mapped { columns, rows, .. } = mapped(&input, mapping, limits, findings)?;
        let opened = guarded(|| SerializedFileReader::new(input)).map_err(|error| {
            findings.error(None, None, FileRefusal::unreadable(error).to_string());
        });
        let (reader, clock) = (opened.ok()?, Clock::of(&columns));
        Some(Self { reader, columns, clock, rows, most: mapping.limits.rows, stopped: None })
    }

    fn groups(&mut self, taker: &mut impl Taker) -> ParquetResult<()> {
        let mut row = 1;
        for index in 0..self.reader.num_row_groups() {
            let group = self.reader.get_row_group(index)?;
            let cells = self.columns.iter().map(|column| Cells::new(&*group, column.index));
            let mut cells: Vec<Cells> = cells.collect::<Result<_, _>>()?;
            let rows = group_rows(&*group)?;
            for start in (0..rows).step_by(BATCH) {
                let count = BATCH.min(rows - start);
                cells.iter_mut().try_for_each(|cells| cells.next(count))?;
                batch_rows(&self.columns, &mut self.clock, row..row + count, &cells, taker);
                row += count;
                if taker.held() > self.most {
                    return Err(ParquetError::General(too_many(self.most)));
                }
            }
        }
        Ok(())
    }
}

impl<R: ChunkReader + 'static> RowsFile for ParquetRows<R> {
    fn columns(&self) -> &[Column] {
        &self.columns
    }

    fn room(&self) -> usize {
        self.rows
    }

    fn each(&mut self, taker: &mut impl Taker) {
        let outcome = guarded(|| self.groups(taker));
        self.stopped = outcome.err().map(|error| format!("the file is damaged: {error}"));
    }

    fn finish(&mut self, _: bool, table: &mut Table, findings: &mut Findings) {
        if let Some(message) = &self.stopped {
            findings.error(None, None, message.clone());
        }
        self.clock.finish(table, findings);
    }
}

/// Rows, columns that are read, and bytes that pages take at a time; nothing of a file that will be
/// refused.
pub(crate) fn measure<R: ChunkReader + 'static>(
    input: &R,
    mapping: &Mapping,
) -> Option<(usize, usize, u64)> {
    let mapped = mapped(input, mapping, mapping.limits, &mut Findings::default())?;
    Some((mapped.rows, width(&mapped.columns), mapped.holding))
}

/// What is read of a file.
struct Mapped {
    columns: Vec<Column>,
    rows: usize,
    /// Bytes that pages take at a time.
    holding: u64,
}

/// Finds the columns to read, and holds their pages against the limits before any is decompressed.
fn mapped<R: ChunkReader + 'static>(
    input: &R,
    mapping: &Mapping,
    limits: Limits,
    findings: &mut Findings,
) -> Option<Mapped> {
    let opened =
        metadata(input, limits).map_err(|refused| findings.error(None, None, refused.to_string()));
    let (meta, rows) = opened.ok()?;
    let schema = meta.file_metadata().schema_descr();
    let columns = resolve(&names(schema), mapping, findings)?;
    check_types(schema, &columns, findings);
    let mut holding = 0;
    for column in columns.iter().filter(|_| !findings.has_errors()).collect::<Vec<_>>() {
        let of_group = |group: &RowGroupMetaData| {
            held(input, group.column(column.index), mapping.limits.page_bytes)
        };
        let parts: Result<Vec<Held>, String> = meta.row_groups().iter().map(of_group).collect();
        match parts {
            Ok(parts) => holding += parts.into_iter().fold(Held::default(), Held::max).bytes(),
            Err(message) => findings.error(None, Some(&column.header), message),
        }
    }
    (!findings.has_errors()).then_some(Mapped { columns, rows, holding })
}

/// The library asserts some of what a file says of itself; on a file that lies, such a panic
/// becomes an error.
pub(crate) fn guarded<T>(work: impl FnOnce() -> ParquetResult<T>) -> ParquetResult<T> {
    let contradiction = |_| Err(ParquetError::General("it contradicts itself".into()));
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(contradiction)
}

/// Why a file is not read at all.
#[derive(Debug, thiserror::Error)]
pub(crate) enum FileRefusal {
    #[error("not a Parquet file that can be read: {0}")]
    Unreadable(String),
    #[error("{found} bytes about the file at its end are more than the {most} that are read")]
    Footer { found: u64, most: usize },
    #[error(
        "{found} rows are more than the {most} that are read; split the file, or let `sistership import` \
             find the stretches of it that matter"
    )]
    Rows { found: usize, most: usize },
    #[error("{found} columns are more than the {most} that are read")]
    Columns { found: usize, most: usize },
}

impl FileRefusal {
    fn unreadable(error: impl ToString) -> Self {
        Self::Unreadable(error.to_string())
    }
}

/// Opens the file and holds it against the limits before any sample is decoded.
pub(crate) fn open<R: ChunkReader + 'static>(
    input: R,
    limits: Limits,
) -> Result<SerializedFileReader<R>, FileRefusal> {
    metadata(&input, limits)?;
    guarded(|| SerializedFileReader::new(input)).map_err(FileRefusal::unreadable)
}

/// What the file says of itself, as far as that is within the limits, and its rows.
fn metadata<R: ChunkReader + 'static>(
    input: &R,
    limits: Limits,
) -> Result<(ParquetMetaData, usize), FileRefusal> {
    let footer = footer_bytes(input).map_err(FileRefusal::unreadable)?;
    if footer > limits.footer_bytes as u64 {
        return Err(FileRefusal::Footer { found: footer, most: limits.footer_bytes });
    }
    pages::footer(input, footer).map_err(FileRefusal::unreadable)?;
    let meta = guarded(|| ParquetMetaDataReader::new().parse_and_finish(input))
        .map_err(FileRefusal::unreadable)?;
    let columns = meta.file_metadata().schema_descr().num_columns();
    let mut chunks = meta.row_groups().iter().flat_map(|group| group.columns());
    if chunks.any(|chunk| {
        chunk.compressed_size() < 0
            || chunk.data_page_offset() < 0
            || chunk.dictionary_page_offset().is_some_and(|at| at < 0)
    }) {
        return Err(FileRefusal::unreadable("a column lies outside the file"));
    }
    // The groups are what is read, so they are counted, not the file's own total.
    let groups = meta.row_groups().iter().map(|group| group.num_rows());
    let counted: Option<Vec<usize>> =
        groups.clone().map(|rows| usize::try_from(rows).ok()).collect();
    let counted = counted
        .ok_or_else(|| FileRefusal::unreadable("a row group has a negative number of rows"))?;
    let rows = counted.into_iter().fold(0, usize::saturating_add);
    if rows > limits.rows {
        return Err(FileRefusal::Rows { found: rows, most: limits.rows });
    }
    if columns > limits.columns {
        return Err(FileRefusal::Columns { found: columns, most: limits.columns });
    }
    Ok((meta, rows))
}

/// Bytes of what the file says of itself; its last eight bytes hold their number and a mark.
fn footer_bytes<R: ChunkReader>(input: &R) -> ParquetResult<u64> {
    let at = input
        .len()
        .checked_sub(8)
        .ok_or_else(|| ParquetError::General("it is too short".into()))?;
    let end = input.get_bytes(at, 8)?;
    Ok(end.first_chunk().map_or(0, |bytes| u64::from(u32::from_le_bytes(*bytes))))
}

/// Dotted names of the columns.
pub(crate) fn headers<R: ChunkReader + 'static>(reader: &SerializedFileReader<R>) -> Vec<String> {
    names(reader.metadata().file_metadata().schema_descr())
}

fn names(schema: &SchemaDescriptor) -> Vec<String> {
    schema.columns().iter().map(|column| column.path().string()).collect()
}

fn check_types(schema: &SchemaDescriptor, columns: &[Column], findings: &mut Findings) {
    for column in columns {
        let found = schema.column(column.index);
        if !is_number(&found) {
            let message = format!(
                "holds {} values; write the column as DOUBLE, FLOAT, INT32 or INT64",
                type_name(&found)
            );
            findings.error(Some(1), Some(&column.header), message);
        }
    }
}

/// Dates, times and decimals are integers too, but not of the column's unit: what is not known to
/// be a number is refused.
fn is_number(column: &ColumnDescriptor) -> bool {
    use ConvertedType as C;
    let plain = matches!(column.logical_type_ref(), None | Some(LogicalType::Integer { .. }))
        && matches!(
            column.converted_type(),
            C::NONE
                | C::INT_8
                | C::INT_16
                | C::INT_32
                | C::INT_64
                | C::UINT_8
                | C::UINT_16
                | C::UINT_32
                | C::UINT_64
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

/// Rows that are decoded at a time.
pub(crate) const BATCH: usize = 8192;

/// Gives rows that have been decoded, by the numbers of those before them.
fn batch_rows<T: Taker>(
    columns: &[Column],
    clock: &mut Clock,
    before: Range<usize>,
    cells: &[Cells],
    taker: &mut T,
) {
    let time = time_at(columns).filter(|_| T::TIMED);
    let number =
        |k: usize, at: usize| cells[at].values.get(k).copied().filter(|value| value.is_finite());
    for (k, before) in before.enumerate() {
        let row = before + 1;
        if let Some(at) = time {
            let si = number(k, at).map(|time| time * columns[at].to_si);
            let t_s = si.and_then(|si| clock.since_start(si));
            if !taker.wants(row, t_s, clock) {
                continue;
            }
        }
        taker.row(row, |position, _| number(k, position).ok_or(Fault::NotANumber));
    }
}

fn group_rows(group: &dyn RowGroupReader) -> ParquetResult<usize> {
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

#[cfg(test)]
#[path = "parquet_file_tests.rs"]
mod tests;

#[cfg(test)]
#[path = "pages_tests.rs"]
mod pages_tests;
