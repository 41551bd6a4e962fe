//! Detection of the format of a file by its first bytes, independent of its name.

use crate::column_formats::{ColumnFormat, is_log_line, is_ros_header};

/// Format of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FormatKind {
    Csv,
    Parquet,
    Workbook,
    Columns(ColumnFormat),
    Nmea,
    /// A format that is not read here: its name, and advice.
    Other(&'static str),
}

/// Number of bytes that are examined.
pub(crate) const LOOKED_AT: usize = 4096;

const COLUMNS: [(&[u8], ColumnFormat); 7] = [
    (b"MATLAB 5.0", ColumnFormat::Matlab),
    (b"MATLAB 7.3", ColumnFormat::Hdf5),
    (b"\x89HDF\r\n\x1a\n", ColumnFormat::Hdf5),
    (b"CDF\x01", ColumnFormat::NetCdf),
    (b"CDF\x02", ColumnFormat::NetCdf),
    (b"CDF\x05", ColumnFormat::NetCdf),
    (b"\x89MCAP0", ColumnFormat::Mcap),
];

const OTHERS: [(&[u8], &str); 14] = [
    (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "an Excel 97-2003 workbook (.xls); save it as .xlsx"),
    (b"%PDF", "a PDF; export its numbers as CSV"),
    (b"\x89PNG", "a picture (PNG); export its numbers as CSV"),
    (b"\xff\xd8\xff", "a picture (JPEG); export its numbers as CSV"),
    (b"GIF8", "a picture (GIF); export its numbers as CSV"),
    (b"\x1f\x8b", "packed by gzip; unpack it"),
    (b"BZh", "packed by bzip2; unpack it"),
    (b"\xfd7zXZ\x00", "packed by xz; unpack it"),
    (b"7z\xbc\xaf\x27\x1c", "a 7-Zip archive; unpack it"),
    (b"\x28\xb5\x2f\xfd", "packed by zstd; unpack it"),
    (
        b"SQLite format 3\0",
        "an SQLite database; write a ROS 2 bag as MCAP (`ros2 bag convert`), export other tables as \
         CSV",
    ),
    (b"#ROSBAG V", "a bag of ROS 1; convert it to MCAP (`mcap convert`)"),
    (b"MDF     ", "an ASAM MDF measurement; export it as CSV or Parquet"),
    (b"TDSm", "a LabVIEW TDMS file; export it as CSV or Parquet"),
];

/// Returns the format of a file by its first bytes.
pub(crate) fn detect_format(start: &[u8]) -> FormatKind {
    if start.starts_with(b"PAR1") {
        return FormatKind::Parquet;
    }
    if start.starts_with(b"PK\x03\x04") {
        return FormatKind::Workbook;
    }
    if let Some((_, format)) = COLUMNS.iter().find(|(magic, _)| start.starts_with(magic)) {
        return FormatKind::Columns(*format);
    }
    if let Some((_, what)) = OTHERS.iter().find(|(magic, _)| start.starts_with(magic)) {
        return FormatKind::Other(what);
    }
    // Known binary formats come first, so that the advice names them.
    if is_binary(start) {
        return FormatKind::Other("binary, of an unknown kind; export it as CSV or Parquet");
    }
    if is_nmea(start) {
        return FormatKind::Nmea;
    }
    if is_gpx(start) {
        return FormatKind::Columns(ColumnFormat::Gpx);
    }
    if is_nmea2000(start) {
        return FormatKind::Columns(ColumnFormat::Nmea2000);
    }
    if is_ros_header(start) {
        return FormatKind::Columns(ColumnFormat::RosCsv);
    }
    FormatKind::Csv
}

/// Returns true for XML whose outer element is `gpx`.
fn is_gpx(start: &[u8]) -> bool {
    let text = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start).trim_ascii_start();
    text.starts_with(b"<") && text.windows(4).any(|window| window == b"<gpx")
}

/// Returns true if most of the first complete lines are frames or messages of NMEA 2000.
fn is_nmea2000(start: &[u8]) -> bool {
    let mut lines = start.split(|&byte| byte == b'\n');
    // The last line may be cut off.
    let cut = if start.len() == LOOKED_AT { lines.next_back() } else { None };
    let lines = lines.filter(|line| Some(*line) != cut && !line.trim_ascii().is_empty()).take(20);
    let is_frame = |line: &[u8]| std::str::from_utf8(line).is_ok_and(is_log_line);
    let (all, frames) = (lines.clone().count(), lines.filter(|line| is_frame(line)).count());
    frames > 0 && 2 * frames > all
}

/// Returns true if more than one byte in sixteen is zero; text in UTF-16, which has more, begins
/// with its mark.
fn is_binary(start: &[u8]) -> bool {
    let marked = start.starts_with(b"\xff\xfe") || start.starts_with(b"\xfe\xff");
    let zeros = start.iter().filter(|byte| **byte == 0).count();
    !marked && 16 * zeros > start.len()
}

/// Returns true if one of the first lines contains a sentence such as `$GPGGA,...*47`, possibly
/// after the logger's own time.
fn is_nmea(start: &[u8]) -> bool {
    start.split(|&byte| byte == b'\n').take(20).any(|line| {
        let Some(at) = line.iter().position(|&byte| byte == b'$') else { return false };
        let sentence = line[at + 1..].trim_ascii_end();
        let Some((address, rest)) = sentence.split_at_checked(5) else { return false };
        let upper = address.iter().all(|byte| byte.is_ascii_uppercase() || byte.is_ascii_digit());
        // Checksum: `*` and two hexadecimal digits at the end.
        let sum = sentence.len().checked_sub(3).map(|end| sentence[end]);
        upper && rest.first() == Some(&b',') && sum == Some(b'*')
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_told_by_their_first_bytes() {
        for (start, wanted) in [
            (&b"PAR1"[..], FormatKind::Parquet),
            (b"PK\x03\x04", FormatKind::Workbook),
            (b"MATLAB 5.0 MAT-file, Platform: GLNXA64", FormatKind::Columns(ColumnFormat::Matlab)),
            (b"\x89HDF\r\n\x1a\n...", FormatKind::Columns(ColumnFormat::Hdf5)),
            (b"<?xml version=\"1.0\"?>\n<gpx>", FormatKind::Columns(ColumnFormat::Gpx)),
            (
                b"(1.0) can0 09F11223#FF1027FF7FFF7FFD\n",
                FormatKind::Columns(ColumnFormat::Nmea2000),
            ),
            (b"$GPHDT,274.1,T*33\r\n", FormatKind::Nmea),
            (b"12:00:01 $GPHDT,274.1,T*33\n", FormatKind::Nmea),
            (b"t_s,u_m_s\n0,1\n", FormatKind::Csv),
            (b"price $,u\n$1,2\n$12345,\n", FormatKind::Csv),
            (b"", FormatKind::Csv),
            (b"\xff\xfet\0_\0s\0", FormatKind::Csv),
        ] {
            assert_eq!(detect_format(start), wanted, "{start:?}");
        }
        assert!(
            matches!(detect_format(b"\x01\0\0\0abc"), FormatKind::Other(what) if what.contains("binary"))
        );
    }
}
