//! The columns that are to be identified.

/// A column of a file.
#[derive(Debug, Clone, Default)]
pub struct ColumnData {
    /// The header, or `#3` for the third column of a file without one.
    pub header: String,
    /// Cell of the row of units below the header.
    pub below: Option<String>,
    /// One value for each row; NaN where the cell contains no number.
    pub values: Vec<f64>,
    /// For times that are written as text or as days of a sheet: their unit in manifests. The
    /// values are then seconds.
    pub written_time: Option<&'static str>,
}

/// A part of a recording that is large enough to identify its columns.
#[derive(Debug, Clone, Default)]
pub struct RecordingSample {
    /// Its columns, of equal length.
    pub columns: Vec<ColumnData>,
    /// Row indices at which the recording is interrupted: the rows before such a row are not
    /// adjacent to it in time.
    pub breaks: Vec<usize>,
}

impl RecordingSample {
    /// The number of rows.
    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, |column| column.values.len())
    }

    /// Returns true if the recording has no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
