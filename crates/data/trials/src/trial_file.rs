//! Input files of trials.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use bytes::Bytes;

use crate::column_reader::ColumnFile;
use crate::declarations::SensorFile;
use crate::magic::{self, FormatKind, LOOKED_AT};
use crate::mapping::Mapping;
use crate::text_decoder::TextDecoder;
use crate::workbook::ReadSeek;

/// Input file: its name, which every message mentions, and its bytes.
pub struct TrialFile<'a> {
    pub(crate) name: String,
    pub(crate) content: InputContent<'a>,
    pub(crate) sensors: Vec<SensorInput<'a>>,
}

/// File with further channels of the same trial.
pub(crate) struct SensorInput<'a> {
    pub name: String,
    pub content: InputContent<'a>,
    pub mapping: Mapping,
    pub clock_offset_s: Option<f64>,
}

pub(crate) enum InputContent<'a> {
    Csv(Box<dyn Read + 'a>),
    ParquetBytes(Bytes),
    ParquetFile(File),
    Workbook(Box<dyn ReadSeek + 'a>),
    Nmea(Box<dyn ReadSeek + 'a>),
    Columns(ColumnFile<'a>),
    /// A format that is not read: its name, and advice.
    Other(&'static str),
}

impl InputContent<'_> {
    /// Returns true if such a file may have parts: sheets, structures or groups.
    pub(crate) fn has_parts(&self) -> bool {
        match self {
            Self::Workbook(_) => true,
            Self::Columns(file) => file.format.is_nested(),
            _ => false,
        }
    }
}

impl<'a> TrialFile<'a> {
    /// Creates an input file of CSV from any reader, streamed row by row.
    pub fn from_csv(name: impl Into<String>, reader: impl Read + 'a) -> Self {
        let text = TextDecoder::new(reader);
        Self::without_sensors(name.into(), InputContent::Csv(Box::new(text)))
    }

    /// Creates an input file of Parquet in memory.
    pub fn from_parquet(name: impl Into<String>, bytes: Bytes) -> Self {
        Self::without_sensors(name.into(), InputContent::ParquetBytes(bytes))
    }

    /// Creates an input file in memory, whose format is detected by its first bytes, independent of
    /// its name.
    pub fn from_bytes(name: impl Into<String>, bytes: Bytes) -> Self {
        match magic::detect_format(&bytes[..bytes.len().min(LOOKED_AT)]) {
            FormatKind::Parquet => Self::from_parquet(name, bytes),
            kind => Self::from_format(kind, name.into(), io::Cursor::new(bytes)),
        }
    }

    fn from_format(kind: FormatKind, name: String, input: impl Read + Seek + 'a) -> Self {
        let input = Box::new(input);
        let content = match kind {
            FormatKind::Workbook => InputContent::Workbook(input),
            FormatKind::Columns(format) => InputContent::Columns(ColumnFile { format, input }),
            FormatKind::Nmea => InputContent::Nmea(input),
            FormatKind::Other(what) => InputContent::Other(what),
            _ => InputContent::Csv(Box::new(TextDecoder::new(input))),
        };
        Self::without_sensors(name, content)
    }

    fn without_sensors(name: String, content: InputContent<'a>) -> Self {
        Self { name, content, sensors: Vec::new() }
    }

    /// Adds a file of further channels with a mapping of its own. Its readings are interpolated to
    /// the times of this file; its clock agrees with that of this file once the offset is added
    /// and, where both files have them, dates and times of day are compared.
    pub fn with_sensor(
        mut self,
        other: Self,
        mapping: Mapping,
        clock_offset_s: Option<f64>,
    ) -> Self {
        let Self { name, content, .. } = other;
        self.sensors.push(SensorInput { name, content, mapping, clock_offset_s });
        self
    }

    /// Opens a file on disk with the files of sensors that belong to the same trial.
    ///
    /// # Errors
    /// Returns an error if a file cannot be opened or read, with the name of a sensor's file.
    pub fn open_trial(
        name: impl Into<String>,
        path: &Path,
        mapping: &Mapping,
        sensors: &[(SensorFile, PathBuf)],
    ) -> io::Result<Self> {
        let mut source = Self::open(name, path)?;
        for (sensor, path) in sensors {
            let named = |error| io::Error::other(format!("{}: {error}", sensor.file));
            let other = Self::open(&sensor.file, path).map_err(named)?;
            source = source.with_sensor(other, mapping.for_sensor(sensor), sensor.clock_offset_s);
        }
        Ok(source)
    }

    /// Opens a file on disk, which is streamed and whose format is detected by its first bytes.
    ///
    /// # Errors
    /// Returns an error if the file cannot be opened or read.
    pub fn open(name: impl Into<String>, path: &Path) -> io::Result<Self> {
        let mut file = File::open(path)?;
        let mut start = Vec::new();
        file.by_ref().take(LOOKED_AT as u64).read_to_end(&mut start)?;
        // The start is read again with the rest of the file.
        file.seek(SeekFrom::Start(0))?;
        let name = name.into();
        Ok(match magic::detect_format(&start) {
            // Parquet is read by offset, other formats through a buffer.
            FormatKind::Parquet => Self::without_sensors(name, InputContent::ParquetFile(file)),
            kind => Self::from_format(kind, name, BufReader::new(file)),
        })
    }
}
