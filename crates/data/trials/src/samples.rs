//! Trials in canonical form: Parquet for storage, CSV for export.
//!
//! The Parquet file has one DOUBLE column per channel under its canonical name, `t_s` first, and no
//! nulls. The other data of a trial (name, manoeuvre, depth, velocity frame, warnings) are one JSON
//! text in the file's key-value metadata, so that the trial is read back unchanged. The same trial
//! gives the same bytes: there is no time stamp, the writer's name is fixed, and compression runs
//! on one thread.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Write;
use std::sync::Arc;

use bytes::Bytes;
use parquet::basic::{Compression, Encoding, Repetition, Type as Physical, ZstdLevel};
use parquet::data_type::DoubleType;
use parquet::errors::{ParquetError, Result as ParquetResult};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use serde::{Deserialize, Serialize};
use sistership_model::manifest::VelocityFrame;
use sistership_model::trial::{Channel, Finding, Trial};

use crate::limits::FileLimits;
use crate::parquet_cells::{BATCH, ColumnCells};
use crate::parquet_footer;

/// Key of the metadata.
const KEY: &str = "sistership.trial";
/// Canonical name of time.
const TIME: &str = "t_s";
/// Number of rows that are compressed and decoded together.
pub(crate) const GROUP_ROWS: usize = 1 << 20;

