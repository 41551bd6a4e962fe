//! How large a file may be.

/// Bounds that keep a file from filling the memory of whoever reads it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Rows of data.
    pub rows: usize,
    /// Columns, mapped or not.
    pub columns: usize,
    /// Bytes of one row of a CSV file.
    pub line_bytes: usize,
    /// Bytes of one page of a Parquet file, as it is in memory.
    pub page_bytes: usize,
    /// Bytes of what a Parquet file says of itself at its end.
    pub footer_bytes: usize,
    /// Bytes that a workbook or a MATLAB file may hold when it is unpacked.
    pub unpacked_bytes: usize,
}

impl Default for Limits {
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
