//! Footer of a Parquet file, checked against the limits before anything is decoded.

use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::containers::pages;
use parquet::errors::{ParquetError, Result as ParquetResult};
use parquet::file::metadata::{ParquetMetaData, ParquetMetaDataReader};
use parquet::file::reader::{ChunkReader, FileReader, SerializedFileReader};
use parquet::schema::types::SchemaDescriptor;

use crate::limits::FileLimits;

/// Runs `work` and converts a panic to an error: the library asserts some properties of a file,
/// which a forged file violates.
pub(crate) fn catch_panics<T>(work: impl FnOnce() -> ParquetResult<T>) -> ParquetResult<T> {
    let contradiction = |_| Err(ParquetError::General("it contradicts itself".into()));
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(contradiction)
}

/// Reason for which a file is not read at all.
#[derive(Debug, thiserror::Error)]
pub(crate) enum FileRefusal {
    #[error("not a valid Parquet file: {0}")]
    Unreadable(String),
    #[error("the footer has {found} bytes, more than the limit of {most}")]
    Footer { found: u64, most: usize },
    #[error(
        "{found} rows are more than the limit of {most}; split the file, or let `sistership \
         import` find its segments"
    )]
    Rows { found: usize, most: usize },
    #[error("{found} columns are more than the limit of {most}")]
    Columns { found: usize, most: usize },
}

impl FileRefusal {
    pub(crate) fn from_error(error: impl ToString) -> Self {
        Self::Unreadable(error.to_string())
    }
}

/// Opens the file and checks it against the limits before any sample is decoded.
pub(crate) fn open_file<R: ChunkReader + 'static>(
    input: R,
    limits: FileLimits,
) -> Result<SerializedFileReader<R>, FileRefusal> {
    checked_metadata(&input, limits)?;
    catch_panics(|| SerializedFileReader::new(input)).map_err(FileRefusal::from_error)
}

/// Returns the metadata of the file, if it is within the limits, and the number of rows.
pub(crate) fn checked_metadata<R: ChunkReader + 'static>(
    input: &R,
    limits: FileLimits,
) -> Result<(ParquetMetaData, usize), FileRefusal> {
    let footer = footer_bytes(input).map_err(FileRefusal::from_error)?;
    if footer > limits.footer_bytes as u64 {
        return Err(FileRefusal::Footer { found: footer, most: limits.footer_bytes });
    }
    // The footer is checked before the library parses it, which trusts its lengths.
    pages::check_footer(input, footer).map_err(FileRefusal::from_error)?;
    let meta = catch_panics(|| ParquetMetaDataReader::new().parse_and_finish(input))
        .map_err(FileRefusal::from_error)?;
    let columns = meta.file_metadata().schema_descr().num_columns();
    let mut chunks = meta.row_groups().iter().flat_map(|group| group.columns());
    if chunks.any(|chunk| {
        chunk.compressed_size() < 0
            || chunk.data_page_offset() < 0
            || chunk.dictionary_page_offset().is_some_and(|at| at < 0)
    }) {
        return Err(FileRefusal::from_error("a column lies outside the file"));
    }
    // The rows of the groups are counted, since these are read; the total of the file is not
    // trusted.
    let groups = meta.row_groups().iter().map(|group| group.num_rows());
    let counted: Option<Vec<usize>> =
        groups.clone().map(|rows| usize::try_from(rows).ok()).collect();
    let counted = counted
        .ok_or_else(|| FileRefusal::from_error("a row group has a negative number of rows"))?;
    let rows = counted.into_iter().fold(0, usize::saturating_add);
    if rows > limits.rows {
        return Err(FileRefusal::Rows { found: rows, most: limits.rows });
    }
    if columns > limits.columns {
        return Err(FileRefusal::Columns { found: columns, most: limits.columns });
    }
    Ok((meta, rows))
}

/// Returns the size of the footer, bytes; the last eight bytes of the file contain it and a mark.
fn footer_bytes<R: ChunkReader>(input: &R) -> ParquetResult<u64> {
    let at = input
        .len()
        .checked_sub(8)
        .ok_or_else(|| ParquetError::General("it is too short".into()))?;
    let end = input.get_bytes(at, 8)?;
    Ok(end.first_chunk().map_or(0, |bytes| u64::from(u32::from_le_bytes(*bytes))))
}

/// Returns the dotted names of the columns of an opened file.
pub(crate) fn header_names<R: ChunkReader + 'static>(
    reader: &SerializedFileReader<R>,
) -> Vec<String> {
    schema_names(reader.metadata().file_metadata().schema_descr())
}

/// Returns the dotted names of the columns of a schema.
pub(crate) fn schema_names(schema: &SchemaDescriptor) -> Vec<String> {
    schema.columns().iter().map(|column| column.path().string()).collect()
}
