//! Construction of a table from the rows of a file, which are kept, dropped or refused.

use sistership_model::manifest::MissingValues;

use crate::findings::Findings;
use crate::number::CellFault;
use crate::row_sink::RowSink;
use crate::table::{ColumnTarget, Table, TableColumn};

/// Run of consecutive excluded rows.
struct FaultyRun {
    first: usize,
    last: usize,
    column: String,
    fault: CellFault,
}

/// Row sink that keeps, drops or refuses rows.
pub(crate) struct TableBuilder<'a> {
    table: Table,
    missing: MissingValues,
    findings: &'a mut Findings,
    run: Option<FaultyRun>,
    faulty: usize,
    scratch: Vec<f64>,
    /// For each column without any number so far, the fault of its last cell.
    unfilled: Vec<Option<CellFault>>,
    /// For each column, the cells without a number that became gaps.
    gaps: Vec<ColumnGaps>,
}

/// Cells of a column without a number.
#[derive(Clone, Default)]
struct ColumnGaps {
    count: usize,
    first: Option<(usize, CellFault)>,
}

/// Number of faulty rows listed one by one; further ones are counted.
const LISTED: usize = 5;

impl<'a> TableBuilder<'a> {
    pub(crate) fn new(
        columns: Vec<TableColumn>,
        missing: MissingValues,
        findings: &'a mut Findings,
    ) -> Self {
        let values = vec![Vec::new(); columns.len()];
        let unfilled = vec![Some(CellFault::Empty); columns.len()];
        let table = Table { columns, values, ..Table::default() };
        let scratch = Vec::new();
        let gaps = vec![ColumnGaps::default(); unfilled.len()];
        Self { table, missing, findings, run: None, faulty: 0, scratch, unfilled, gaps }
    }

    /// Reserves memory for a number of rows: a column that grows would take half as much again.
    pub(crate) fn with_room(mut self, rows: usize) -> Self {
        self.table.rows.reserve_exact(rows);
        self.table.values.iter_mut().for_each(|values| values.reserve_exact(rows));
        self
    }

    /// Returns true if rows without a value are excluded.
    pub(crate) fn drops_rows(&self) -> bool {
        self.missing != MissingValues::Refuse
    }

    /// Returns true if a cell without a number becomes a gap of its channel.
    fn keeps_gaps(&self) -> bool {
        self.missing == MissingValues::Bridge
    }

    fn push_gap(&mut self, position: usize, row: usize, fault: CellFault) {
        let gaps = &mut self.gaps[position];
        gaps.count += 1;
        gaps.first.get_or_insert((row, fault));
        self.scratch.push(f64::NAN);
    }

    fn report_column_gaps(&mut self) {
        for (column, gaps) in self.table.columns.iter().zip(&self.gaps) {
            if let Some((row, fault)) = &gaps.first {
                let message = match gaps.count {
                    1 => fault.to_string(),
                    count => format!("{fault}, and in {} further rows", count - 1),
                };
                self.findings.warning(Some(*row), Some(&column.header), message);
            }
        }
    }

    /// Marks columns that have numbers; earlier rows that were kept without a number there become
    /// faulty.
    fn mark_filled(&mut self) {
        for position in 0..self.scratch.len() {
            if !self.scratch[position].is_finite() {
                continue;
            }
            // This is the first number of the column.
            if let Some(fault) = self.unfilled[position].take()
                && !self.table.rows.is_empty()
                && !self.keeps_gaps()
            {
                self.retract_rows(position, &fault);
            }
        }
    }

    fn retract_rows(&mut self, position: usize, fault: &CellFault) {
        // Every row so far lacks a number in this column: all of them are faulty.
        self.table.values.iter_mut().for_each(Vec::clear);
        self.table.resumed.clear();
        let header = self.table.columns[position].header.clone();
        let rows = std::mem::take(&mut self.table.rows);
        for &row in &rows {
            self.record_fault(row as usize, header.clone(), fault.clone());
        }
        // The current run then begins at the first retracted row.
        let first = rows.first().map_or(usize::MAX, |&row| row as usize);
        if let Some(run) = self.run.as_mut().filter(|run| first < run.first) {
            (run.first, run.column, run.fault) = (first, header, fault.clone());
        }
    }

