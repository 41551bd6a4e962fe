//! Reading of files of columns (MATLAB, HDF5, NetCDF, GPX, NMEA 2000, MCAP, tables of ROS messages)
//! into a table.

use std::io::{self, SeekFrom};

use crate::clock::ColumnClock;
use crate::column_formats::{ColumnFormat, open_columns};
use crate::column_parts::{PartColumns, part_names};
use crate::column_source::{ColumnSource, FileColumn};
use crate::findings::Findings;
use crate::limits::FileLimits;
use crate::mapping::Mapping;
use crate::number::CellFault;
use crate::resolve::{HeaderRows, resolve_heading};
use crate::row_sink::RowSink;
use crate::rows::TableBuilder;
use crate::table::{ColumnTarget, Table, TableColumn, memory_columns};
use crate::units::plain_unit;
use crate::workbook::ReadSeek;

/// Bytes in memory for each byte of a file: a line of thirty bytes gives up to three numbers with
/// their times, each twice.
const HELD: u64 = 4;

/// File of columns that is not opened yet.
pub(crate) struct ColumnFile<'a> {
    pub format: ColumnFormat,
    pub input: Box<dyn ReadSeek + 'a>,
}

impl<'a> ColumnFile<'a> {
    /// Reads the mapped columns; rows are counted from 1.
    pub(crate) fn read_table(self, mapping: &Mapping, findings: &mut Findings) -> Option<Table> {
        let format = self.format;
        let unreadable =
            |error: io::Error| format!("the {} cannot be read: {error}", format.name());
        let opened = self.open_part(mapping).map_err(unreadable);
        let mut source = opened.map_err(|message| findings.error(None, None, message)).ok()?;
        let columns = mapped_columns(source.columns(), mapping, findings)?;
        let wanted: Vec<usize> = columns.iter().map(|column| column.index).collect();
        let numbers: usize = wanted.iter().map(|&at| source.columns()[at].length).sum();
        if numbers > mapping.limits.unpacked_bytes / 8 {
            let message = "the columns hold more numbers than are read; split the file";
            findings.error(None, None, message);
            return None;
        }
        let read = source.read_numbers(&wanted).map_err(unreadable);
        let data = read.map_err(|message| findings.error(None, None, message)).ok()?;
        Some(build_table(columns, &data, mapping, findings))
    }

    /// Returns the names and the units of the columns of each part, or of the whole file.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read.
    pub(crate) fn read_headers(self, limits: FileLimits) -> io::Result<Vec<ColumnHeaders>> {
        let nested = self.format.is_nested();
        let mut source = open_columns(self.format, self.input, limits)?;
        let parts = if nested { part_names(source.columns()) } else { Vec::new() };
        if parts.is_empty() {
            if nested {
                source = Box::new(PartColumns::open(source, None)?);
            }
            return Ok(vec![ColumnHeaders::new(None, source.columns())]);
        }
        let mut headers = Vec::new();
        for part in parts {
            let columns = PartColumns::open(source, Some(&part))?;
            headers.push(ColumnHeaders::new(Some(part), columns.columns()));
            source = columns.into_whole();
        }
        Ok(headers)
    }

    /// Opens the declared part, or the whole file if it has none.
    fn open_part(self, mapping: &Mapping) -> io::Result<Box<dyn ColumnSource + 'a>> {
        let (nested, part) = (self.format.is_nested(), mapping.part.as_deref());
        let source = open_columns(self.format, self.input, mapping.limits)?;
        match nested {
            true => Ok(Box::new(PartColumns::open(source, part)?)),
            false => Ok(source),
        }
    }

    /// Returns the bytes that the reader itself holds: the file, or its messages before they are on
    /// one clock.
    pub(crate) fn holding_bytes(&mut self, limits: FileLimits) -> u64 {
        let length = self.input.seek(SeekFrom::End(0)).unwrap_or(0);
        // An error shows when the file is read.
        let _ = self.input.rewind();
        match self.format {
            ColumnFormat::Matlab => 0,
            _ => (HELD * length).min(limits.unpacked_bytes as u64),
        }
    }

    /// Returns the number of rows and of columns in memory at a time; `None` for a file that will
    /// be refused.
    pub(crate) fn measure_table(self, mapping: &Mapping) -> Option<(usize, usize)> {
        let source = self.open_part(mapping).ok()?;
        let columns = mapped_columns(source.columns(), mapping, &mut Findings::default())?;
        let rows = columns.iter().map(|column| source.columns()[column.index].length).max()?;
        // Each column is in memory twice: as read, and in the table.
        Some((rows, 2 * memory_columns(&columns)))
    }
}

/// Names and units of the columns of a file, or of a part of it.
#[derive(Debug)]
pub(crate) struct ColumnHeaders {
    pub part: Option<String>,
    pub names: Vec<String>,
    pub units: Vec<String>,
}

impl ColumnHeaders {
    fn new(part: Option<String>, columns: &[FileColumn]) -> Self {
        let (names, units) = split_header(columns);
        Self { part, names, units }
    }
}

fn split_header(columns: &[FileColumn]) -> (Vec<String>, Vec<String>) {
    let name = |column: &FileColumn| (column.name.clone(), plain_unit(&column.unit).to_owned());
    columns.iter().map(name).unzip()
}

fn build_table(
    columns: Vec<TableColumn>,
    data: &[Vec<f64>],
    mapping: &Mapping,
    findings: &mut Findings,
) -> Table {
    let mut rows = data.iter().map(Vec::len).min().unwrap_or(0);
    // The start of a long file identifies its columns.
    if mapping.unidentified.is_some() {
        rows = rows.min(mapping.limits.rows);
    }
    let mut clock = ColumnClock::from_columns(&columns);
    let mut builder =
        TableBuilder::new(columns, mapping.conventions.missing, findings).with_room(rows);
    (0..rows).for_each(|k| {
        builder.take_row(k + 1, |position, _| {
            Some(data[position][k]).filter(|value| value.is_finite()).ok_or(CellFault::NotANumber)
        });
    });
    let mut table = builder.finish_table();
    clock.rebase_table(&mut table, findings);
    table
}

/// Returns the columns to read, which must be of equal length.
fn mapped_columns(
    offers: &[FileColumn],
    mapping: &Mapping,
    findings: &mut Findings,
) -> Option<Vec<TableColumn>> {
    let (names, units) = split_header(offers);
    let heading = HeaderRows { names: &names, units: &units, row: 1 };
    let columns = resolve_heading(heading, mapping, findings)?;
    if mapping.unidentified.is_some() {
        return Some(keep_common_length(columns, offers));
    }
    let time = columns.iter().find(|column| column.target == ColumnTarget::Time)?;
    let length = offers[time.index].length;
    for column in columns.iter().filter(|column| offers[column.index].length != length) {
        let message = format!(
            "has {} values, but time has {length}; write all variables with the same times, or map \
             only those",
            offers[column.index].length
        );
        findings.error(None, Some(&column.header), message);
    }
    if length > mapping.limits.rows {
        let most = mapping.limits.rows;
        let message = format!("{length} values are more than the limit of {most}; split the file");
        findings.error(None, None, message);
    }
    (!findings.has_errors()).then_some(columns)
}

/// Keeps the columns of the most frequent length.
fn keep_common_length(mut columns: Vec<TableColumn>, offers: &[FileColumn]) -> Vec<TableColumn> {
    let alike = |length: usize| offers.iter().filter(|other| other.length == length).count();
    let length = offers.iter().map(|offer| offer.length).max_by_key(|&length| alike(length));
    columns.retain(|column| Some(offers[column.index].length) == length);
    columns
}
