//! Readers of files of columns, one a format.

mod candump;
mod cdr;
mod cf_units;
mod gpx;
mod hdf5;
mod mat5;
mod mcap;
mod mcap_records;
mod message_log;
mod netcdf;
mod nmea2000;
mod nmea2000_messages;
mod ros_csv;
mod ros_schema;
mod ros_topics;

use std::io::{self, Read};

use crate::column_source::ColumnSource;
use crate::limits::FileLimits;
use crate::workbook::ReadSeek;

pub(crate) use ros_csv::is_ros_header;

/// Returns true if a line is a frame or a message of NMEA 2000.
pub(crate) fn is_log_line(text: &str) -> bool {
    candump::parse_log_line(text).is_some()
}

/// Format of a file of columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ColumnFormat {
    /// MATLAB 5.
    Matlab,
    /// HDF5, which MATLAB 7.3 and NetCDF-4 are.
    Hdf5,
    /// NetCDF of before version 4.
    NetCdf,
    Gpx,
    /// Logs of NMEA 2000 frames as text.
    Nmea2000,
    Mcap,
    /// CSV with the fields of ROS messages.
    RosCsv,
}

impl ColumnFormat {
    /// Returns true if columns may stand in structures or groups.
    pub(crate) fn is_nested(self) -> bool {
        matches!(self, Self::Matlab | Self::Hdf5)
    }

    /// Returns the name of such a file for messages.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Matlab => "MATLAB file",
            Self::Hdf5 => "HDF5 file",
            Self::NetCdf => "NetCDF file",
            Self::Gpx => "GPX track",
            Self::Nmea2000 => "NMEA 2000 log",
            Self::Mcap => "MCAP log",
            Self::RosCsv => "table of ROS messages",
        }
    }
}

/// Opens a file of columns.
///
/// # Errors
/// Returns an error if the file is damaged or holds more than the limits allow.
pub(crate) fn open_columns<'a>(
    format: ColumnFormat,
    input: Box<dyn ReadSeek + 'a>,
    limits: FileLimits,
) -> io::Result<Box<dyn ColumnSource + 'a>> {
    Ok(match format {
        ColumnFormat::Matlab => Box::new(mat5::Mat5File::open(input, limits)?),
        ColumnFormat::Hdf5 => {
            Box::new(hdf5::Hdf5Columns::open(read_bounded(input, limits)?, limits)?)
        }
        ColumnFormat::NetCdf => {
            Box::new(netcdf::NetCdfColumns::open(read_bounded(input, limits)?, limits)?)
        }
        ColumnFormat::Gpx => Box::new(gpx::read_gpx(input, limits)?),
        ColumnFormat::Nmea2000 => Box::new(nmea2000::read_nmea2000(input, limits)?),
        ColumnFormat::Mcap => Box::new(mcap::read_mcap(input, limits)?),
        ColumnFormat::RosCsv => {
            Box::new(ros_csv::read_ros_csv(&read_bounded(input, limits)?, limits)?)
        }
    })
}

/// Reads a whole file, which may have as many bytes as a workbook unpacked.
fn read_bounded(mut input: impl Read, limits: FileLimits) -> io::Result<Vec<u8>> {
    let most = limits.unpacked_bytes;
    let mut bytes = Vec::new();
    input.by_ref().take(most as u64 + 1).read_to_end(&mut bytes)?;
    if bytes.len() > most {
        let message = format!("it is larger than the {most} bytes that are read; split it");
        return Err(io::Error::other(message));
    }
    Ok(bytes)
}

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
