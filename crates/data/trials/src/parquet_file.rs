//! Parquet files, read by the low-level column readers without Arrow.

use std::ops::Range;

use parquet::basic::{ConvertedType, LogicalType, Type};
use parquet::errors::{ParquetError, Result as ParquetResult};
use parquet::file::metadata::RowGroupMetaData;
use parquet::file::reader::{ChunkReader, FileReader, SerializedFileReader};
use parquet::schema::types::{ColumnDescriptor, SchemaDescriptor};

use crate::clock::ColumnClock;
use crate::containers::pages::{PageMemory, measure_pages};
use crate::findings::Findings;
use crate::limits::{FileLimits, too_many_rows};
use crate::mapping::Mapping;
use crate::number::CellFault;
use crate::parquet_cells::{BATCH, ColumnCells, group_rows};
use crate::parquet_footer::{FileRefusal, catch_panics, checked_metadata, schema_names};
use crate::resolve::resolve_headers;
use crate::row_sink::{RowSink, RowSource, time_column};
use crate::stream;
use crate::table::{Table, TableColumn, memory_columns};

/// Reads the mapped columns; returns `None` after errors that prevent any check.
///
/// Rows are counted as in a CSV file: the first row of data is row 2.
pub(crate) fn read_parquet<R: ChunkReader + 'static>(
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
    stream::read_whole(file, mapping, findings)
}

/// Rows of a Parquet file.
pub(crate) struct ParquetRows<R: ChunkReader + 'static> {
    reader: SerializedFileReader<R>,
    columns: Vec<TableColumn>,
    clock: ColumnClock,
    rows: usize,
    most: usize,
    /// Reason for which reading stopped.
    stopped: Option<String>,
}

impl<R: ChunkReader + 'static> ParquetRows<R> {
    /// Reads the footer of the file; returns `None` after errors. The limit on rows is checked by
    /// the sink that stores them.
    pub(crate) fn open(input: R, mapping: &Mapping, findings: &mut Findings) -> Option<Self> {
        // Segments of a file of any length are read; the sink limits the rows that it stores.
        let limits = FileLimits { rows: usize::MAX, ..mapping.limits };
        let ParquetColumns { columns, rows, .. } = map_columns(&input, mapping, limits, findings)?;
        let opened = catch_panics(|| SerializedFileReader::new(input)).map_err(|error| {
            findings.error(None, None, FileRefusal::from_error(error).to_string());
        });
        let (reader, clock) = (opened.ok()?, ColumnClock::from_columns(&columns));
        Some(Self { reader, columns, clock, rows, most: mapping.limits.rows, stopped: None })
    }

    fn read_groups(&mut self, taker: &mut impl RowSink) -> ParquetResult<()> {
        // Column readers of a row group advance together, one batch of rows at a time.
        let mut row = 1;
        for index in 0..self.reader.num_row_groups() {
            let group = self.reader.get_row_group(index)?;
            let cells = self.columns.iter().map(|column| ColumnCells::new(&*group, column.index));
            let mut cells: Vec<ColumnCells> = cells.collect::<Result<_, _>>()?;
            let rows = group_rows(&*group)?;
            for start in (0..rows).step_by(BATCH) {
                let count = BATCH.min(rows - start);
                cells.iter_mut().try_for_each(|cells| cells.read_next(count))?;
                give_batch(&self.columns, &mut self.clock, row..row + count, &cells, taker);
                row += count;
                // After each batch, so that at most one batch too many is stored.
                if taker.stored_rows() > self.most {
                    return Err(ParquetError::General(too_many_rows(self.most)));
                }
            }
        }
        Ok(())
    }
}

impl<R: ChunkReader + 'static> RowSource for ParquetRows<R> {
    fn columns(&self) -> &[TableColumn] {
        &self.columns
    }

    fn expected_rows(&self) -> usize {
        self.rows
    }

    fn feed_rows(&mut self, taker: &mut impl RowSink) {
        let outcome = catch_panics(|| self.read_groups(taker));
        self.stopped = outcome.err().map(|error| format!("the file is damaged: {error}"));
    }

    fn complete_table(&mut self, _: bool, table: &mut Table, findings: &mut Findings) {
        if let Some(message) = &self.stopped {
            findings.error(None, None, message.clone());
        }
        self.clock.rebase_table(table, findings);
    }
}

