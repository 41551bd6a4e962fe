//! MATLAB 5 files: vectors and the columns of matrices, named by their variables.

use std::io::{self, Seek};

use crate::clock::ColumnClock;
use crate::containers::mat_elements::{NumberArray, visit_arrays};
use crate::findings::Findings;
use crate::limits::FileLimits;
use crate::mapping::Mapping;
use crate::number::CellFault;
use crate::resolve::resolve_headers;
use crate::row_sink::RowSink;
use crate::rows::TableBuilder;
use crate::table::{ColumnTarget, Table, TableColumn, memory_columns};
use crate::workbook::ReadSeek;

/// Largest number of columns of a matrix, and of columns of a file.
const MAX_MATRIX_COLUMNS: usize = 200;
const MAX_VARIABLES: usize = 10_000;

/// Column of a file: a vector, or a column of a matrix.
struct MatVariable {
    name: String,
    length: usize,
}

/// Reads the mapped columns; rows are counted from 1, as in MATLAB.
pub(crate) fn read_mat(
    mut input: Box<dyn ReadSeek + '_>,
    mapping: &Mapping,
    findings: &mut Findings,
) -> Option<Table> {
    let columns = mapped_columns(&mut input, mapping, findings)?;
    let limits = mapping.limits;
    let mut data: Vec<Option<Vec<f64>>> = vec![None; columns.len()];
    // Columns are numbered in the order of the file, as in `list_variables`.
    let mut at = 0;
    let read = input.rewind().and_then(|()| {
        visit_arrays(&mut input, limits.unpacked_bytes as u64, &mut |mut array| {
            for _ in 0..column_count(&array) {
                let wanted = columns.iter().position(|column| column.index == at);
                let count = column_length(&array);
                match wanted {
                    Some(position) => data[position] = Some(array.read_numbers(count)?),
                    // The numbers must be consumed to reach the next array.
                    None => array.skip_numbers(count)?,
                }
                at += 1;
            }
            Ok(())
        })
    });
    if let Err(error) = read {
        findings.error(None, None, damage_message(&error));
        return None;
    }
    let data: Vec<Vec<f64>> = data.into_iter().map(Option::unwrap_or_default).collect();
    let rows = data.iter().map(Vec::len).min().unwrap_or(0);
    let mut clock = ColumnClock::from_columns(&columns);
    let mut builder =
        TableBuilder::new(columns, mapping.conventions.missing, findings).with_room(rows);
    (0..rows).for_each(|k| {
        builder.take_row(k + 1, |position, _| {
            Some(data[position][k]).filter(|value| value.is_finite()).ok_or(CellFault::NotANumber)
        });
    });
    let mut table = builder.finish_table();
    clock.rebase_table(&mut table, findings);
    Some(table)
}

/// Returns the number of rows and of columns in memory at a time; `None` for a file that will be
/// refused.
pub(crate) fn measure_mat(
    mut input: Box<dyn ReadSeek + '_>,
    mapping: &Mapping,
) -> Option<(usize, usize)> {
    let offers = list_variables(&mut input, mapping.limits).ok()?;
    let columns = mapped_columns(&mut input, mapping, &mut Findings::default())?;
    let rows = columns.iter().map(|column| offers[column.index].length).max()?;
    // Each column is in memory twice: as read, and in the table.
    Some((rows, 2 * memory_columns(&columns)))
}

/// Returns the columns to read, which must be of equal length.
fn mapped_columns(
    input: &mut Box<dyn ReadSeek + '_>,
    mapping: &Mapping,
    findings: &mut Findings,
) -> Option<Vec<TableColumn>> {
    let offers = input.rewind().and_then(|()| list_variables(input, mapping.limits));
    let offers = offers.map_err(|error| findings.error(None, None, damage_message(&error))).ok()?;
    let names: Vec<String> = offers.iter().map(|offer| offer.name.clone()).collect();
    let columns = resolve_headers(&names, mapping, findings)?;
    if mapping.unidentified.is_some() {
        return Some(keep_common_length(columns, &offers));
    }
    let time = columns.iter().find(|column| column.target == ColumnTarget::Time)?;
    let length = offers[time.index].length;
    for column in columns.iter().filter(|column| offers[column.index].length != length) {
        let message = format!(
            "has {} values, but time has {length}; write all variables with the same times, or \
             map only those with the same times",
            offers[column.index].length
        );
        findings.error(None, Some(&column.header), message);
    }
    if length > mapping.limits.rows {
        let most = mapping.limits.rows;
        let message = format!("{length} values are more than the limit of {most}; split the file");
        findings.error(None, None, message);
    }
    (!findings.has_errors()).then_some(columns)
}

/// Keeps the columns of the most frequent length.
fn keep_common_length(mut columns: Vec<TableColumn>, offers: &[MatVariable]) -> Vec<TableColumn> {
    let alike = |length: usize| offers.iter().filter(|other| other.length == length).count();
    let length = offers.iter().map(|offer| offer.length).max_by_key(|&length| alike(length));
    columns.retain(|column| Some(offers[column.index].length) == length);
    columns
}

/// Returns the names of the columns of a file.
pub(crate) fn column_names(
    mut input: Box<dyn ReadSeek + '_>,
    limits: FileLimits,
) -> io::Result<Vec<String>> {
    Ok(list_variables(&mut input, limits)?.into_iter().map(|offer| offer.name).collect())
}

fn list_variables(
    input: &mut Box<dyn ReadSeek + '_>,
    limits: FileLimits,
) -> io::Result<Vec<MatVariable>> {
    let mut offers = Vec::new();
    input.rewind()?;
    visit_arrays(input, limits.unpacked_bytes as u64, &mut |array| {
        let columns = column_count(&array);
        for column in 0..columns {
            if offers.len() == MAX_VARIABLES {
                return Err(io::Error::other("it has too many columns"));
            }
            let whole = array.rows == 1 || array.columns == 1;
            let name = match whole {
                true => array.name.clone(),
                false => format!("{}(:,{})", array.name, column + 1),
            };
            offers.push(MatVariable { name, length: column_length(&array) });
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

fn damage_message(error: &io::Error) -> String {
    format!("the MATLAB file cannot be read: {error}")
}

#[cfg(test)]
#[path = "mat_file_tests.rs"]
mod tests;
