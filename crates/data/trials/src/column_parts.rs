//! Structures of MATLAB files and groups of HDF5 files: each with a time of its own is a table.

use std::io;

use indexmap::IndexMap;

use crate::column_source::{ColumnSource, FileColumn};
use crate::names;

/// Fewest columns of a part, time among them, and fewest values of each.
const COLUMNS: usize = 3;
const VALUES: usize = 20;
/// Largest number of parts named in a message.
const NAMED: usize = 20;

const NOTHING: &str = "it has no columns of numbers; arrays of structures and cells of MATLAB are \
                       read from files saved with `-v7`, not `-v7.3`";

/// Columns of one part of a file, named within it.
pub(crate) struct PartColumns<'a> {
    whole: Box<dyn ColumnSource + 'a>,
    columns: Vec<FileColumn>,
    /// Index of each column in the whole file.
    places: Vec<usize>,
}

impl<'a> PartColumns<'a> {
    /// Opens a part of a file; of a file without parts all columns, without the structures that all
    /// of them have in common.
    ///
    /// # Errors
    /// Returns an error if there is no column or no such part, or if the file has several and none
    /// is given.
    pub(crate) fn open(whole: Box<dyn ColumnSource + 'a>, part: Option<&str>) -> io::Result<Self> {
        let columns = whole.columns();
        if columns.is_empty() {
            return Err(io::Error::other(NOTHING));
        }
        let prefix = match part {
            Some(part) => format!("{part}."),
            None => common_prefix(columns).to_owned(),
        };
        let own = columns.iter().enumerate().filter_map(|(at, column)| {
            let name = column.name.strip_prefix(&prefix)?.to_owned();
            Some((at, FileColumn { name, ..column.clone() }))
        });
        let (places, named): (Vec<usize>, Vec<FileColumn>) = own.unzip();
        if let Some(part) = part
            && places.is_empty()
        {
            let listed = list_parts(&part_names(columns));
            return Err(io::Error::other(format!("there is no part `{part}`{listed}")));
        }
        // A part that is given needs no search for others.
        let parts = if part.is_none() { part_names(columns) } else { Vec::new() };
        if !parts.is_empty() {
            let (count, listed) = (parts.len(), list_parts(&parts));
            return Err(io::Error::other(format!(
                "it has {count} tables, each with its own time{listed}; write `#part=NAME` after \
                 the file"
            )));
        }
        Ok(Self { whole, columns: named, places })
    }

    /// Returns the whole file.
    pub(crate) fn into_whole(self) -> Box<dyn ColumnSource + 'a> {
        self.whole
    }
}

impl ColumnSource for PartColumns<'_> {
    fn columns(&self) -> &[FileColumn] {
        &self.columns
    }

    fn read_numbers(&mut self, wanted: &[usize]) -> io::Result<Vec<Vec<f64>>> {
        let places: Vec<usize> = wanted.iter().map(|&at| self.places[at]).collect();
        self.whole.read_numbers(&places)
    }
}

/// Returns the parts of a file that are tables with a time of their own; none if it has fewer than
/// two, or columns of a table outside of them.
pub(crate) fn part_names(columns: &[FileColumn]) -> Vec<String> {
    let mut parts: IndexMap<&str, Vec<(&str, usize)>> = IndexMap::new();
    for column in columns {
        let (part, name) = split_name(&column.name);
        parts.entry(part).or_default().push((name, column.length));
    }
    // Structures of notes and of single numbers are no tables.
    parts.retain(|_, columns| is_table(columns));
    // A table outside of all structures is what such a file is about.
    if parts.len() < 2 || parts.contains_key("") {
        return Vec::new();
    }
    parts.into_keys().map(str::to_owned).collect()
}

/// Returns true if columns of one length have a time among them.
fn is_table(columns: &[(&str, usize)]) -> bool {
    let time = columns.iter().find(|(name, _)| names::begins_time(name));
    time.is_some_and(|(_, length)| {
        let alike = columns.iter().filter(|(_, other)| other == length).count();
        *length >= VALUES && alike >= COLUMNS
    })
}