/// Error in writing or reading samples.
#[derive(Debug, thiserror::Error)]
pub enum SamplesError {
    /// The Parquet library returns an error, or the file is damaged.
    #[error("Parquet samples: {0}")]
    Parquet(#[from] ParquetError),
    /// The CSV cannot be written.
    #[error("CSV samples: {0}")]
    Csv(#[from] csv::Error),
    /// The samples are no canonical trial.
    #[error("samples: {0}")]
    Content(String),
}

/// Data of a trial other than its samples.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct TrialMetadata {
    name: String,
    manoeuvre: Option<String>,
    depth_m: Option<f64>,
    velocity: VelocityFrame,
    warnings: Vec<Finding>,
}

/// Returns the trial as Parquet, without loss.
///
/// # Errors
/// Returns an error if a channel and time differ in length, or if the library fails.
pub fn to_parquet(trial: &Trial) -> Result<Vec<u8>, SamplesError> {
    let mut bytes = Vec::new();
    write_parquet(&mut bytes, trial)?;
    Ok(bytes)
}

/// Writes the trial as [`to_parquet`] does, to a writer.
///
/// # Errors
/// Returns the errors of [`to_parquet`], and those of the writer.
pub fn write_parquet(out: impl Write + Send, trial: &Trial) -> Result<(), SamplesError> {
    let columns = trial_columns(trial)?;
    let schema = parquet_schema(columns.iter().map(|(name, _)| *name))?;
    let mut writer = SerializedFileWriter::new(out, schema, Arc::new(writer_properties(trial)?))?;
    for start in (0..trial.len()).step_by(GROUP_ROWS) {
        let rows = start..(start + GROUP_ROWS).min(trial.len());
        let mut group = writer.next_row_group()?;
        for (_, values) in &columns {
            write_column(&mut group, &values[rows.clone()])?;
        }
        group.close()?;
    }
    writer.close()?;
    Ok(())
}

/// Reads a trial that [`to_parquet`] wrote.
///
/// # Errors
/// Returns an error if the file is damaged, too large, or not written by [`to_parquet`].
pub fn from_parquet(bytes: Bytes) -> Result<Trial, SamplesError> {
    let reader = parquet_footer::open_file(bytes, FileLimits::default())
        .map_err(|refused| SamplesError::Content(refused.to_string()))?;
    let TrialMetadata { name, manoeuvre, depth_m, velocity, warnings } = read_metadata(&reader)?;
    let mut trial = Trial { name, manoeuvre, depth_m, velocity, warnings, ..Trial::default() };
    let mut columns = parquet_footer::catch_panics(|| read_columns(&reader))?;
    trial.t_s =
        columns.remove(TIME).ok_or_else(|| SamplesError::Content(format!("no column `{TIME}`")))?;
    for (name, values) in columns {
        let channel = Channel::by_column(&name)
            .ok_or_else(|| SamplesError::Content(format!("unknown column `{name}`")))?;
        trial.channels.insert(channel, values);
    }
    Ok(trial)
}

/// Writes the trial as CSV: canonical names, every number in the shortest form that reads back to
/// the same value.
///
/// # Errors
/// Returns an error if a channel and time differ in length, or if the writer fails.
pub fn to_csv(writer: impl Write, trial: &Trial) -> Result<(), SamplesError> {
    let columns = trial_columns(trial)?;
    let mut writer = csv::Writer::from_writer(writer);
    writer.write_record(columns.iter().map(|(name, _)| *name))?;
    let mut row = Vec::with_capacity(columns.len());
    for k in 0..trial.len() {
        row.clear();
        row.extend(columns.iter().map(|(_, values)| values[k]));
        writer.serialize(&row)?;
    }
    writer.flush().map_err(csv::Error::from)?;
    Ok(())
}

/// Returns name and samples of every column, in the order of the channels.
fn trial_columns(trial: &Trial) -> Result<Vec<(&'static str, &[f64])>, SamplesError> {
    let mut columns = vec![(TIME, trial.t_s.as_slice())];
    for (channel, values) in &trial.channels {
        if values.len() != trial.len() {
            let message =
                format!("{channel} has {} samples, time has {}", values.len(), trial.len());
            return Err(SamplesError::Content(message));
        }
        columns.push((channel.column_name(), values.as_slice()));
    }
    Ok(columns)
}

fn parquet_schema(names: impl Iterator<Item = &'static str>) -> ParquetResult<Arc<Type>> {
    let column = |name| {
        Type::primitive_type_builder(name, Physical::DOUBLE)
            .with_repetition(Repetition::REQUIRED)
            .build()
            .map(Arc::new)
    };
    let fields = names.map(column).collect::<ParquetResult<_>>()?;
    Type::group_type_builder("trial").with_fields(fields).build().map(Arc::new)
}

fn writer_properties(trial: &Trial) -> Result<WriterProperties, SamplesError> {
    let about = TrialMetadata {
        name: trial.name.clone(),
        manoeuvre: trial.manoeuvre.clone(),
        depth_m: trial.depth_m,
        velocity: trial.velocity,
        warnings: trial.warnings.clone(),
    };
    let text =
        serde_json::to_string(&about).map_err(|error| SamplesError::Content(error.to_string()))?;
    Ok(WriterProperties::builder()
        // Without a version, so that the same trial gives the same bytes.
        .set_created_by("sistership".into())
        .set_compression(Compression::ZSTD(ZstdLevel::try_new(3)?))
        // Neighbouring samples share sign, exponent and leading digits: split by byte they compress
        // well.
        .set_encoding(Encoding::BYTE_STREAM_SPLIT)
        .set_dictionary_enabled(false)
        .set_statistics_enabled(EnabledStatistics::None)
        .set_key_value_metadata(Some(vec![KeyValue::new(KEY.to_owned(), text)]))
        .build())
}

fn write_column<W: Write + Send>(
    group: &mut parquet::file::writer::SerializedRowGroupWriter<'_, W>,
    values: &[f64],
) -> ParquetResult<()> {
    let missing = || ParquetError::General("more columns than the schema has".into());
    let mut column = group.next_column()?.ok_or_else(missing)?;
    column.typed::<DoubleType>().write_batch(values, None, None)?;
    column.close()
}

fn read_metadata(reader: &SerializedFileReader<Bytes>) -> Result<TrialMetadata, SamplesError> {
    let metadata = reader.metadata().file_metadata().key_value_metadata();
    let text = metadata
        .into_iter()
        .flatten()
        .find(|entry| entry.key == KEY)
        .and_then(|entry| entry.value.as_deref());
    let text = text.ok_or_else(|| {
        SamplesError::Content(format!("no metadata `{KEY}`; not written by Sistership"))
    })?;
    serde_json::from_str(text)
        .map_err(|error| SamplesError::Content(format!("metadata `{KEY}`: {error}")))
}

fn read_columns(reader: &SerializedFileReader<Bytes>) -> ParquetResult<BTreeMap<String, Vec<f64>>> {
    let (names, groups) = (parquet_footer::header_names(reader), reader.metadata().row_groups());
    // The total was checked against the limits when the file was opened.
    let rows: i64 = groups.iter().map(|group| group.num_rows()).sum();
    let mut columns: Vec<Vec<f64>> =
        names.iter().map(|_| Vec::with_capacity(usize::try_from(rows).unwrap_or(0))).collect();
    for index in 0..reader.num_row_groups() {
        let group = reader.get_row_group(index)?;
        let rows = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
        for (position, column) in columns.iter_mut().enumerate() {
            let mut cells = ColumnCells::new(&*group, position)?;
            for start in (0..rows).step_by(BATCH) {
                cells.read_next(BATCH.min(rows - start))?;
                column.extend_from_slice(&cells.values);
            }
        }
    }
    Ok(names.into_iter().zip(columns).collect())
}

/// Reader that returns the samples of a file of [`to_parquet`] as CSV, in pieces of some rows.
pub struct CsvPieces {
    reader: SerializedFileReader<File>,
    names: Vec<String>,
    /// Index of the next row group.
    group: usize,
    /// Columns of the current row group.
    cells: Vec<ColumnCells>,
    left: usize,
    has_begun: bool,
}

/// Number of rows of a piece.
const PIECE_ROWS: usize = 1024;

impl CsvPieces {
    /// Opens a file.
    ///
    /// # Errors
    /// Returns an error if the file is damaged or too large.
    pub fn open(file: File) -> Result<Self, SamplesError> {
        let reader = parquet_footer::open_file(file, FileLimits::default())
            .map_err(|refused| SamplesError::Content(refused.to_string()))?;
        let names = parquet_footer::header_names(&reader);
        Ok(Self { reader, names, group: 0, cells: Vec::new(), left: 0, has_begun: false })
    }

