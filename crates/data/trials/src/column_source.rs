//! Interface of files that hold whole columns of numbers, such as MATLAB and HDF5.

use std::io;

/// Column of a file.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct FileColumn {
    pub name: String,
    /// Unit as the file states it; empty if it states none.
    pub unit: String,
    /// Number of values.
    pub length: usize,
}

/// File of columns, which need not have the same length.
pub(crate) trait ColumnSource {
    /// Returns the columns in the order of the file.
    fn columns(&self) -> &[FileColumn];

    /// Returns the numbers of the columns with the given indices; NaN where there is none.
    ///
    /// # Errors
    /// Returns an error if the file is damaged or holds more than the limits allow.
    fn read_numbers(&mut self, wanted: &[usize]) -> io::Result<Vec<Vec<f64>>>;
}

/// Columns that are in memory.
#[derive(Debug, Default)]
pub(crate) struct MemoryColumns {
    columns: Vec<FileColumn>,
    numbers: Vec<Vec<f64>>,
}

impl MemoryColumns {
    pub(crate) fn push_column(&mut self, name: String, unit: &str, numbers: Vec<f64>) {
        self.columns.push(FileColumn { name, unit: unit.to_owned(), length: numbers.len() });
        self.numbers.push(numbers);
    }
}

impl ColumnSource for MemoryColumns {
    fn columns(&self) -> &[FileColumn] {
        &self.columns
    }

    fn read_numbers(&mut self, wanted: &[usize]) -> io::Result<Vec<Vec<f64>>> {
        // Each column is read once: its numbers are moved out.
        Ok(wanted.iter().map(|&at| std::mem::take(&mut self.numbers[at])).collect())
    }
}