    fn record_fault(&mut self, row: usize, column: String, fault: CellFault) {
        self.faulty += 1;
        if self.missing == MissingValues::Refuse && self.faulty <= LISTED {
            let message = format!(
                "{fault}; enter a value, or set `missing: drop` in the manifest's conventions to \
                 skip such rows"
            );
            self.findings.error(Some(row), Some(&column), message);
        }
        match &mut self.run {
            Some(run) => run.last = run.last.max(row),
            None => self.run = Some(FaultyRun { first: row, last: row, column, fault }),
        }
    }

    fn end_run(&mut self) {
        let Some(run) = self.run.take().filter(|_| self.drops_rows()) else { return };
        let rows = if run.first == run.last {
            format!("row {}", run.first)
        } else {
            format!("rows {} to {}", run.first, run.last)
        };
        let message = format!("{rows} skipped: {}; the gap is not interpolated", run.fault);
        self.findings.warning(Some(run.first), Some(&run.column), message);
    }

    /// Returns the table, once every row has been read.
    pub(crate) fn finish_table(mut self) -> Table {
        self.remove_empty_columns();
        self.report_column_gaps();
        self.table.rows.shrink_to_fit();
        self.table.values.iter_mut().for_each(Vec::shrink_to_fit);
        let last = self.run.as_ref().map(|run| run.last);
        self.end_run();
        if let Some(more @ 1..) =
            self.faulty.checked_sub(LISTED).filter(|_| self.missing == MissingValues::Refuse)
        {
            let end = last.map_or(String::new(), |row| format!(", up to row {row}"));
            self.findings.error(
                None,
                None,
                format!("{more} further rows have cells without a number{end}"),
            );
        }
        self.table
    }

    /// Removes columns that are empty throughout, as if they were absent.
    fn remove_empty_columns(&mut self) {
        if self.table.rows.is_empty() {
            return;
        }
        // Backwards, so that removal does not shift the positions that follow.
        for position in (0..self.unfilled.len()).rev() {
            if self.unfilled[position].is_some() {
                let column = self.table.columns.remove(position);
                self.table.values.remove(position);
                self.gaps.remove(position);
                let message = "has no values; it is ignored";
                self.findings.warning(None, Some(&column.header), message);
            }
        }
        if self.table.columns.iter().all(|column| column.target == ColumnTarget::Time) {
            self.findings.error(None, None, "no column of a channel contains numbers");
        }
    }
}

impl RowSink for TableBuilder<'_> {
    /// Takes one row of the file; `cell` returns the number of the n-th mapped column.
    fn take_row(
        &mut self,
        row: usize,
        mut cell: impl FnMut(usize, &TableColumn) -> Result<f64, CellFault>,
    ) {
        self.scratch.clear();
        for position in 0..self.table.columns.len() {
            let column = &self.table.columns[position];
            let si =
                |value: f64| Some(column.to_canonical(value)).filter(|value| value.is_finite());
            match cell(position, column).and_then(|value| si(value).ok_or(CellFault::NotANumber)) {
                Ok(value) => self.scratch.push(value),
                // An empty column is dropped in the end: its cells do not make the row faulty yet.
                Err(fault @ (CellFault::Empty | CellFault::NotANumber))
                    if self.unfilled[position].is_some() && column.target != ColumnTarget::Time =>
                {
                    self.unfilled[position] = Some(fault);
                    self.scratch.push(f64::NAN);
                }
                Err(fault) if self.keeps_gaps() && column.target != ColumnTarget::Time => {
                    self.push_gap(position, row, fault);
                }
                Err(fault) => {
                    let header = column.header.clone();
                    return self.record_fault(row, header, fault);
                }
            }
        }
        self.mark_filled();
        let row = u32::try_from(row).unwrap_or(u32::MAX);
        // The first row after excluded ones: nothing is interpolated across.
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

    /// Takes a row with too few cells: it is excluded like one without a value, or reported by the
    /// counter of cells.
    fn take_short_row(&mut self, row: usize) {
        if self.drops_rows()
            && let Some(column) = self.table.columns.last()
        {
            let header = column.header.clone();
            self.record_fault(row, header, CellFault::Short);
        }
    }

    fn stored_rows(&self) -> usize {
        self.table.rows.len()
    }
}

