//! MATLAB 5 files: vectors and the columns of matrices, named by their variables.

use std::io::{self, Seek};

use crate::clock::Clock;
use crate::containers::mat_elements::{Array, visit};
use crate::findings::Findings;
use crate::limits::Limits;
use crate::mapping::Mapping;
use crate::number::Fault;
use crate::resolve::resolve;
use crate::rows::Builder;
use crate::table::{Column, Table, Target, width};
use crate::taker::Taker;
use crate::workbook::ReadSeek;

/// Largest number of columns of a matrix, and of columns of a file.
const WIDE: usize = 200;
const OFFERED: usize = 10_000;

/// Column of a file: a vector, or a column of a matrix.
struct Offer {
    name: String,
    length: usize,
}

/// Reads the mapped columns; rows are counted from 1, as in MATLAB.
pub(crate) fn read(
    mut input: Box<dyn ReadSeek + '_>,
    mapping: &Mapping,
    findings: &mut Findings,
) -> Option<Table> {
    let columns = mapped(&mut input, mapping, findings)?;
    let limits = mapping.limits;
    let mut data: Vec<Option<Vec<f64>>> = vec![None; columns.len()];
    // Columns are numbered in the order of the file, as in `list_variables`.
    let mut at = 0;
    let read = input.rewind().and_then(|()| {
        visit(&mut input, limits.unpacked_bytes as u64, &mut |mut array| {
            for _ in 0..offered(&array) {
                let wanted = columns.iter().position(|column| column.index == at);
                let count = length(&array);
                match wanted {
                    Some(position) => data[position] = Some(array.numbers(count)?),
                    // The numbers must be consumed to reach the next array.
                    None => array.skip(count)?,
                }
                at += 1;
            }
            Ok(())
        })
    });
    if let Err(error) = read {
        findings.error(None, None, damaged(&error));
        return None;
    }
    let data: Vec<Vec<f64>> = data.into_iter().map(Option::unwrap_or_default).collect();
    let rows = data.iter().map(Vec::len).min().unwrap_or(0);
    let mut clock = Clock::of(&columns);
    let mut builder = Builder::new(columns, mapping.conventions.missing, findings).with_room(rows);
    (0..rows).for_each(|k| {
        builder.row(k + 1, |position, _| {
            Some(data[position][k]).filter(|value| value.is_finite()).ok_or(Fault::NotANumber)
        });
    });
    let mut table = builder.finish();
    clock.finish(&mut table, findings);
    Some(table)
}

/// Returns the number of rows and of columns in memory at a time; `None` for a file that will be
/// refused.
pub(crate) fn measure(
    mut input: Box<dyn ReadSeek + '_>,
    mapping: &Mapping,
) -> Option<(usize, usize)> {
    let offers = offers(&mut input, mapping.limits).ok()?;
    let columns = mapped(&mut input, mapping, &mut Findings::default())?;
    let rows = columns.iter().map(|column| offers[column.index].length).max()?;
    // Each column is in memory twice: as read, and in the table.
    Some((rows, 2 * width(&columns)))
}

/// Returns the columns to read, which must be of equal length.
fn mapped(
    input: &mut Box<dyn ReadSeek + '_>,
    mapping: &Mapping,
    findings: &mut Findings,
) -> Option<Vec<Column>> {
    let offers = input.rewind().and_then(|()| offers(input, mapping.limits));
    let offers = offers.map_err(|error| findings.error(None, None, damaged(&error))).ok()?;
    let names: Vec<String> = offers.iter().map(|offer| offer.name.clone()).collect();
    let columns = resolve(&names, mapping, findings)?;
    if mapping.unidentified.is_some() {
        return Some(of_one_length(columns, &offers));
    }
    let time = columns.iter().find(|column| column.target == Target::Time)?;
    let length = offers[time.index].length;
    for column in columns.iter().filter(|column| offers[column.index].length != length) {
        let message = format!(
            "has {} values, time has {length}; write them on one time base, or map only those",
            offers[column.index].length
        );
        findings.error(None, Some(&column.header), message);
    }
    if length > mapping.limits.rows {
        let most = mapping.limits.rows;
        let message =
            format!("{length} values are more than the {most} that are read; split the file");
        findings.error(None, None, message);
    }
    (!findings.has_errors()).then_some(columns)
}

/// Keeps the columns of the most frequent length.
fn of_one_length(mut columns: Vec<Column>, offers: &[Offer]) -> Vec<Column> {
    let alike = |length: usize| offers.iter().filter(|other| other.length == length).count();
    let length = offers.iter().map(|offer| offer.length).max_by_key(|&length| alike(length));
    columns.retain(|column| Some(offers[column.index].length) == length);
    columns
}

/// Returns the names of the columns of a file.
pub(crate) fn names(mut input: Box<dyn ReadSeek + '_>, limits: Limits) -> io::Result<Vec<String>> {
    Ok(offers(&mut input, limits)?.into_iter().map(|offer| offer.name).collect())
}

fn offers(input: &mut Box<dyn ReadSeek + '_>, limits: Limits) -> io::Result<Vec<Offer>> {
    let mut offers = Vec::new();
    input.rewind()?;
    visit(input, limits.unpacked_bytes as u64, &mut |array| {
        let columns = offered(&array);
        for column in 0..columns {
            if offers.len() == OFFERED {
                return Err(io::Error::other("it has more columns than are read"));
            }
            let whole = array.rows == 1 || array.columns == 1;
            let name = match whole {
                true => array.name.clone(),
                false => format!("{}(:,{})", array.name, column + 1),
            };
            offers.push(Offer { name, length: length(&array) });
        }
        Ok(())
    })?;
    Ok(offers)
}

/// Returns the number of columns of an array: one of a vector, those of a matrix, none of a single
/// number.
fn offered(array: &Array) -> usize {
    match (array.rows, array.columns) {
        (0, _) | (_, 0) | (1, 1) => 0,
        (1, _) | (_, 1) => 1,
        (_, columns) if columns <= WIDE => columns,
        _ => 0,
    }
}

fn length(array: &Array) -> usize {
    if array.rows == 1 { array.columns } else { array.rows }
}

fn damaged(error: &io::Error) -> String {
    format!("the MATLAB file cannot be read: {error}")
}

#[cfg(test)]
#[path = "mat_file_tests.rs"]
mod tests;
