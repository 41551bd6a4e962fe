//! Aligned text tables.

use std::fmt;

/// Table: columns of numbers are aligned right, others left.
#[derive(Debug, Default)]
pub struct TextTable {
    rows: Vec<Vec<String>>,
}

impl TextTable {
    /// Creates a table with a header.
    pub fn new<const N: usize>(header: [&str; N]) -> Self {
        Self { rows: vec![header.map(str::to_owned).to_vec()] }
    }

    /// Creates a table with a header of any number of columns.
    pub fn with_columns<'a>(header: impl Iterator<Item = &'a str>) -> Self {
        Self { rows: vec![header.map(str::to_owned).collect()] }
    }

    /// Adds a row.
    pub fn add_row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    fn column_width(&self, column: usize) -> usize {
        self.rows
            .iter()
            .filter_map(|row| row.get(column))
            .map(|cell| cell.chars().count())
            .max()
            .unwrap_or(0)
    }

    /// True if every cell below the header is a number, `-` or empty.
    fn is_numeric(&self, column: usize) -> bool {
        let numeric = |cell: &String| {
            cell.trim_end_matches([' ', '%']).parse::<f64>().is_ok()
                || matches!(cell.as_str(), "-" | "")
        };
        self.rows.iter().skip(1).filter_map(|row| row.get(column)).all(numeric)
    }
}

impl fmt::Display for TextTable {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Rows may have fewer cells than the header; missing cells at the end are not printed.
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let layout: Vec<(usize, bool)> = (0..columns)
            .map(|column| (self.column_width(column), self.is_numeric(column)))
            .collect();
        for row in &self.rows {
            let cell = |(cell, (width, numeric)): (&String, &(usize, bool))| {
                if *numeric { format!("{cell:>width$}") } else { format!("{cell:<width$}") }
            };
            let cells: Vec<String> = row.iter().zip(&layout).map(cell).collect();
            writeln!(out, "  {}", cells.join("  ").trim_end())?;
        }
        Ok(())
    }
}

/// Formats a number with four significant digits.
pub fn format_number(value: f64) -> String {
    if !value.is_finite() || value == f64::MAX {
        return "-".to_owned();
    }
    let size = value.abs();
    if size == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e6).contains(&size) {
        return format!("{value:.3e}");
    }
    // Four significant digits: 3 - floor(log10 |x|) decimals.
    let decimals = (3.0 - size.log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{value:.decimals$}")
}

/// Formats a number that may be unknown.
pub fn format_optional(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), format_number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_aligned_by_what_they_hold() {
        let mut table = TextTable::new(["ship", "correlation", "note"]);
        table.add_row(["pcc".to_owned(), "-0.7".to_owned(), "a".to_owned()]);
        table.add_row(["mariner".to_owned(), "-".to_owned(), String::new()]);
        assert_eq!(
            table.to_string(),
            "  ship     correlation  note\n  pcc             -0.7  a\n  mariner            -\n"
        );
    }

    #[test]
    fn numbers_keep_four_digits() {
        let written = [0.0, 12.3456, 0.0012346, 1234.56, 5e-7, f64::MAX, f64::NAN, -0.5763]
            .map(format_number);
        assert_eq!(written, ["0", "12.35", "0.001235", "1235", "5.000e-7", "-", "-", "-0.5763"]);
    }
}
