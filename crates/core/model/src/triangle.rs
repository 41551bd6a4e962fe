//! Triangular matrices in documents: one string per row, numbers separated by spaces.

/// Reason for which rows are not a triangle.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TriangleError {
    /// The number of rows is not that of the names.
    #[error("{field}: {rows} rows for {names} names")]
    Rows {
        /// The field with the rows.
        field: &'static str,
        /// Number of rows.
        rows: usize,
        /// Number of names.
        names: usize,
    },
    /// A row has a wrong length, or an entry that is not a number.
    #[error("{field}: row {row} should be {length} finite numbers")]
    Row {
        /// The field with the row.
        field: &'static str,
        /// Number of the row, from 1.
        row: usize,
        /// Required length.
        length: usize,
    },
}

/// Reads as many rows as there are names; `length` returns the required length of a row by its
/// index.
pub fn read_rows(
    field: &'static str,
    rows: &[String],
    names: usize,
    length: impl Fn(usize) -> usize,
) -> Result<Vec<Vec<f64>>, TriangleError> {
    if rows.len() != names {
        return Err(TriangleError::Rows { field, rows: rows.len(), names });
    }
    let row = |(place, text): (usize, &String)| {
        let numbers: Option<Vec<f64>> =
            text.split_whitespace().map(|number| number.parse().ok()).collect();
        let fits = |row: &Vec<f64>| row.len() == length(place) && row.iter().all(|x| x.is_finite());
        numbers.filter(fits).ok_or(TriangleError::Row {
            field,
            row: place + 1,
            length: length(place),
        })
    };
    rows.iter().enumerate().map(row).collect()
}