/// Separates a name from the structure or group in which it stands.
fn split_name(name: &str) -> (&str, &str) {
    name.rsplit_once('.').unwrap_or(("", name))
}

/// Returns the structures that all columns have in common, with the dot behind them.
fn common_prefix(columns: &[FileColumn]) -> &str {
    let Some(first) = columns.first() else { return "" };
    let mut prefix = &first.name[..split_name(&first.name).0.len()];
    let inside = |prefix: &str| {
        columns.iter().all(|column| {
            column.name.strip_prefix(prefix).is_some_and(|name| name.starts_with('.'))
        })
    };
    // From the innermost structure of the first column outwards.
    while !prefix.is_empty() && !inside(prefix) {
        prefix = split_name(prefix).0;
    }
    let with_dot = if prefix.is_empty() { 0 } else { prefix.len() + 1 };
    &first.name[..with_dot]
}

fn list_parts(parts: &[String]) -> String {
    match parts.is_empty() {
        true => String::new(),
        false => format!(" ({})", parts[..parts.len().min(NAMED)].join(", ")),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::column_source::MemoryColumns;

    fn whole(names: &[&str]) -> Box<dyn ColumnSource> {
        let mut columns = MemoryColumns::default();
        for (at, name) in names.iter().enumerate() {
            let length = if name.contains("note") { 2 } else { VALUES };
            columns.push_column((*name).to_owned(), "", vec![at as f64; length]);
        }
        Box::new(columns)
    }

    fn opened(names: &[&str], part: Option<&str>) -> Result<Vec<String>, String> {
        let part = PartColumns::open(whole(names), part).map_err(|error| error.to_string())?;
        Ok(part.columns().iter().map(|column| column.name.clone()).collect())
    }

    const TWO: [&str; 7] =
        ["runs(1).t", "runs(1).u", "runs(1).r", "runs(2).t", "runs(2).u", "runs(2).r", "info.note"];

    #[test]
    fn structures_with_a_time_of_their_own_are_parts() {
        assert_eq!(part_names(whole(&TWO).columns()), ["runs(1)", "runs(2)"]);
        let mut part = PartColumns::open(whole(&TWO), Some("runs(2)")).unwrap();
        assert_eq!(part.columns()[2].name, "r");
        assert_eq!(part.read_numbers(&[2, 0]).unwrap(), [[5.0; VALUES], [3.0; VALUES]]);
        let refused = opened(&TWO, None).unwrap_err();
        assert!(
            refused.contains("2 tables") && refused.contains("(runs(1), runs(2))"),
            "{refused}"
        );
        let refused = opened(&TWO, Some("runs(3)")).unwrap_err();
        assert!(refused.contains("no part `runs(3)` (runs(1), runs(2))"), "{refused}");
    }

    #[test]
    fn what_shares_a_time_is_one_table() {
        for names in [
            &["t", "nav.u", "nav.v", "helm.delta"][..],
            &["nav.t", "nav.u", "nav.v", "helm.t", "helm.delta"],
            &["t", "u", "v", "old.t", "old.u", "old.v"],
        ] {
            assert_eq!(part_names(whole(names).columns()), [""; 0], "{names:?}");
            assert_eq!(opened(names, None).unwrap(), names);
        }
    }

    #[test]
    fn structures_around_everything_are_no_part_of_a_name() {
        assert_eq!(opened(&["log.t", "log.u", "log.x(:,1)"], None).unwrap(), ["t", "u", "x(:,1)"]);
        let nested = ["a.log.t", "a.log.u", "a.logs.note"];
        assert_eq!(opened(&nested, None).unwrap(), ["log.t", "log.u", "logs.note"]);
        assert_eq!(opened(&["a.t", "ab.u"], None).unwrap(), ["a.t", "ab.u"]);
        assert!(opened(&[], None).unwrap_err().contains("no columns of numbers"));
    }
}
