//! Limits on the size of a file.

/// Limits that keep a file from filling the memory of the reader.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FileLimits {
    /// Rows of data in memory at a time; a file of which segments are read may have more.
    pub rows: usize,
    /// Columns, mapped or not.
    pub columns: usize,
    /// Bytes of one row of a CSV file.
    pub line_bytes: usize,
    /// Bytes of one page of a Parquet file, as it is in memory.
    pub page_bytes: usize,
    /// Bytes of the footer of a Parquet file.
    pub footer_bytes: usize,
    /// Unpacked bytes of a workbook or a MATLAB file.
    pub unpacked_bytes: usize,
}

/// Returns the message on a file with more rows than the limit.
pub(crate) fn too_many_rows(most: usize) -> String {
    format!(
        "the file has more rows than the limit of {most}; split it, or let `sistership import` \
         find its segments"
    )
}

impl Default for FileLimits {
    fn default() -> Self {
        Self {
            rows: 5_000_000,
            columns: 200,
            line_bytes: 64 * 1024,
            page_bytes: 16 << 20,
            footer_bytes: 2 << 20,
            unpacked_bytes: 256 << 20,
        }
    }
}