/// Returns the number of rows and of columns that are read, and the bytes that pages take at a
/// time; `None` for a file that will be refused.
pub(crate) fn measure_parquet<R: ChunkReader + 'static>(
    input: &R,
    mapping: &Mapping,
) -> Option<(usize, usize, u64)> {
    let mapped = map_columns(input, mapping, mapping.limits, &mut Findings::default())?;
    Some((mapped.rows, memory_columns(&mapped.columns), mapped.holding))
}

/// Columns that are read of a file, and its size.
struct ParquetColumns {
    columns: Vec<TableColumn>,
    rows: usize,
    /// Bytes that pages take at a time.
    holding: u64,
}

/// Finds the columns to read, and checks their pages against the limits before any is unpacked.
fn map_columns<R: ChunkReader + 'static>(
    input: &R,
    mapping: &Mapping,
    limits: FileLimits,
    findings: &mut Findings,
) -> Option<ParquetColumns> {
    let opened = checked_metadata(input, limits)
        .map_err(|refused| findings.error(None, None, refused.to_string()));
    let (meta, rows) = opened.ok()?;
    let schema = meta.file_metadata().schema_descr();
    let mut columns = resolve_headers(&schema_names(schema), mapping, findings)?;
    // Columns of other types cannot be identified by their values.
    if mapping.unidentified.is_some() {
        columns.retain(|column| is_number(&schema.column(column.index)));
    }
    check_types(schema, &columns, findings);
    let mut holding = 0;
    for column in columns.iter().filter(|_| !findings.has_errors()).collect::<Vec<_>>() {
        let of_group = |group: &RowGroupMetaData| {
            measure_pages(input, group.column(column.index), mapping.limits.page_bytes)
        };
        let parts: Result<Vec<PageMemory>, String> =
            meta.row_groups().iter().map(of_group).collect();
        match parts {
            // Row groups are read one after the other, the columns of a group together: the maximum
            // over groups, and the sum over columns.
            Ok(parts) => {
                holding += parts
                    .into_iter()
                    .fold(PageMemory::default(), PageMemory::max_of_each)
                    .total_bytes()
            }
            Err(message) => findings.error(None, Some(&column.header), message),
        }
    }
    (!findings.has_errors()).then_some(ParquetColumns { columns, rows, holding })
}

fn check_types(schema: &SchemaDescriptor, columns: &[TableColumn], findings: &mut Findings) {
    for column in columns {
        let found = schema.column(column.index);
        if !is_number(&found) {
            let message = format!(
                "has {} values; write the column as DOUBLE, FLOAT, INT32 or INT64",
                type_name(&found)
            );
            findings.error(Some(1), Some(&column.header), message);
        }
    }
}

/// Returns true if the column holds plain numbers. Dates, times and decimals are stored as
/// integers, too, but in units of their own: only known types are accepted.
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

fn type_name(column: &ColumnDescriptor) -> String {
    match column.logical_type_ref() {
        _ if column.max_rep_level() > 0 => "repeated".into(),
        Some(logical) => format!("{logical:?}"),
        None => column.physical_type().to_string(),
    }
}

/// Passes decoded rows to the sink; `before` is the range of the numbers of the preceding rows.
fn give_batch<T: RowSink>(
    columns: &[TableColumn],
    clock: &mut ColumnClock,
    before: Range<usize>,
    cells: &[ColumnCells],
    taker: &mut T,
) {
    let time = time_column(columns).filter(|_| T::TIMED);
    let number =
        |k: usize, at: usize| cells[at].values.get(k).copied().filter(|value| value.is_finite());
    for (k, before) in before.enumerate() {
        // The first row of data is row 2, as in a CSV file with a header.
        let row = before + 1;
        if let Some(at) = time {
            let si = number(k, at).map(|time| time * columns[at].to_si);
            let t_s = si.and_then(|si| clock.seconds_since_start(si));
            if !taker.accepts_row(row, t_s, clock) {
                continue;
            }
        }
        taker.take_row(row, |position, _| number(k, position).ok_or(CellFault::NotANumber));
    }
}

#[cfg(test)]
#[path = "parquet_file_tests.rs"]
mod tests;

#[cfg(test)]
#[path = "pages_tests.rs"]
mod pages_tests;
