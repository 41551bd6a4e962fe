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
}

impl Default for Limits {
    fn default() -> Self {
        Self { rows: 5_000_000, columns: 200, line_bytes: 64 * 1024 }
    }
}
