//! Triangular matrices as documents write them: a row in a line, numbers separated by spaces.

/// Why rows are no triangle.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TriangleError {
    /// There are not as many rows as names.
    #[error("{field}: {rows} rows for {names} names")]
    Rows {
        /// The field that has them.
        field: &'static str,
        /// How many there are.
        rows: usize,
        /// How many names.
        names: usize,
    },
    /// A row is not as long as it should be, or not of numbers.
    #[error("{field}: row {row} should be {length} finite numbers")]
    Row {
        /// The field that has it.
        field: &'static str,
        /// Its number, from 1.
        row: usize,
        /// How long it should be.
        length: usize,
    },
}

/// Reads as many rows as there are names; `length` says how long each is, by its place.
pub fn read(
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
