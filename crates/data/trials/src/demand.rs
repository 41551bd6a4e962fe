//! Estimate of the memory for reading a trial, before it is read.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use crate::column_reader::ColumnFile;
use crate::containers::archive;

use crate::csv_file;
use crate::declarations::SensorFile;
use crate::mapping::Mapping;
use crate::nmea_file;
use crate::parquet_file;
use crate::samples::GROUP_ROWS;
use crate::trial_file::{InputContent, TrialFile};

/// Bytes in memory for each byte of the footer of a Parquet file: a conservative assumption, since
/// numbers of a few bytes become fields of eight.
const BY_FOOTER: u64 = 12;
/// Bytes in memory for each unpacked byte of a workbook: shared strings of a few bytes take three
/// times as many, and a number of twenty characters becomes eight bytes and its row.
const UNPACKED: u64 = 3;
/// Bytes for every file: buffers, findings, counts of digits.
const EVERY: u64 = 1 << 20;

/// Memory for reading a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MemoryDemand {
    /// Upper bound of the number of rows.
    pub rows: usize,
    /// Number of columns that are kept, time included.
    pub columns: usize,
    /// Bytes of memory, from opening the file to writing its samples.
    pub bytes: u64,
}

/// Returns the memory that [`memory_demand`] itself needs, bytes.
///
/// # Errors
/// Returns an error if the file cannot be read.
pub fn measuring_bytes(path: &Path) -> io::Result<u64> {
    let mut file = File::open(path)?;
    let mut end = [0; 8];
    // A Parquet file ends with the length of its footer (four bytes) and `PAR1`.
    let footer = match file.seek(SeekFrom::End(-8)).and_then(|_| file.read_exact(&mut end)) {
        Ok(()) if end.ends_with(b"PAR1") => {
            u64::from(u32::from_le_bytes([end[0], end[1], end[2], end[3]]))
        }
        _ => 0,
    };
    Ok(EVERY / 4 + BY_FOOTER * footer.min(crate::FileLimits::default().footer_bytes as u64))
}

/// Returns the memory that [`crate::read_trial`] needs for a file, and then
/// [`crate::samples::write_parquet`]. For a file that will be refused, it is the memory needed to
/// find this out.
///
/// # Errors
/// Returns an error if the file cannot be read.
pub fn memory_demand(path: &Path, mapping: &Mapping) -> io::Result<MemoryDemand> {
    let (size, holding) = match TrialFile::open("", path)?.content {
        InputContent::Csv(input) => {
            (csv_file::measure_csv(input, mapping), 4 * mapping.limits.line_bytes as u64)
        }
        InputContent::ParquetFile(file) => parquet_demand(&file, mapping),
        InputContent::ParquetBytes(bytes) => parquet_demand(&bytes, mapping),
        InputContent::Workbook(mut input) => {
            // A damaged archive is refused before anything is unpacked, and needs no memory.
            let claimed = archive::claimed_bytes(&mut input).unwrap_or(0);
            (None, UNPACKED * claimed.min(mapping.limits.unpacked_bytes as u64))
        }
        InputContent::Columns(file) => column_demand(file, mapping),
        InputContent::Nmea(input) => (nmea_file::measure_nmea(input, mapping), 0),
        InputContent::Other(_) => (None, 0),
    };
    let (rows, columns) = size.unwrap_or_default();
    let rows = rows.min(mapping.limits.rows);
    // Per row: the numbers, the row number, the flag of way ahead, and one more column: first the
    // steps of time for their median, later a smoothed column before it replaces the original.
    let row = 8 * columns as u64 + 5 + 8 + derivation_bytes(mapping);
    // A column in compressed form.
    let writing = 8 * rows.min(GROUP_ROWS) as u64;
    Ok(MemoryDemand {
        rows,
        columns,
        bytes: EVERY + measuring_bytes(path)? + holding + rows as u64 * row + writing,
    })
}

/// Returns the memory for a file and the sensor files of the same trial, which are all in memory
/// until they are on one time base.
///
/// # Errors
/// Returns an error if a file cannot be read.
pub fn demand_of_trial(
    path: &Path,
    mapping: &Mapping,
    sensors: &[(SensorFile, PathBuf)],
) -> io::Result<MemoryDemand> {
    let mut whole = memory_demand(path, mapping)?;
    for (sensor, path) in sensors {
        let own = memory_demand(path, &mapping.for_sensor(sensor))?;
        // The columns of the sensor once with its own rows, and once with the rows of the trial.
        whole.bytes += own.bytes + 8 * (own.columns * whole.rows) as u64;
        whole.columns += own.columns;
    }
    Ok(whole)
}

/// Returns the bytes for each row that the derivation of channels needs: a state and its
/// covariance, the smoothed values of three quantities, and values and variances of the result.
fn derivation_bytes(mapping: &Mapping) -> u64 {
    match mapping.declared.derive.len() as u64 {
        0 => 0,
        channels => 8 * (12 + 3 * 4 + 2 + 2 * channels),
    }
}

/// Returns rows and columns of a file of columns, and the memory that its reader holds: whole files
/// are in memory, and those of messages on their own clocks first.
fn column_demand(mut file: ColumnFile, mapping: &Mapping) -> (Option<(usize, usize)>, u64) {
    let holding = file.holding_bytes(mapping.limits);
    (file.measure_table(mapping), holding)
}

fn parquet_demand<R: parquet::file::reader::ChunkReader + 'static>(
    input: &R,
    mapping: &Mapping,
) -> (Option<(usize, usize)>, u64) {
    match parquet_file::measure_parquet(input, mapping) {
        Some((rows, columns, holding)) => (Some((rows, columns)), holding),
        None => (None, 0),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::samples::to_parquet;
    use sistership_model::trial::{Channel, Trial};

    fn at(content: &[u8]) -> MemoryDemand {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), content).unwrap();
        memory_demand(file.path(), &Mapping::with_canonical_names()).unwrap()
    }

    #[test]
    fn rows_and_columns_are_counted_before_they_are_read() {
        let csv = at(b"t_s,u_m_s,note\r\n0,1,a\r\n1,1,b\n2,1,\"c\nd\"\n");
        assert_eq!(csv.columns, 2);
        assert!((3..=6).contains(&csv.rows), "{csv:?}");
        let t_s: Vec<f64> = (0..100_000).map(f64::from).collect();
        let channels =
            [Channel::U, Channel::V, Channel::R].map(|channel| (channel, vec![1.0; t_s.len()]));
        let parquet =
            at(&to_parquet(&Trial { t_s, channels: channels.into(), ..Trial::default() }).unwrap());
        assert_eq!((parquet.rows, parquet.columns), (100_000, 4));
        assert!((100_000 * 45..100_000 * 45 + (6 << 20)).contains(&parquet.bytes), "{parquet:?}");
    }

    #[test]
    fn what_will_be_refused_takes_little() {
        for content in [&b""[..], b"PAR1", b"a,b\n1,2\n", b"PAR1\xff\xff\xff\x7fPAR1"] {
            let demand = at(content);
            assert!(demand.bytes < 32 << 20 && demand.columns == 0, "{demand:?}");
        }
    }
}