#[cfg(test)]
mod tests {
    use sistership_model::trial::Channel;

    use super::*;

    fn fill(missing: MissingValues) -> (Table, Findings) {
        let column = TableColumn {
            index: 0,
            header: "u".into(),
            target: ColumnTarget::Channel(Channel::U),
            unit: "km/h".into(),
            to_si: 0.5,
            at_rest: 0.0,
        };
        let mut findings = Findings::default();
        let mut builder = TableBuilder::new(vec![column], missing, &mut findings);
        for row in 2..12 {
            builder.take_row(row, |_, _| {
                if (4..=6).contains(&row) || row == 11 {
                    Err(CellFault::Empty)
                } else {
                    Ok(row as f64)
                }
            });
        }
        let table = builder.finish_table();
        (table, findings)
    }

    #[test]
    fn dropped_rows_are_told_run_by_run() {
        let (table, findings) = fill(MissingValues::Drop);
        let (errors, warnings) = findings.into_lists();
        assert!(errors.is_empty());
        assert_eq!(table.rows, [2, 3, 7, 8, 9, 10]);
        assert_eq!(table.values[0][0], 1.0);
        assert!(warnings[0].message.starts_with("rows 4 to 6 skipped"), "{}", warnings[0].message);
        assert_eq!((warnings.len(), warnings[1].row), (2, Some(11)));
    }

    fn columns(missing: MissingValues, late: impl Fn(usize) -> bool) -> (Table, String) {
        columns_with(missing, |row, position| position == 2 && !late(row))
    }

    fn columns_with(
        missing: MissingValues,
        empty: impl Fn(usize, usize) -> bool,
    ) -> (Table, String) {
        let column = |index: usize, header: &str, target| TableColumn {
            index,
            header: header.into(),
            target,
            unit: "1".into(),
            to_si: 1.0,
            at_rest: 0.0,
        };
        let channel = ColumnTarget::Channel;
        let columns = vec![
            column(0, "t", ColumnTarget::Time),
            column(1, "u", channel(Channel::U)),
            column(2, "v", channel(Channel::V)),
        ];
        let mut findings = Findings::default();
        let mut builder = TableBuilder::new(columns, missing, &mut findings);
        for row in 2..12 {
            builder.take_row(row, |position, _| {
                if empty(row, position) { Err(CellFault::Empty) } else { Ok(row as f64) }
            });
        }
        let table = builder.finish_table();
        (table, crate::testing::finding_messages(findings))
    }

    #[test]
    fn a_column_that_is_empty_throughout_is_absent() {
        let (table, text) = columns(MissingValues::Refuse, |_| false);
        assert_eq!((table.columns.len(), table.values.len(), table.rows.len()), (2, 2, 10));
        assert_eq!(text, "warning None Some(\"v\") has no values; it is ignored");
    }

    #[test]
    fn a_column_that_begins_late_makes_the_rows_before_faulty() {
        let (table, text) = columns(MissingValues::Drop, |row| row > 5);
        assert_eq!((table.rows[0], table.values[2][0], table.resumed[0]), (6, 6.0, 6));
        assert!(text.contains("rows 2 to 5 skipped: the cell is empty"), "{text}");
        let (_, text) = columns(MissingValues::Refuse, |row| row > 5);
        assert_eq!(text.lines().count(), 4, "{text}");
        assert!(text.contains("error Some(2) Some(\"v\") the cell is empty"), "{text}");
    }

    #[test]
    fn rows_with_another_fault_stay_in_the_run() {
        let (table, text) = columns_with(MissingValues::Drop, |row, position| match position {
            1 => row == 4,
            2 => row <= 4,
            _ => false,
        });
        assert_eq!(table.rows[0], 5);
        let told = "warning Some(2) Some(\"v\") rows 2 to 4 skipped: the cell is empty";
        assert!(text.starts_with(told), "{text}");
    }

    #[test]
    fn refused_rows_are_named() {
        let (errors, _) = fill(MissingValues::Refuse).1.into_lists();
        assert_eq!(
            errors.iter().map(|finding| finding.row).collect::<Vec<_>>(),
            [Some(4), Some(5), Some(6), Some(11)]
        );
        assert!(errors[0].message.contains("missing: drop"));
    }
}
