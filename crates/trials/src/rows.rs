//! Rows of a file on their way into a table: kept, dropped or refused.

use sistership_model::manifest::Missing;

use crate::findings::Findings;
use crate::number::Fault;
use crate::table::{Column, Table};

/// A run of rows that are left out.
struct Run {
    first: usize,
    last: usize,
    column: String,
    fault: Fault,
}

/// Takes rows one at a time and keeps, drops or refuses them.
pub(crate) struct Builder<'a> {
    table: Table,
    missing: Missing,
    findings: &'a mut Findings,
    run: Option<Run>,
    faulty: usize,
    scratch: Vec<f64>,
}

/// Faulty rows listed one by one before they are only counted.
const LISTED: usize = 5;

impl<'a> Builder<'a> {
    pub(crate) fn new(columns: Vec<Column>, missing: Missing, findings: &'a mut Findings) -> Self {
        let values = vec![Vec::new(); columns.len()];
        let table = Table { columns, values, ..Table::default() };
        Self { table, missing, findings, run: None, faulty: 0, scratch: Vec::new() }
    }

    /// With room for so many rows: columns that grow take half as much again.
    pub(crate) fn with_room(mut self, rows: usize) -> Self {
        self.table.rows.reserve_exact(rows);
        self.table.values.iter_mut().for_each(|values| values.reserve_exact(rows));
        self
    }

    /// One row of the file; `cell` gives the number in the n-th mapped column.
    pub(crate) fn row(
        &mut self,
        row: usize,
        mut cell: impl FnMut(usize, &Column) -> Result<f64, Fault>,
    ) {
        self.scratch.clear();
        for (position, column) in self.table.columns.iter().enumerate() {
            match cell(position, column) {
                Ok(value) => self.scratch.push(value * column.to_si),
                Err(fault) => {
                    let header = column.header.clone();
                    return self.faulty(row, header, fault);
                }
            }
        }
        let row = u32::try_from(row).unwrap_or(u32::MAX);
        if self.run.is_some() {
            self.table.resumed.push(row);
        }
        self.end_run();
        self.table.rows.push(row);
        self.table
            .values
            .iter_mut()
            .zip(&self.scratch)
            .for_each(|(values, &value)| values.push(value));
    }

    /// A row that ends before the header does: left out as one without a value, or told by whoever counts the cells.
    pub(crate) fn short(&mut self, row: usize) {
        if self.drops()
            && let Some(column) = self.table.columns.last()
        {
            let header = column.header.clone();
            self.faulty(row, header, Fault::Short);
        }
    }

    /// Whether rows without a value are left out.
    pub(crate) fn drops(&self) -> bool {
        self.missing == Missing::Drop
    }

    fn faulty(&mut self, row: usize, column: String, fault: Fault) {
        self.faulty += 1;
        if self.missing == Missing::Refuse && self.faulty <= LISTED {
            let message = format!(
                "{fault}; fill it in, or set `missing: drop` in the manifest's conventions to leave such rows out"
            );
            self.findings.error(Some(row), Some(&column), message);
        }
        match &mut self.run {
            Some(run) => run.last = row,
            None => self.run = Some(Run { first: row, last: row, column, fault }),
        }
    }

    fn end_run(&mut self) {
        let Some(run) = self.run.take().filter(|_| self.missing == Missing::Drop) else { return };
        let rows = if run.first == run.last {
            format!("row {}", run.first)
        } else {
            format!("rows {} to {}", run.first, run.last)
        };
        let message =
            format!("{rows} left out: {}; nothing is interpolated over the gap", run.fault);
        self.findings.warning(Some(run.first), Some(&run.column), message);
    }

    /// The table, once every row has been seen.
    pub(crate) fn finish(mut self) -> Table {
        self.table.rows.shrink_to_fit();
        self.table.values.iter_mut().for_each(Vec::shrink_to_fit);
        let last = self.run.as_ref().map(|run| run.last);
        self.end_run();
        if let Some(more @ 1..) =
            self.faulty.checked_sub(LISTED).filter(|_| self.missing == Missing::Refuse)
        {
            let end = last.map_or(String::new(), |row| format!(", up to row {row}"));
            self.findings.error(
                None,
                None,
                format!("{more} further rows hold cells without a number{end}"),
            );
        }
        self.table
    }
}

#[cfg(test)]
mod tests {
    use sistership_model::trial::Channel;

    use super::*;
    use crate::table::Target;

    fn fill(missing: Missing) -> (Table, Findings) {
        let column = Column {
            index: 0,
            header: "u".into(),
            target: Target::Channel(Channel::U),
            unit: "km/h".into(),
            to_si: 0.5,
        };
        let mut findings = Findings::default();
        let mut builder = Builder::new(vec![column], missing, &mut findings);
        for row in 2..12 {
            builder.row(row, |_, _| {
                if (4..=6).contains(&row) || row == 11 { Err(Fault::Empty) } else { Ok(row as f64) }
            });
        }
        let table = builder.finish();
        (table, findings)
    }

    #[test]
    fn dropped_rows_are_told_run_by_run() {
        let (table, findings) = fill(Missing::Drop);
        let (errors, warnings) = findings.finish();
        assert!(errors.is_empty());
        assert_eq!(table.rows, [2, 3, 7, 8, 9, 10]);
        assert_eq!(table.values[0][0], 1.0);
        assert!(warnings[0].message.starts_with("rows 4 to 6 left out"), "{}", warnings[0].message);
        assert_eq!((warnings.len(), warnings[1].row), (2, Some(11)));
    }

    #[test]
    fn refused_rows_are_named() {
        let (errors, _) = fill(Missing::Refuse).1.finish();
        assert_eq!(
            errors.iter().map(|finding| finding.row).collect::<Vec<_>>(),
            [Some(4), Some(5), Some(6), Some(11)]
        );
        assert!(errors[0].message.contains("missing: drop"));
    }
}
