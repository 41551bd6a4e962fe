//! MATLAB 5 files: vectors and the columns of matrices, named by their variables.

use std::io::{self, Seek};

use crate::column_source::{ColumnSource, FileColumn};
use crate::containers::mat_elements::{NumberArray, visit_arrays};
use crate::limits::FileLimits;
use crate::workbook::ReadSeek;

/// Largest number of columns of a matrix, and of columns of a file.
const MAX_MATRIX_COLUMNS: usize = 200;
const MAX_VARIABLES: usize = 10_000;

/// MATLAB 5 file whose variables are listed.
pub(crate) struct Mat5File<'a> {
    input: Box<dyn ReadSeek + 'a>,
    limits: FileLimits,
    columns: Vec<FileColumn>,
}

impl<'a> Mat5File<'a> {
    /// Lists the variables of a file.
    ///
    /// # Errors
    /// Returns an error if the file is damaged or unpacks to more than the limits allow.
    pub(crate) fn open(mut input: Box<dyn ReadSeek + 'a>, limits: FileLimits) -> io::Result<Self> {
        let columns = list_variables(&mut input, limits)?;
        Ok(Self { input, limits, columns })
    }
}

impl ColumnSource for Mat5File<'_> {
    fn columns(&self) -> &[FileColumn] {
        &self.columns
    }

    fn read_numbers(&mut self, wanted: &[usize]) -> io::Result<Vec<Vec<f64>>> {
        let mut data: Vec<Vec<f64>> = vec![Vec::new(); wanted.len()];
        // Columns are numbered in the order of the file, as in `list_variables`.
        let mut at = 0;
        self.input.rewind()?;
        visit_arrays(&mut self.input, self.limits.unpacked_bytes as u64, &mut |mut array| {
            for _ in 0..column_count(&array) {
                let count = column_length(&array);
                match wanted.iter().position(|&column| column == at) {
                    Some(position) => data[position] = array.read_numbers(count)?,
                    // The numbers must be consumed to reach the next array.
                    None => array.skip_numbers(count)?,
                }
                at += 1;
            }
            Ok(())
        })?;
        Ok(data)
    }
}

fn list_variables(
    input: &mut Box<dyn ReadSeek + '_>,
    limits: FileLimits,
) -> io::Result<Vec<FileColumn>> {
    let mut offers = Vec::new();
    input.rewind()?;
    visit_arrays(input, limits.unpacked_bytes as u64, &mut |array| {
        let columns = column_count(&array);
        for column in 0..columns {
            if offers.len() == MAX_VARIABLES {
                return Err(io::Error::other("it has more columns than are read"));
            }
            let whole = array.rows == 1 || array.columns == 1;
            let name = match whole {
                true => array.name.clone(),
                false => format!("{}(:,{})", array.name, column + 1),
            };
            offers.push(FileColumn { name, unit: String::new(), length: column_length(&array) });
        }
        Ok(())
    })?;
    Ok(offers)
}

/// Returns the number of columns of an array: one of a vector, those of a matrix, none of a single
/// number.
fn column_count(array: &NumberArray) -> usize {
    match (array.rows, array.columns) {
        (0, _) | (_, 0) | (1, 1) => 0,
        (1, _) | (_, 1) => 1,
        (_, columns) if columns <= MAX_MATRIX_COLUMNS => columns,
        _ => 0,
    }
}

fn column_length(array: &NumberArray) -> usize {
    if array.rows == 1 { array.columns } else { array.rows }
}

#[cfg(test)]
#[path = "mat5_tests.rs"]
mod tests;