    /// Returns the next lines; `None` after the last.
    ///
    /// # Errors
    /// Returns an error if the file is damaged.
    pub fn next_piece(&mut self) -> Result<Option<Vec<u8>>, SamplesError> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        // The header is part of the first piece.
        if !self.has_begun {
            self.has_begun = true;
            writer.write_record(&self.names)?;
        }
        let rows = parquet_footer::catch_panics(|| self.decode_rows())?;
        let mut row = Vec::with_capacity(self.cells.len());
        for k in 0..rows {
            row.clear();
            row.extend(self.cells.iter().map(|cells| cells.values[k]));
            writer.serialize(&row)?;
        }
        let text = writer.into_inner().map_err(|error| SamplesError::Content(error.to_string()))?;
        Ok((!text.is_empty()).then_some(text))
    }

    /// Decodes the next rows, and returns their number.
    fn decode_rows(&mut self) -> ParquetResult<usize> {
        // Empty row groups are skipped.
        while self.left == 0 {
            if self.group == self.reader.num_row_groups() {
                return Ok(0);
            }
            let group = self.reader.get_row_group(self.group)?;
            self.cells = (0..self.names.len())
                .map(|column| ColumnCells::new(&*group, column))
                .collect::<Result<_, _>>()?;
            self.left = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
            self.group += 1;
        }
        let rows = PIECE_ROWS.min(self.left);
        self.cells.iter_mut().try_for_each(|cells| cells.read_next(rows))?;
        self.left -= rows;
        Ok(rows)
    }
}

#[cfg(test)]
#[path = "samples_tests.rs"]
mod tests;
